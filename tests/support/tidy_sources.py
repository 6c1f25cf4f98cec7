#!/usr/bin/env python3
"""Which sources clang-tidy has to look at for the last change: one path a line.

usage: tidy_sources.py FOLDER_OF_COMPILE_COMMANDS

The change is what differs from the parent of the last commit, also if it is not committed yet. Its sources are listed, and
for each of its headers one source that includes it (the one of the same name, if there is one). All sources are listed where
the rules themselves changed (.clang-tidy, the preset `tidy` and those that it inherits), and where the parent is not there to compare
with (a shallow clone).
"""
import json
import os
import pathlib
import re
import subprocess
import sys

RULES, PRESETS = ".clang-tidy", "CMakePresets.json"
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def changed_files(project):
    """Paths from the project's root; None where there is nothing to compare with."""
    def git(*words):
        return subprocess.run(["git", "-C", project, *words], capture_output=True, text=True, check=False)

    if git("rev-parse", "--verify", "--quiet", "HEAD^").returncode != 0:
        return None
    told = git("diff", "--name-only", "--diff-filter=d", "HEAD^").stdout
    told += git("ls-files", "--others", "--exclude-standard").stdout
    return told.splitlines()


def tidy_presets(text):
    """The preset `tidy` and those that it inherits, of the text of CMakePresets.json."""
    presets = {preset["name"]: preset for preset in json.loads(text)["configurePresets"]}
    chain, name = [], "tidy"
    while name is not None:
        chain.append(presets[name])
        name = presets[name].get("inherits")
    return chain


def have_rules_changed(changed, project):
    if RULES in changed:
        return True
    if PRESETS not in changed:
        return False
    before = subprocess.run(["git", "-C", project, "show", f"HEAD^:{PRESETS}"], capture_output=True, text=True, check=True).stdout
    return tidy_presets(before) != tidy_presets(pathlib.Path(project, PRESETS).read_text(encoding="utf-8"))


def compiled_sources(build, project):
    """The project's own sources that the build compiles, as paths from the project's root."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as commands:
        files = {os.path.relpath(entry["file"], project) for entry in json.load(commands)}
    return sorted(file for file in files if not file.startswith(("..", "build/")))


def sources_of(changed, sources, project):
    """The sources among the changed files, and one for each changed header that is included anywhere."""
    chosen = {file for file in changed if file in sources}
    headers = {file for file in changed if file.endswith(".hpp")}
    for source in sorted(sources, key=lambda source: source not in chosen):
        included = headers.intersection(INCLUDE.findall(pathlib.Path(project, source).read_text(encoding="utf-8")))
        own = source.removesuffix(".cpp") + ".hpp"
        for header in included:
            own_source = header.removesuffix(".hpp") + ".cpp"
            if header == own or own_source not in sources:
                chosen.add(source)
                headers.discard(header)
    return sorted(chosen)


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 64
    project = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    sources = compiled_sources(sys.argv[1], project)
    changed = changed_files(project)
    if changed is None:
        print("the parent of the last commit is not here (git fetch --deepen=1 brings it): all sources", file=sys.stderr)
    elif have_rules_changed(changed, project):
        print("the rules have changed: all sources", file=sys.stderr)
        changed = None
    for source in sources if changed is None else sources_of(changed, sources, project):
        print(source)
    return 0


if __name__ == "__main__":
    sys.exit(main())
