#!/usr/bin/env python3
"""Holds the namespaces of the sources against their rooms: drivers/modbus is yuragi::drivers::modbus. The engine's rooms
leave `engine` out (engine/wind/blend is yuragi::wind::blend), and engine/base, which all share, is yuragi itself. A type
does not begin with the name of its namespace: modbus::Request, not modbus::ModbusRequest.

usage: namespaces_test.py PROJECT_ROOT
"""
import pathlib
import re
import sys
import unittest

import rooms

OPENED = re.compile(r"^namespace (yuragi(?:::\w+)*) \{", re.MULTILINE)
# A type at namespace scope that is defined here.
TYPE = re.compile(r"^(?:class|struct|enum class|enum|using) (?:\[\[\w+\]\] )?(\w+)(?: final)?(?: :[^;{]*)?(?: ?\{| =)", re.MULTILINE)


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


def repeats_of(path, text):
    """The types of a source whose name begins with the name of its room, or with its singular."""
    room = pathlib.PurePosixPath(path).parent.name.replace("_", "")
    faults = []
    for name in TYPE.findall(text):
        words = re.findall(r"[A-Z][a-z]*\d*", name)
        starts = ["".join(words[:count]).lower() for count in range(1, len(words))]
        if room in starts or room.removesuffix("s") in starts:
            faults.append(f"{path}: {name} repeats its namespace")
    return faults


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

    def test_are_not_repeated_by_types(self):
        faults = []
        for path in rooms.sources(ROOT):
            faults += repeats_of(path.as_posix(), (ROOT / path).read_text(encoding="utf-8"))
        self.assertEqual(faults, [], "\n" + "\n".join(faults))


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

    DISTINCT = ["class Sensor final : public sensor::Sensor {", "struct StationPlace {", "using Bytes = int;", "class Modbus {"]
    REPEATED = ["class ModbusSensor final : public sensor::Sensor {", "struct ModbusPlace {", "using ModbusBytes = int;"]

    def test_passes_types_that_do_not_repeat_their_namespace(self):
        for text in self.DISTINCT:
            with self.subTest(text=text):
                self.assertEqual(repeats_of("drivers/modbus/a.hpp", text), [])

    def test_refuses_types_that_repeat_it(self):
        for text in self.REPEATED:
            with self.subTest(text=text):
                self.assertEqual(len(repeats_of("drivers/modbus/a.hpp", text)), 1)
        self.assertEqual(len(repeats_of("engine/scenes/a.hpp", "struct SceneSetup {")), 1)

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
