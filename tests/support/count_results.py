#!/usr/bin/env python3
"""Counts the tests in CTest's JUnit file.

    count_results.py RESULTS

The first line is "PASSED FAILED SKIPPED WITHOUT_RECORD AGAIN". Then come the last lines of the first five tests that failed, the names
of all that failed, and the names of those that passed only when they ran alone (run_again.py).

A CTest test is one test, but for a shard of a GoogleTest program (NAME.shard_1, config/cmake/Yuragi.cmake): its cases are
counted, as it printed them. A shard that ends without GoogleTest's sum has failed, whatever its exit code.

CTest also calls a test skipped that could not be started (a missing program, a failed fixture): that is a failure here. A test
that skips because a real recording is missing names ../shared/data.
"""
import re
import sys
import xml.etree.ElementTree

SHARD = re.compile(r"\.shard_\d+$")
CASE = re.compile(r"\[ +(RUN|OK|SKIPPED|FAILED) +\] (\S+?\.\S+?)(?:, where .*)?(?: \(\d+ ms\))?$", re.MULTILINE)
SUM = re.compile(r"^\[=+\] \d+ tests? from \d+ test suites? ran\.", re.MULTILINE)
LAST_LINES = 30


class Counts:
    def __init__(self):
        self.passed = self.skipped = self.without_record = self.again = 0
        self.failed = []  # (name, what it printed)
        self.passed_again = []

    def add(self, case):
        name, text = case.get("name"), case.findtext("system-out", "")
        reason = case.find("skipped")
        asked_to_skip = reason is not None and reason.get("message", "").startswith("SKIP_")
        if SHARD.search(name) and case.get("status") in ("run", "fail"):
            self.add_shard(name, text, case.get("status") == "run")
        elif case.get("status") == "run":
            self.passed += 1
            if case.get("again") == "true":
                self.again += 1
                self.passed_again.append(name)
        elif case.get("status") == "disabled" or asked_to_skip:
            self.add_skipped(text)
        else:
            self.failed.append((name, text))

    def add_skipped(self, text):
        self.skipped += 1
        self.without_record += "shared/data" in text

    def add_shard(self, name, text, has_passed):
        end = SUM.search(text)  # what stands behind the sum repeats names
        failed_before = len(self.failed)
        running, begin = None, 0
        for line in CASE.finditer(text, 0, end.start() if end else len(text)):
            word, case = line.groups()
            if word == "RUN":
                if running is not None:
                    self.failed.append((f"{running} ({name}), whose end is missing", text[begin : line.start()]))
                running, begin = case, line.start()
                continue
            running = None
            if word == "OK":
                self.passed += 1
            elif word == "SKIPPED":
                self.add_skipped(text[begin : line.end()])
            else:
                self.failed.append((f"{case} ({name})", text[begin : line.end()]))
        if running is not None:
            self.failed.append((f"{running} ({name}), in which it ended", text))
        elif not end or (not has_passed and len(self.failed) == failed_before):
            self.failed.append((name, text))


def main():
    counts = Counts()
    for case in xml.etree.ElementTree.parse(sys.argv[1]).iter("testcase"):
        counts.add(case)
    print(counts.passed, len(counts.failed), counts.skipped, counts.without_record, counts.again)
    for name, text in counts.failed[:5]:
        print(f"{name} printed at last:")
        print(*("    " + line for line in text.splitlines()[-LAST_LINES:]), sep="\n")
    for name, _ in counts.failed:
        print(f"FAILED: {name}")
    for name in counts.passed_again:
        print(f"passed only by itself, failed among all: {name}")


if __name__ == "__main__":
    main()
