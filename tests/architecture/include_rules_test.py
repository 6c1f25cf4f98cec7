#!/usr/bin/env python3
"""Holds every #include of the project against the rooms that CMakeLists.txt declare, and each room's README.md against the files
that there are.

usage: include_rules_test.py PROJECT_ROOT

A file belongs to the room that is its folder. A room may include itself, the rooms that it links and those that they link, the
libraries that it links itself, the C++ standard library and the system's headers; what is computed alone (PURE) has no system.
"""
import fnmatch
import pathlib
import posixpath
import re
import sys
import unittest

import rooms

MOST_FILES = 60  # in a room, headers counted

README_LINES = range(10, 41)  # of every README.md below the top level

# A README names a path by a link, as a file's name in backquotes, or from one of the project's folders on.
LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)\)")
FILE_NAME = re.compile(r"`([\w.*/-]+\.(?:[ch]pp|md|py|sh|toml|fbs|glsl|txt|rules))`")
PATH = re.compile(rf"(?<![\w./-])(?:{'|'.join(rooms.TOPS)}|tests|config)/[\w./*-]*\w")
PLACEHOLDER = "NAME"  # `NAME_job.hpp`: of a file that somebody is to write

# The engine computes: it opens no file, starts no thread, reads no clock, writes no log, and draws no random number
# whose bits the standard leaves open. So do decoders, which may not use the system either.
PURE = ("engine/", "drivers/decode")
FORBIDDEN_IN_ENGINE = set(
    "thread mutex shared_mutex condition_variable future semaphore barrier latch stop_token fstream iostream filesystem"
    " cstdio ctime csignal random".split()
)
ALLOWED = {
    "engine/base": {"POSIX"},  # descriptors that children do not inherit
    "engine/fft": {"mutex"},  # FFTW's planner
    "engine/platform": {"filesystem", "csignal", "random", "thread", "mutex", "POSIX"},  # what programs need of the system
    "engine/workers": {"thread", "mutex", "condition_variable", "POSIX"},  # threads that share a tick
}
CLOCK_READ = re.compile(r"\b(?:steady|system|high_resolution|utc)_clock::now\b")

# Of these a driver's file may wrap one.
C_LIBRARIES = "curl modbus hidapi libusb portaudio sqlite3.h mosquitto.h nats lo umockdev.h".split()

# The operating system's own headers.
POSIX = set(
    "arpa dlfcn.h fcntl.h grp.h iconv.h ifaddrs.h linux net netdb.h netinet poll.h pthread.h pwd.h resolv.h sched.h signal.h spawn.h sys sysexits.h"
    " termios.h time.h unistd.h malloc.h".split()
)

def library_of(header, libraries):
    """Which of `libraries` the header belongs to, or None."""
    for library in libraries:
        if header == library or header.startswith((library + "/", library + ".", library + "-", library + "_")):
            return library
    return None


def fault_of_own(room, header, all_rooms, generated=("pose_generated.h",)):
    """What is wrong with #include "header" in `room`, or None."""
    if header in generated:
        return fault_of_outside(room, header)
    target = pathlib.PurePosixPath(header).parent.as_posix()
    if target not in all_rooms:
        return "is no path from the project's root into a room"
    if target != room.name and target not in room.may_include:
        return f"{room.name} may not include {target}"
    return None


def fault_of_outside(room, header):
    """What is wrong with #include <header> in `room`, or None."""
    allowed = ALLOWED.get(room.name, ())
    if re.fullmatch(r"[a-z_0-9]+", header):  # the C++ standard library
        if room.name.startswith("engine/") and header in FORBIDDEN_IN_ENGINE and header not in allowed:
            return "the engine has no file, thread, clock, log or random device"
        return None
    if header.split("/")[0] in POSIX:
        return "what is computed has no system" if room.name.startswith(PURE) and "POSIX" not in allowed else None
    if library_of(header, room.libraries) is None:
        return f"{room.name} may not use this library"
    return None


