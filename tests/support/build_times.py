#!/usr/bin/env python3
"""Prints the ten rooms that take longest to build, from Ninja's log of a build folder:

    build_times.py build/test

The figures are the wall time of each step's last run, added up by room. With idle cores that is about its CPU time; with busy
cores it is more. A step that ccache answers is short.
"""
import collections
import pathlib
import re
import sys

ROOMS_SHOWN = 10


def room_of(output):
    """The folder that a step's output belongs to: "drivers/bus", or "joined drivers" for the group of a release."""
    joined = re.search(r"yuragi_joined_(\w+)\.(dir/|a$)", output)
    if joined:
        return "joined " + joined[1]
    return re.split(r"/?CMakeFiles/", output)[0] if "CMakeFiles/" in output else str(pathlib.PurePath(output).parent)


def main():
    folder = pathlib.Path(sys.argv[1])
    steps = {}  # a step with several outputs has one entry for each, with the same times and command
    for line in (folder / ".ninja_log").read_text(encoding="utf-8").splitlines()[1:]:
        begin_ms, end_ms, _, output, command = line.split("\t")
        steps[output] = (int(begin_ms), int(end_ms), command)
    rooms = collections.Counter()
    for (begin_ms, end_ms, _), output in {step: output for output, step in steps.items()}.items():
        rooms[room_of(output)] += (end_ms - begin_ms) / 1000
    total_s = sum(rooms.values())
    print(f"build of {folder}: {total_s:.0f} s of steps (wall time, more than CPU time on busy cores); the longest rooms:")
    for room, seconds in rooms.most_common(ROOMS_SHOWN):
        print(f"{seconds:8.1f} s {seconds / total_s if total_s else 0:4.0%}  {room}")


if __name__ == "__main__":
    main()
