#!/usr/bin/env python3
"""No exception ends the program, and no text from outside does where it becomes JSON or is read as TOML.

usage: barriers_test.py PROJECT_ROOT

- A source that constructs a thread calls contain() (engine/base/contain.hpp).
- JSON is written by json_text() alone (engine/base/json_text.hpp), which replaces invalid UTF-8.
- TOML is parsed by parse_toml() alone (engine/tables/parse_toml.hpp), which has limits.
"""
import pathlib
import re
import sys
import unittest

FOLDERS = "daemon drivers engine simulators viewer".split()

# `std::thread(...)`, `std::jthread name(...)`, and a member `thread_(...)` or `thread_{...}`.
THREAD = re.compile(r"\bstd::j?thread\s*(?:\w+\s*)?[({]\s*[\[&\w]|\bthread_[({]\s*\[")
BARRIER = re.compile(r"\bcontain\(")
PARSE = re.compile(r"\btoml::parse(?:_file)?\(")
DUMP = re.compile(r"(?:\.|->)dump\(")


def faults_of(path, text):
    code = re.sub(r"//[^\n]*", "", text)
    faults = []
    if THREAD.search(code) and not BARRIER.search(code):
        faults.append(f"{path}: a thread without contain()")
    if DUMP.search(code) and path != "engine/base/json_text.hpp":
        faults.append(f"{path}: JSON without json_text()")
    if PARSE.search(code) and path != "engine/tables/parse_toml.cpp":
        faults.append(f"{path}: TOML without parse_toml()")
    return faults


class TheProject(unittest.TestCase):
    def test_contains_exceptions(self):
        paths = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.[ch]pp")]
        texts = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in paths}
        threads = [path for path, text in texts.items() if THREAD.search(text)]
        self.assertGreater(len(threads), 8, "the threads were not found")
        faults = [fault for path, text in sorted(texts.items()) for fault in faults_of(path, text)]
        self.assertEqual(faults, [], "\n" + "\n".join(faults))


class TheCheck(unittest.TestCase):
    """It must be able to fail."""

    REFUSED = [
        "thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });",
        "Recorder() : thread_([this] { run(); }) {}",
        "std::thread([work] { work->go(); }).detach();",
        "std::thread helper(&run);",
        "return json.dump(2);",
        "toml::table root = toml::parse(text);",
        "const auto root = toml::parse_file(file);",
        "std::thread([] { run(); });  // contain()",
    ]
    PASSED = [
        "std::jthread thread_;",
        'thread_ = std::jthread([this] { contain("it", [this] { run(); }); });',
        "return json_text(json);",
        "const toml::table root = tables::parse_toml(text);",
    ]

    def test_refuses(self):
        for text in self.REFUSED:
            with self.subTest(text=text):
                self.assertEqual(len(faults_of("daemon/a.cpp", text)), 1)

    def test_passes(self):
        for text in self.PASSED:
            with self.subTest(text=text):
                self.assertEqual(faults_of("daemon/a.cpp", text), [])


if __name__ == "__main__":
    ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