def faults_of(path, text, all_rooms):
    """Every breach of the rules in one file, each as "path:line: header: what is wrong"."""
    room = all_rooms.get(pathlib.PurePosixPath(path).parent.as_posix())
    if room is None:
        return [f"{path}:1: stands in no room"]
    faults = []
    wrapped = set()
    for number, header, is_own in rooms.includes_of(text):
        fault = fault_of_own(room, header, all_rooms) if is_own else fault_of_outside(room, header)
        if fault:
            faults.append(f"{path}:{number}: {header}: {fault}")
        wrapped.add(library_of(header, C_LIBRARIES))
    for number, line in enumerate(text.splitlines(), 1):
        if room.name.startswith("engine/") and CLOCK_READ.search(line.split("//")[0]):
            faults.append(f"{path}:{number}: reads a clock: time is a parameter")
    if len(wrapped - {None}) > 1:
        faults.append(f"{path}:1: wraps more than one C library: {', '.join(sorted(wrapped - {None}))}")
    return faults


def missing_paths(folder, text, files):
    """The paths that a README in `folder` names and that do not exist. `files`: the paths of all files. A path counts
    from the README's folder or from the root; the name of a file in backquotes may be the end of its path."""
    all_files = set(files)
    folders = {parent.as_posix() for file in files for parent in pathlib.PurePosixPath(file).parents}

    def exists(path, may_be_end):
        path = posixpath.normpath(path)
        if path in folders or path in all_files or ("*" in path and fnmatch.filter(files, path)):
            return True
        return may_be_end and any(file.endswith("/" + path) for file in files)

    named = {(path, False) for path in LINK.findall(text) + PATH.findall(text)}
    named |= {(path, True) for path in FILE_NAME.findall(text)}
    return sorted(
        {
            path
            for path, may_be_end in named
            if PLACEHOLDER not in path and not exists(path, may_be_end) and not exists(f"{folder}/{path}", False)
        }
    )


