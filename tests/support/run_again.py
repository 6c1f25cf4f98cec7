#!/usr/bin/env python3
"""Runs again, one by one and with nothing beside them, the few tests that failed among thousands which shared the processors.

    run_again.py PRESET RESULTS

RESULTS is CTest's JUnit file. A test that passes now was disturbed by the machine: it becomes a passed one there, marked with the
attribute `again`, and the test runner's closing line counts those. One that fails again stays what it was. Where more than a few
failed it is not the machine, and none is run again; nor is one in which a sanitizer or a fuzzer found something: what is found once
is there.
"""
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

MOST = 3
FOUND = re.compile(r"Sanitizer: |runtime error: |libFuzzer: ")


def has_failed(case):
    reason = case.find("skipped")
    asked_to_skip = reason is not None and reason.get("message", "").startswith("SKIP_")
    return case.get("status") not in ("run", "disabled") and not asked_to_skip


def passes_alone(preset, name):
    with tempfile.TemporaryDirectory(prefix="yuragi-again-") as folder:
        results = os.path.join(folder, "results.xml")
        subprocess.run(["ctest", "--preset", preset, "--tests-regex", f"^{re.escape(name)}$", "--output-junit", results], check=False)
        if not os.path.exists(results):
            return False
        # Its fixtures are run with it.
        cases = {case.get("name"): case for case in xml.etree.ElementTree.parse(results).iter("testcase")}
    return name in cases and cases[name].get("status") == "run"


def main():
    preset, results = sys.argv[1:]
    tree = xml.etree.ElementTree.parse(results)
    failed = [case for case in tree.iter("testcase") if has_failed(case)]
    if not failed:
        return
    if len(failed) > MOST:
        print(f"{len(failed)} tests failed: too many for a disturbance, none is run again")
        return
    print(f"== {len(failed)} failed among all: again, each by itself")
    for case in failed:
        if FOUND.search(case.findtext("system-out", "")):
            print(f"{case.get('name')}: found by a sanitizer, not run again")
        elif passes_alone(preset, case.get("name")):
            case.set("status", "run")
            case.set("again", "true")
            for reason in (*case.findall("failure"), *case.findall("skipped")):
                case.remove(reason)
    tree.write(results, encoding="utf-8", xml_declaration=True)


if __name__ == "__main__":
    main()
