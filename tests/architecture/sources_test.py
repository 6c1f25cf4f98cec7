#!/usr/bin/env python3
"""Reads every comment of the project: what it cites must be in the repository, or published.

usage: sources_test.py PROJECT_ROOT

- A name that ends in .md is a document of the repository, named from the root (or from the comment's own folder).
- A number behind such a name (engine/METHOD.md M9, D2) is a numbered place of that document: one that begins a line, a
  paragraph or a row of a table there.
- A path that begins with one of the project's folders and ends in .hpp or .cpp is a file of the repository.
- What stands beside the repository on some machines is named only by those tests that read recordings there
  (../shared/data) in their code.
"""
import pathlib
import re
import sys
import unittest

FOLDERS = "config daemon drivers engine simulators tests viewer".split()
C_LIKE = {".cpp", ".hpp", ".c", ".h", ".fbs", ".glsl", ".vert", ".frag"}
HASH = {".py", ".sh", ".cmake", ".toml", ".txt", ".rules"}

# Text in quotes is no comment. A triple-quoted text of Python's is one: it documents.
C_TOKEN = re.compile(
    r'R"(?P<raw>[^()\\ ]{0,16})\(.*?\)(?P=raw)"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])*\''
    r"|//(?P<line>[^\n]*)|/\*(?P<block>.*?)\*/",
    re.DOTALL,
)
HASH_TOKEN = re.compile(
    r'(?P<quotes>"""|\'\'\')(?P<block>.*?)(?P=quotes)|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|#(?P<line>[^\n]*)',
    re.DOTALL,
)

DOCUMENT = re.compile(r"[\w./-]*\w\.md\b")
SOURCE = re.compile(rf"(?<![\w./-])(?:{'|'.join(FOLDERS)})/[\w./-]*\w\.[hc]pp\b")
NUMBERS = re.compile(r"(?:,? (?:and |to )?[MDWS]\d+(?:\.\d+)?\b)+")
NUMBER = re.compile(r"[MDWS]\d+(?:\.\d+)?")
PLACE = re.compile(r"^(?:#+ |- |\| )?(?:\*\*)?([MDWS]\d+(?:\.\d+)?)\b", re.MULTILINE)
BESIDE = re.compile(r"\.\./shared\b(?P<data>/data\b)?")


def token_of(path):
    """How the comments of a file are found; None for one that has none."""
    if path.suffix in C_LIKE:
        return C_TOKEN
    return HASH_TOKEN if path.suffix in HASH and (path.suffix != ".txt" or path.name == "CMakeLists.txt") else None


def split_comments(token, text):
    """(comments, code): each comment as (line number, text), lines of comment that follow one another as one; and the
    text without them."""
    comments = []
    code = []
    last = 0
    for match in token.finditer(text):
        inside = match["line"] if match["line"] is not None else match["block"]
        if inside is None:
            continue
        between = text[last : match.start()]
        code.append(between)
        number = text.count("\n", 0, match.start()) + 1
        words = " ".join(line.strip().lstrip("/#*<! ") for line in inside.splitlines())
        if comments and match["line"] is not None and not between.strip() and between.count("\n") == 1:
            comments[-1] = (comments[-1][0], comments[-1][1] + " " + words)
        else:
            comments.append((number, words))
        last = match.end()
    code.append(text[last:])
    return comments, "".join(code)


def document_of(name, folder, documents):
    """The document that a comment in `folder` calls `name`, by its path from the root; or None."""
    name = name.removeprefix("./")
    return next((path for path in (name, f"{folder}/{name}") if path in documents), None)


def faults_of(path, text, documents, files=()):
    """Every citation of what is not there, each as "path:line: what is wrong". `documents`: {path: text}; `files`: the
    paths of the sources."""
    path = pathlib.PurePosixPath(path)
    token = token_of(path)
    if token is None:
        return []
    comments, code = split_comments(token, text)
    reads_recordings = path.parts[0] == "tests" and "shared" in code
    faults = []
    for line, comment in comments:
        for beside in BESIDE.finditer(comment):
            if not (reads_recordings and beside["data"]):
                faults.append(f"{path}:{line}: {beside[0]}: is no part of the repository")
        for cited in SOURCE.findall(comment):
            if cited not in files:
                faults.append(f"{path}:{line}: {cited}: is no file of the repository")
        for cited in DOCUMENT.finditer(comment):
            if cited[0].startswith("../shared"):
                continue
            document = document_of(cited[0], path.parent.as_posix(), documents)
            if document is None:
                faults.append(f"{path}:{line}: {cited[0]}: is no document of the repository")
                continue
            places = set(PLACE.findall(documents[document]))
            behind = NUMBERS.match(comment, cited.end())
            for number in NUMBER.findall(behind[0] if behind else ""):
                if number not in places:
                    faults.append(f"{path}:{line}: {cited[0]} has no {number}")
    return faults


