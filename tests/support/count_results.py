#!/usr/bin/env python3
"""Counts the tests in CTest's JUnit file.

    count_results.py RESULTS

The first line is "PASSED FAILED SKIPPED WITHOUT_RECORD AGAIN". Then come the last lines of the first five tests that failed, the names
of all that failed, and the names of those that passed only when they ran alone (run_again.py).

CTest also calls a test skipped that could not be started (a missing program, a failed fixture): that is a failure here. A test
that skips because a real recording is missing names ../shared/data.
"""
import sys
import xml.etree.ElementTree

SHOWN_FAILURES, LAST_LINES = 5, 30


def main():
    passed = skipped = without_record = 0
    failed, passed_again = [], []
    for case in xml.etree.ElementTree.parse(sys.argv[1]).iter("testcase"):
        reason = case.find("skipped")
        asked_to_skip = reason is not None and reason.get("message", "").startswith("SKIP_")
        if case.get("status") == "run":
            passed += 1
            if case.get("again") == "true":
                passed_again.append(case)
        elif case.get("status") == "disabled" or asked_to_skip:
            skipped += 1
            without_record += "shared/data" in case.findtext("system-out", "")
        else:
            failed.append(case)
    print(passed, len(failed), skipped, without_record, len(passed_again))
    for case in failed[:SHOWN_FAILURES]:
        print(f"{case.get('name')} printed at last:")
        print(*("    " + line for line in case.findtext("system-out", "").splitlines()[-LAST_LINES:]), sep="\n")
    for case in failed:
        print(f"FAILED: {case.get('name')}")
    for case in passed_again:
        print(f"passed only by itself, failed among all: {case.get('name')}")


if __name__ == "__main__":
    main()
