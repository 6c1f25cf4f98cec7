#!/usr/bin/env python3
"""Writes what the package has besides what is built: manual pages, completions, changelog.

usage: documents.py PROJECT_ROOT PREFIX VERSION MAINTAINER PROGRAM... [-- EMULATOR...]

PREFIX is the folder that becomes /usr. EMULATOR is the command that runs programs for another processor. The same sources give
the same bytes: dates are SOURCE_DATE_EPOCH, or else 0.
"""
import gzip
import json
import os
import pathlib
import sys

from bash_completion import bash_completion
from debian_changelog import debian_changelog
from man_page import man_page
from program_help import Help, Program


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    data = text.encode("utf-8")
    path.write_bytes(gzip.compress(data, 9, mtime=0) if path.suffix == ".gz" else data)


def arguments_of(top, program):
    """What the argument of a command may be, as far as the program can tell: the drivers."""
    name = f"{top.name} sensors describe"
    if name not in {command.name for command in top.walk()}:
        return {}
    return {name: [driver["name"] for driver in json.loads(program.output("sensors", "describe", "--json"))]}


def main(root, prefix, version, maintainer, *words):
    separator = words.index("--") if "--" in words else len(words)
    programs = [Program(path, words[separator + 1:]) for path in words[:separator]]
    share = pathlib.Path(prefix) / "share"
    epoch_s = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
    for program in programs:
        top = Help(program)
        write(share / "man" / "man1" / f"{top.name}.1.gz", man_page(top, program.output("--version").strip(), epoch_s))
        write(share / "bash-completion" / "completions" / top.name, bash_completion(top, arguments_of(top, program)))
    markdown = (pathlib.Path(root) / "CHANGELOG.md").read_text(encoding="utf-8")
    write(share / "doc" / "yuragi" / "changelog.gz", debian_changelog(markdown, version, epoch_s, maintainer))


if __name__ == "__main__":
    main(*sys.argv[1:])
