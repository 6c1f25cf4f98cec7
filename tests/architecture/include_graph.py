#!/usr/bin/env python3
"""Prints the rooms of the project, from the bottom up: what each is, by its README.md, its files and the rooms that it includes.

usage: tests/architecture/include_graph.py [PROJECT_ROOT]

An arrow leads down, to a lower level; one that would lead up is printed at the end, and the exit code is 1.
"""
import pathlib
import sys

import rooms


def main(root):
    graph = rooms.room_graph(root)
    files = {}
    for path in rooms.sources(root):
        files[path.parent.as_posix()] = files.get(path.parent.as_posix(), 0) + 1
    circle = rooms.circle_in(graph)
    if circle:
        print("an arrow leads back up: " + " -> ".join(circle))
        return 1
    levels = rooms.levels_of(graph)
    for level in range(max(levels.values()) + 1):
        print(f"level {level}")
        for room in sorted(r for r in graph if levels[r] == level):
            title = (root / room / "README.md").read_text(encoding="utf-8").splitlines()[0].lstrip("# ")
            print(f"  {title} ({files[room]} files)\n    -> {', '.join(sorted(graph[room])) or 'nothing'}")
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()))
