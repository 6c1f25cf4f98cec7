#!/usr/bin/env python3
"""Each row of config/guide/threat-model.md names tests, and each of them exists: a case of GoogleTest, a method of a script that CTest
runs, a fuzz target, or another test of CTest by its name.

usage: threat_model_test.py PROJECT_ROOT
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
NAME = re.compile(r"`([^`]+)`")


def rows_of(text):
    """The cells of each row of each table, without heads."""
    rows = []
    for line in text.splitlines():
        if not line.startswith("|"):
            continue
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if set("".join(cells)) == {"-"}:
            rows.pop()  # the head
        else:
            rows.append(cells)
    return rows


def faults_of(text, tests):
    """A sentence for each row without a test, and for each test that does not exist."""
    faults = []
    for row in rows_of(text):
        names = NAME.findall(row[-1])
        if len(row) != 3 or not names:
            faults.append(f"{row[0]}: names no test")
        faults += [f"{row[0]}: there is no test {name}" for name in names if name not in tests]
    return faults


def tests_of(root):
    names = set()
    for source in (root / "tests").rglob("*.cpp"):
        names |= {f"{suite}.{case}" for suite, case in re.findall(r"^TEST(?:_F)?\((\w+),\s*(\w+)\)", source.read_text(encoding="utf-8"), re.M)}
    for file in (root / "tests").rglob("CMakeLists.txt"):
        text = file.read_text(encoding="utf-8")
        names |= set(re.findall(r"(?:\badd_test\(NAME |\byuragi_fuzz\()(\w+)", text))
        for name, script in re.findall(r"\byuragi_methods_test\((\w+) (\w+\.py)", text):
            methods = re.findall(r"^    def test_(\w+)", (file.parent / script).read_text(encoding="utf-8"), re.M)
            names |= {f"{name}.{method}" for method in methods}
    return names


class ThreatModelTest(unittest.TestCase):
    def test_each_row_names_tests_that_exist(self):
        text = (ROOT / "config/guide/threat-model.md").read_text(encoding="utf-8")
        self.assertGreater(len(rows_of(text)), 20)
        faults = faults_of(text, tests_of(ROOT))
        self.assertEqual(faults, [], "\n" + "\n".join(faults))

    def test_a_fault_would_be_found(self):
        head = "| attack | defence | tests |\n| --- | --- | --- |\n"
        self.assertEqual(faults_of(head + "| a | b | `X.Y` |\n", {"X.Y"}), [])
        self.assertEqual(faults_of(head + "| a | b | `X.Z` |\n| c | d | `X.Y` |\n", {"X.Y"}), ["a: there is no test X.Z"])
        self.assertEqual(faults_of(head + "| a | b | |\n", {"X.Y"}), ["a: names no test"])
        self.assertEqual(faults_of(head + "| c | d | a proof |\n", {"X.Y"}), ["c: names no test"])


if __name__ == "__main__":
    unittest.main()
