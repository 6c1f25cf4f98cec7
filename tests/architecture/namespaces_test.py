#!/usr/bin/env python3
"""Holds the namespaces of the sources against their rooms: drivers/modbus is yuragi::drivers::modbus. The engine's rooms
leave `engine` out (engine/wind/blend is yuragi::wind::blend), and engine/base, which all share, is yuragi itself.

usage: namespaces_test.py PROJECT_ROOT
"""
import pathlib
import re
import sys
import unittest

import rooms

OPENED = re.compile(r"^namespace (yuragi(?:::\w+)*) \{", re.MULTILINE)


def namespace_of(room):
    """The namespace of the room that is the folder `room`."""
    parts = room.split("/")
    if parts[0] == "engine":
        parts = [] if parts[1] == "base" else parts[1:]
    return "::".join(["yuragi", *parts])


def faults_of(path, text):
    """What a source of a room opens beside its room's namespace and those below it."""
    own = namespace_of(pathlib.PurePosixPath(path).parent.as_posix())
    return [
        f"{path}: opens {opened}, not {own}"
        for opened in OPENED.findall(text)
        if opened != own and (own == "yuragi" or not opened.startswith(own + "::"))
    ]


class Namespaces(unittest.TestCase):
    def test_follow_rooms(self):
        faults = []
        opened = set()
        for path in rooms.sources(ROOT):
            text = (ROOT / path).read_text(encoding="utf-8")
            faults += faults_of(path.as_posix(), text)
            opened.update(OPENED.findall(text))
        self.assertEqual(faults, [], "\n" + "\n".join(faults))
        self.assertGreater(len(opened), 50)


class TheCheck(unittest.TestCase):
    """It must be able to fail."""

    PASSED = [
        ("drivers/modbus/a.hpp", "namespace yuragi::drivers::modbus {"),
        ("drivers/windlog/a.hpp", "namespace yuragi::drivers::windlog::sqlite {"),
        ("engine/base/a.cpp", "namespace yuragi {\nnamespace {"),
        ("engine/wind/blend/a.cpp", "namespace boost::asio {\n}\nnamespace yuragi::wind::blend {"),
    ]
    REFUSED = [
        ("drivers/modbus/a.hpp", "namespace yuragi {"),
        ("drivers/modbus/a.hpp", "namespace yuragi::drivers {"),
        ("drivers/modbus/a.hpp", "namespace yuragi::drivers::modbus_rtu {"),
        ("engine/base/a.hpp", "namespace yuragi::base {"),
        ("engine/wind/a.hpp", "namespace yuragi::engine::wind {"),
    ]

    def test_passes_the_namespace_of_the_room(self):
        for path, text in self.PASSED:
            with self.subTest(path=path, text=text):
                self.assertEqual(faults_of(path, text), [])

    def test_refuses_any_other(self):
        for path, text in self.REFUSED:
            with self.subTest(path=path, text=text):
                self.assertEqual(len(faults_of(path, text)), 1)


if __name__ == "__main__":
    ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