def documents_of(root):
    """Every document of the repository, by its path from the root; what was built is none."""
    tops = [root / folder for folder in FOLDERS]
    paths = [*root.glob("*.md"), *(path for top in tops for path in top.rglob("*.md"))]
    return {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def sources(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and token_of(path) is not None:
                yield path


class TheProject(unittest.TestCase):
    def test_cites_what_is_there(self):
        documents = documents_of(ROOT)
        files = {path.relative_to(ROOT).as_posix(): path for path in sources(ROOT)}
        self.assertGreater(len(files), 300, "the sources were not found")
        faults = []
        for name, path in files.items():
            faults += faults_of(name, path.read_text(encoding="utf-8"), documents, files)
        self.assertEqual(faults, [], "\n" + "\n".join(faults))

    def test_names_files_that_are_there(self):
        """In the documents of sources each `file.cpp` is a file's name, or the end of its path."""
        paths = ["/" + path.relative_to(ROOT).as_posix() for folder in FOLDERS for path in (ROOT / folder).rglob("*.*")]
        for document in ("engine/METHOD.md", "engine/wind/model.md", "drivers/SOURCES.md"):
            named = set(re.findall(r"`([\w./-]+\.(?:hpp|cpp|toml))`", (ROOT / document).read_text(encoding="utf-8")))
            self.assertGreater(len(named), 10, document)
            missing = sorted(name for name in named if not any(path.endswith("/" + name) for path in paths))
            self.assertEqual(missing, [], document)


class TheCheck(unittest.TestCase):
    """It must be able to fail: samples that it has to refuse, and some that it has to pass."""

    DOCUMENTS = {
        "README.md": "# A project\n",
        "engine/METHOD.md": "**M1. Mode.** ...\n\n**D2. The shift** ... (M9)\n",
        "drivers/SOURCES.md": "## S2. USB\n\n| **S2.1** | WMR100 |\n\n- **S6.3.** clipping\n",
    }

    FILES = {"drivers/decode/nmea.hpp"}

    REFUSED = [
        ("engine/noise/a.hpp", "/// Source: wind.md 1."),
        ("engine/noise/a.hpp", "int a;  ///< as the issue.md says"),
        ("engine/noise/a.cpp", "/* See\n * docs/method.md. */"),
        ("engine/noise/a.cpp", "// engine/METHOD.md M7"),
        ("engine/noise/a.cpp", "// (engine/METHOD.md M1,\n// D3)"),
        ("engine/noise/a.cpp", "// engine/METHOD.md M9: it is only mentioned there"),
        ("drivers/hid.cpp", "// Source: ../shared/sensors.md 2.1"),
        ("drivers/hid.cpp", 'open("../shared/data/a.log");  // from ../shared/data'),
        ("drivers/hid.cpp", "double way_m = 2'048.0;  // sensors.md's"),
        ("drivers/hid.cpp", "// Reports: drivers/decode/wmr.hpp."),
        ("drivers/profiles/a.toml", 'name = "A"  # sensors.md 1'),
        ("drivers/hid.cpp", "const char c = '\"';  // drivers/SOURCES.md S2.2"),
        ("tests/drivers/a_test.cpp", "// ../shared/data/nmea, and nothing reads it"),
        ("tests/drivers/a_test.cpp", 'read("../shared/data/a");  // ../shared/answer'),
        ("tests/e2e/a_test.py", '"""As testing.md says."""'),
        ("tests/run.sh", "# see service.md"),
        ("tests/CMakeLists.txt", "# ../shared is beside"),
    ]

    PASSED = [
        ("engine/noise/a.hpp", "/// Source: engine/METHOD.md M1, D2."),
        ("engine/noise/a.hpp", "/// (engine/METHOD.md\n/// M1)"),
        ("engine/noise/a.hpp", 'const char* name = "wind.md";'),
        ("engine/a.hpp", "/// METHOD.md M1: of the folder of this file"),
        ("drivers/hid.cpp", "// drivers/SOURCES.md S2, S2.1 and S6.3"),
        ("drivers/hid.cpp", "// drivers/decode/nmea.hpp, and weewx drivers/wmr.py; gpsd/drivers/driver.cpp"),
        ("drivers/hid.cpp", 'log("see ../shared/a.md");  // 20 % of M7'),
        ("tests/drivers/a_test.cpp", '// Reads ../shared/data.\nread("../shared/data/a");'),
        ("tests/e2e/a_test.py", '"""A recording of ../shared/data."""\nfind("shared", "data")'),
        ("tests/notes.txt", "# wind.md"),
    ]

    def test_refuses_what_is_not_there(self):
        for path, text in self.REFUSED:
            with self.subTest(path=path, text=text):
                self.assertEqual(len(faults_of(path, text, self.DOCUMENTS, self.FILES)), 1)

    def test_passes_what_is_there(self):
        for path, text in self.PASSED:
            with self.subTest(path=path, text=text):
                self.assertEqual(faults_of(path, text, self.DOCUMENTS, self.FILES), [])

    def test_says_where_and_what(self):
        self.assertEqual(
            faults_of("engine/math/a.cpp", "int a;\n// One line, and\n// engine/METHOD.md M8.", self.DOCUMENTS),
            ["engine/math/a.cpp:2: engine/METHOD.md has no M8"],
        )


if __name__ == "__main__":
    ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