class TheProject(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rooms = rooms.read_rooms(ROOT)

    def test_includes_what_it_links(self):
        files = list(rooms.sources(ROOT))
        self.assertGreater(len(files), 30, "the sources were not found")
        faults = []
        for path in files:
            faults += faults_of(path.as_posix(), (ROOT / path).read_text(encoding="utf-8"), self.rooms)
        self.assertEqual(faults, [], "\n" + "\n".join(faults))

    def test_links_what_it_includes(self):
        """Where a room links one that it does not include, the graph is not the real one."""
        included = rooms.room_graph(ROOT)
        unused = {room.name: room.links - included[room.name] for room in self.rooms.values()}
        self.assertEqual({room: sorted(links) for room, links in unused.items() if links}, {})

    def test_has_sources_in_every_room(self):
        self.assertEqual([room for room in self.rooms if not list((ROOT / room).glob("*.?pp"))], [])

    def test_has_a_readme_in_every_room(self):
        files = [
            path.relative_to(ROOT).as_posix()
            for top in (*rooms.TOPS, "tests", "config")
            for path in (ROOT / top).rglob("*")
            if path.is_file()
        ] + [path.name for path in ROOT.glob("*.md")]
        faults = []
        for room in self.rooms:
            if f"{room}/README.md" not in files:
                faults.append(f"{room} has no README.md")
                continue
            text = (ROOT / room / "README.md").read_text(encoding="utf-8")
            faults += [f"{room}/README.md: {path} does not exist" for path in missing_paths(room, text, files)]
        for path in files:
            if path.endswith("/README.md"):
                count = len((ROOT / path).read_text(encoding="utf-8").splitlines())
                if count not in README_LINES:
                    faults.append(f"{path} has {count} lines (allowed: {README_LINES.start} to {README_LINES.stop - 1})")
        self.assertEqual(faults, [], "\n" + "\n".join(faults))

    def test_lets_no_room_include_one_that_includes_it(self):
        self.assertEqual(rooms.circle_in({room.name: room.may_include for room in self.rooms.values()}), [])

    def test_has_no_two_files_that_include_each_other(self):
        self.assertEqual(rooms.circle_in(rooms.file_graph(ROOT)), [])

    def test_has_no_live_room_that_sees_tools_or_commands(self):
        for room in self.rooms.values():
            if not room.name.startswith(("daemon/tools", "daemon/commands")) and room.name != "daemon":
                seen = [r for r in room.may_include if r.startswith(("daemon/tools", "daemon/commands"))]
                self.assertEqual(seen, [], room.name)

    def test_has_rooms_that_can_be_overlooked(self):
        count = {}
        for path in rooms.sources(ROOT):
            count[path.parent.as_posix()] = count.get(path.parent.as_posix(), 0) + 1
        self.assertEqual({room: files for room, files in count.items() if files > MOST_FILES}, {})


class TheCheck(unittest.TestCase):
    """It must be able to fail: samples that it has to refuse, and some that it has to pass."""

    @classmethod
    def setUpClass(cls):
        cls.rooms = rooms.read_rooms(ROOT)

    REFUSED = [
        ("engine/base/a.hpp", '#include "engine/math/philox.hpp"'),
        ("engine/base/a.hpp", "#include <boost/asio.hpp>"),
        ("engine/math/a.cpp", "#include <thread>"),
        ("engine/math/a.cpp", "#include <mutex>"),
        ("engine/noise/a.cpp", "#include <fftw3.h>"),
        ("engine/noise/a.cpp", '#include "engine/wind/wind_state.hpp"'),
        ("engine/noise/a.cpp", "#include <random>"),
        ("engine/wind/a.cpp", "#include <spdlog/spdlog.h>"),
        ("engine/wind/a.cpp", "auto t = std::chrono::steady_clock::now();"),
        ("engine/wind/a.cpp", "#include <unistd.h>"),
        ("engine/operators/a.cpp", '#include "engine/scenes/scene.hpp"'),
        ("engine/scenes/a.cpp", '#include "engine/wire/wire.hpp"'),
        ("engine/wire/a.cpp", "#include <fstream>"),
        ("engine/pose/a.hpp", '#include "skeleton.hpp"'),
        ("engine/newroom/a.hpp", ""),
        ("drivers/decode/a.cpp", "  #  include <modbus/modbus.h>"),
        ("drivers/modbus/modbus.cpp", "#include <modbus.h>"),
        ("drivers/windlog/a.cpp", '#include "drivers/sensor/sensor.hpp"'),
        ("drivers/synthetic/synthetic.cpp", '#include "daemon/settings/config.hpp"'),
        ("drivers/bus/a.cpp", "#include <modbus/modbus.h>\n#include <libusb-1.0/libusb.h>"),
        ("daemon/sensing/a.cpp", "#include <GLFW/glfw3.h>"),
        ("daemon/stream/a.cpp", '#include "viewer/meshes/orbit_camera.hpp"'),
        ("daemon/sensing/a.cpp", '#include "daemon/tools/plot/plot.hpp"'),
        ("daemon/settings/a.cpp", '#include "daemon/commands/command.hpp"'),
        ("viewer/app/a.cpp", '#include "engine/scenes/scene.hpp"'),
        ("viewer/app/a.cpp", '#include "drivers/sensor/sensor.hpp"'),
        ("viewer/picture/a.cpp", '#include "viewer/film/film_output.hpp"'),
        ("viewer/film/a.cpp", '#include "viewer/app/window.hpp"'),
        ("simulators/core/a.cpp", '#include "drivers/decode/modbus/modbus.hpp"'),
        ("simulators/core/a.cpp", '#include "drivers/modbus/modbus_profile.hpp"'),
    ]

    PASSED = [
        ("engine/base/a.hpp", "#include <boost/lockfree/spsc_queue.hpp>\n#include <chrono>"),
        ("engine/fft/a.cpp", "#include <fftw3.h>\n#include <mutex>"),
        ("engine/wind/blend/a.cpp", '// steady_clock::now() is the caller\'s\n#include "engine/noise/noise_tile.hpp"'),
        ("engine/wire/a.cpp", '#include "pose_generated.h"\n#include <flatbuffers/flatbuffers.h>'),
        ("drivers/bus/a.cpp", "#include <modbus/modbus.h>\n#include <sys/socket.h>\n#include <thread>"),
        ("drivers/modbus/modbus.cpp", '#include "drivers/bus/modbus_connection.hpp"\n#include <toml++/toml.h>'),
        ("daemon/commands/a.cpp", '#include "engine/scenes/scene.hpp"\n#include <CLI/CLI.hpp>'),
        ("viewer/app/a.cpp", "#include <GLFW/glfw3.h>\n#include <backends/imgui_impl_glfw.h>\n#include <CLI/CLI.hpp>"),
        ("viewer/picture/a.cpp", "#include <glm/vec3.hpp>\n#include <stb_image_write.h>"),
        ("simulators/core/a.cpp", '#include "drivers/windlog/windlog_reader.hpp"'),
        ("simulators/modbus/a.cpp", "#include <modbus/modbus.h>"),
    ]

    def test_refuses_what_is_not_linked(self):
        for path, text in self.REFUSED:
            with self.subTest(path=path, text=text):
                self.assertEqual(len(faults_of(path, text, self.rooms)), 1)

    def test_passes_what_is_linked(self):
        for path, text in self.PASSED:
            with self.subTest(path=path, text=text):
                self.assertEqual(faults_of(path, text, self.rooms), [])

    FILES = ["engine/base/a.hpp", "engine/pose/b.cpp", "tests/engine/base/a_test.cpp", "tests/answer/README.md"]

    MISSING = [
        ("see `c.hpp`", "c.hpp"),
        ("see [the other](../cellar/README.md)", "../cellar/README.md"),
        ("engine/cellar is below", "engine/cellar"),
        ("    from engine/base/c.hpp on", "engine/base/c.hpp"),
        ("`engine/*/c.*pp`", "engine/*/c.*pp"),
    ]

    PRESENT = [
        "`a.hpp`, `engine/pose/b.cpp`, `base/a_test.cpp`, `engine/*/a.hpp`",
        "engine/base's, (tests/engine/base), [answers](../../tests/answer/README.md), [paper](https://example.org/a.md)",
        "`NAME_job.hpp`, and a.toml without backquotes",
    ]

    def test_finds_paths_that_are_not_there(self):
        for text, path in self.MISSING:
            with self.subTest(text=text):
                self.assertEqual(missing_paths("engine/base", text, self.FILES), [path])

    def test_passes_paths_that_are_there(self):
        for text in self.PRESENT:
            with self.subTest(text=text):
                self.assertEqual(missing_paths("engine/base", text, self.FILES), [])

    def test_finds_circles(self):
        self.assertEqual(rooms.circle_in({"a": {"b", "c"}, "b": {"c"}, "c": set()}), [])
        self.assertEqual(rooms.circle_in({"a": {"b"}, "b": {"c"}, "c": {"b"}}), ["b", "c", "b"])

    def test_reads_what_a_room_links(self):
        read = rooms.rooms_of(
            {
                "engine/base": "yuragi_room(engine/base SOURCES a.cpp)",
                "engine/math": "# of numbers\nyuragi_room(engine/math\n  LINK yuragi_engine_base fmt::fmt)",
                "daemon/web": "yuragi_room(daemon/web LINK yuragi_engine_math yuragi_all PkgConfig::CURL)",
                "drivers": "target_link_libraries(yuragi_all PUBLIC yuragi_drivers_hid)",
                "drivers/hid": "yuragi_room(drivers/hid LINK yuragi_engine_base)",
                "daemon": "yuragi_program(yuragi LINK yuragi_daemon_web CLI11::CLI11)",
            }
        )
        self.assertEqual(read["engine/math"].links, {"engine/base"})
        self.assertEqual(read["engine/math"].libraries, ["fmt"])
        self.assertEqual(read["daemon/web"].links, {"engine/math"})
        self.assertEqual(read["daemon/web"].may_include, {"engine/base", "engine/math", "drivers/hid"})
        self.assertEqual(read["daemon"].may_include, {"daemon/web", "engine/base", "engine/math", "drivers/hid"})
        self.assertEqual(read["daemon"].libraries, ["CLI"])

    def test_says_where_and_what(self):
        self.assertEqual(
            faults_of("engine/math/a.cpp", '#include <cmath>\n#include "engine/wind/wind_state.hpp"', self.rooms),
            ["engine/math/a.cpp:2: engine/wind/wind_state.hpp: engine/math may not include engine/wind"],
        )


if __name__ == "__main__":
    ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
