#!/usr/bin/env python3
"""Reads every #include of the project against the table of who may include whom (ARCHITECTURE.md).

usage: include_rules_test.py PROJECT_ROOT

A room is a folder; a file belongs to the deepest room that holds it. A room may always include itself and the C++
standard library (see FORBIDDEN_IN_ENGINE); all else stands in its line of the table.
"""
import pathlib
import re
import sys
import unittest

# room: (rooms that it may use, libraries that it may use). A library is named by how its headers begin.
ROOMS = {
    "engine/base": ("", "boost/system boost/lockfree"),
    "engine/math": ("engine/base", ""),
    "engine/fft": ("engine/base", "fftw3.h"),
    "engine/noise": ("engine/base engine/math engine/fft", ""),
    "engine/wind": ("engine/base engine/math engine/noise", ""),
    "engine/pose": ("engine/base engine/math", ""),
    "engine/operators": ("engine/base engine/math engine/noise engine/pose", ""),
    "engine/scenes": ("engine/base engine/math engine/fft engine/noise engine/wind engine/pose engine/operators", ""),
    "engine/wire": ("engine/base engine/pose engine/wind", "flatbuffers pose_generated.h"),
    "drivers/decode": ("engine/base engine/fft engine/wind", ""),
    "drivers/windlog": ("engine/base engine/wind", "sqlite3.h POSIX"),
    "drivers/bus": ("drivers/decode engine/base engine/wind", "modbus hidapi libusb portaudio mosquitto.h lo boost/asio boost/system fmt POSIX"),
    "drivers": ("drivers/bus drivers/decode drivers/windlog engine/base engine/wind", "toml++ nlohmann fmt POSIX"),
    "daemon": (
        "engine/base engine/math engine/fft engine/noise engine/wind engine/pose engine/operators engine/scenes"
        " engine/wire drivers drivers/bus drivers/decode drivers/windlog",
        "boost/asio boost/beast boost/system CLI toml++ nlohmann spdlog fmt libfccp date POSIX",
    ),
    "viewer": (
        "engine/base engine/math engine/pose engine/wire",
        "GLFW epoxy glm imgui backends/imgui stb boost/asio boost/system CLI fmt spdlog POSIX",
    ),
    "simulators": (
        "engine/base engine/math engine/fft engine/noise engine/wind drivers/windlog",
        "modbus umockdev.h boost/asio boost/system CLI toml++ fmt spdlog POSIX",
    ),
}

# The engine computes: it opens no file, starts no thread, reads no clock, writes no log, and draws no random number
# whose bits the standard leaves open. FFTW's planner alone needs a lock.
FORBIDDEN_IN_ENGINE = set(
    "thread mutex shared_mutex condition_variable future semaphore barrier latch stop_token fstream iostream filesystem"
    " cstdio ctime csignal random".split()
)
ALLOWED_ALL_THE_SAME = {("engine/fft", "mutex")}
CLOCK_READ = re.compile(r"\b(?:steady|system|high_resolution|utc)_clock::now\b")

# Of these a driver's file may wrap one.
C_LIBRARIES = "modbus hidapi libusb portaudio sqlite3.h mosquitto.h lo umockdev.h".split()

# The operating system's own headers.
POSIX = set(
    "arpa dlfcn.h fcntl.h ifaddrs.h linux net netdb.h netinet poll.h pthread.h sched.h signal.h spawn.h sys sysexits.h"
    " termios.h time.h unistd.h malloc.h".split()
)

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"(?P<own>[^"]+)"|<(?P<outside>[^>]+)>)')


def room_of(path):
    """The deepest room of the table that holds the file; None outside all of them."""
    inside = [room for room in ROOMS if path.startswith(room + "/")]
    return max(inside, key=len, default=None)


def library_of(header, libraries):
    """Which of `libraries` the header belongs to, or None."""
    for library in libraries:
        if library == "POSIX" and header.split("/")[0] in POSIX:
            return library
        if header == library or header.startswith((library + "/", library + ".", library + "-", library + "_")):
            return library
    return None


def fault_of_own(room, header, generated=("pose_generated.h",)):
    """What is wrong with #include "header" in `room`, or None."""
    if header in generated:
        return fault_of_outside(room, header)
    target = room_of(header)
    if target is None:
        return "is no path from the project's root into a room of the table"
    if target != room and target not in ROOMS[room][0].split():
        return f"{room} may not use {target}"
    return None


def fault_of_outside(room, header):
    """What is wrong with #include <header> in `room`, or None."""
    if re.fullmatch(r"[a-z_0-9]+", header):  # the C++ standard library
        if room.startswith("engine/") and header in FORBIDDEN_IN_ENGINE and (room, header) not in ALLOWED_ALL_THE_SAME:
            return "the engine has no file, thread, clock, log or random device"
        return None
    if library_of(header, ROOMS[room][1].split()) is None:
        return f"{room} may not use this library"
    return None


