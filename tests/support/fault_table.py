#!/usr/bin/env python3
"""Which driver was tested against which fault: a table of the tests that ran.

usage: fault_table.py RESULTS.xml [RESULTS.xml ...]

Reads JUnit files of CTest and of GoogleTest and takes the tests that are named `<Driver>Fault.<Kind>` (with whatever
GoogleTest adds to either name), or `<Driver>/Fault.<Kind>` where drivers share a suite. A cell has the number of its
tests; "-" is a fault that the driver cannot suffer. Ends with 1 if a test of the table failed or did not run, or if there is none.
"""
import collections
import re
import sys
import xml.etree.ElementTree

KINDS = (
    "Silence Freeze Spike Garbage Split Partial BadChecksum WrongId WrongTransaction Late Exception Disconnect Unplug"
).split()
NAME = re.compile(r"(?:^|/)(?P<driver>[A-Z]\w*?)/?Fault\.(?P<kind>" + "|".join(KINDS) + r")(?P<variant>\w*)(?:/|$)")


def cells_of(files):
    """{(driver, kind): [did it pass?, ...]}"""
    cells = collections.defaultdict(list)
    for file in files:
        results = xml.etree.ElementTree.parse(file).getroot()
        is_of_googletest = results.tag == "testsuites"
        for case in results.iter("testcase"):
            prefix = case.get("classname", "") + "." if is_of_googletest else ""
            name = NAME.search(prefix + case.get("name", "").split("  #")[0])
            if name:
                did_pass = case.get("status") == "run" and case.find("skipped") is None and case.find("failure") is None
                cells[name["driver"], name["kind"]].append(did_pass)
    return cells


def table_of(cells):
    drivers = sorted({driver for driver, _ in cells})
    width = max(len(driver) for driver in drivers)
    lines = []
    header = "| " + "driver".ljust(width) + " | " + " | ".join(KINDS) + " |"
    lines.append(header)
    lines.append(re.sub(r"[^|]", "-", header))
    for driver in drivers:
        row = []
        for kind in KINDS:
            tests = cells.get((driver, kind), [])
            word = "-" if not tests else f"{len(tests)} ok" if all(tests) else "FAILED"
            row.append(word.ljust(len(kind)))
        lines.append("| " + driver.ljust(width) + " | " + " | ".join(row) + " |")
    return "\n".join(lines)


def main():
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        return 64
    cells = cells_of(sys.argv[1:])
    if not cells:
        print("no test of a driver against a fault was found", file=sys.stderr)
        return 1
    print(table_of(cells))
    return 0 if all(all(tests) for tests in cells.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