def faults_of(path, text):
    """Every breach of the table in one file, each as "path:line: header: what is wrong"."""
    room = room_of(path)
    if room is None:
        return [f"{path}:1: stands in no room of the table"]
    faults = []
    wrapped = set()
    for number, line in enumerate(text.splitlines(), 1):
        include = INCLUDE.match(line)
        if include:
            header = include["own"] or include["outside"]
            fault = fault_of_own(room, header) if include["own"] else fault_of_outside(room, header)
            if fault:
                faults.append(f"{path}:{number}: {header}: {fault}")
            wrapped.add(library_of(header, C_LIBRARIES))
        elif room.startswith("engine/") and CLOCK_READ.search(line.split("//")[0]):
            faults.append(f"{path}:{number}: reads a clock: time is a parameter")
    if len(wrapped - {None}) > 1:
        faults.append(f"{path}:1: wraps more than one C library: {', '.join(sorted(wrapped - {None}))}")
    return faults


def sources(root):
    for top in sorted({room.split("/")[0] for room in ROOMS}):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".hpp", ".cpp", ".h", ".c") and path.is_file():
                yield path


class TheProject(unittest.TestCase):
    def test_keeps_to_the_table(self):
        files = list(sources(ROOT))
        self.assertGreater(len(files), 30, "the sources were not found")
        faults = []
        for path in files:
            faults += faults_of(path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8"))
        self.assertEqual(faults, [], "\n" + "\n".join(faults))

    def test_has_every_room_of_the_table(self):
        self.assertEqual([room for room in ROOMS if not (ROOT / room).is_dir()], [])


class TheCheck(unittest.TestCase):
    """It must be able to fail: samples that it has to refuse, and some that it has to pass."""

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
        ("drivers/modbus.cpp", "#include <modbus.h>"),
        ("drivers/windlog/a.cpp", '#include "drivers/sensor.hpp"'),
        ("drivers/synthetic.cpp", '#include "daemon/config.hpp"'),
        ("drivers/bus/a.cpp", "#include <modbus/modbus.h>\n#include <libusb-1.0/libusb.h>"),
        ("daemon/a.cpp", "#include <GLFW/glfw3.h>"),
        ("daemon/transports/a.cpp", '#include "viewer/orbit_camera.hpp"'),
        ("viewer/a.cpp", '#include "engine/scenes/scene.hpp"'),
        ("viewer/a.cpp", '#include "drivers/sensor.hpp"'),
        ("simulators/a.cpp", '#include "drivers/decode/modbus.hpp"'),
        ("simulators/a.cpp", '#include "drivers/modbus_profile.hpp"'),
    ]

    PASSED = [
        ("engine/base/a.hpp", "#include <boost/lockfree/spsc_queue.hpp>\n#include <chrono>"),
        ("engine/fft/a.cpp", "#include <fftw3.h>\n#include <mutex>"),
        ("engine/wind/a.cpp", '// steady_clock::now() is the caller\'s\n#include "engine/noise/noise_tile.hpp"'),
        ("engine/wire/a.cpp", '#include "pose_generated.h"\n#include <flatbuffers/flatbuffers.h>'),
        ("drivers/bus/a.cpp", "#include <modbus/modbus.h>\n#include <sys/socket.h>\n#include <thread>"),
        ("drivers/modbus.cpp", '#include "drivers/bus/modbus_connection.hpp"\n#include <toml++/toml.h>'),
        ("daemon/commands/a.cpp", '#include "engine/scenes/scene.hpp"\n#include <CLI/CLI.hpp>'),
        ("viewer/a.cpp", "#include <GLFW/glfw3.h>\n#include <backends/imgui_impl_glfw.h>\n#include <stb_image_write.h>"),
        ("simulators/a.cpp", '#include "drivers/windlog/windlog_reader.hpp"\n#include <modbus/modbus.h>'),
    ]

    def test_refuses_what_the_table_forbids(self):
        for path, text in self.REFUSED:
            with self.subTest(path=path, text=text):
                self.assertEqual(len(faults_of(path, text)), 1)

    def test_passes_what_the_table_allows(self):
        for path, text in self.PASSED:
            with self.subTest(path=path, text=text):
                self.assertEqual(faults_of(path, text), [])

    def test_says_where_and_what(self):
        self.assertEqual(
            faults_of("engine/math/a.cpp", '#include <cmath>\n#include "engine/wind/wind_state.hpp"'),
            ["engine/math/a.cpp:2: engine/wind/wind_state.hpp: engine/math may not use engine/wind"],
        )


if __name__ == "__main__":
    ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
