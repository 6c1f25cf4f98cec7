#!/usr/bin/env python3
"""The rehearsal of the next boot: `yuragi check-config --as-service` finds each of the prepared faults, and a reload warns of them.

usage: next_boot_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import socket
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

from programs import HANG_S, Program

BIN = os.path.abspath(sys.argv.pop(1))
YURAGI = os.path.join(BIN, "yuragi")
# The user is another than who tests; /tmp is the machine's own, since the files of the test are there.
UNIT = f"[Service]\nExecStart={YURAGI} run\nUser=nobody\nGroup=nogroup\nProtectHome=yes\n"


def run(*arguments):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, timeout=HANG_S, check=False)


def png():
    """A white pixel."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(b"\0\xff\xff\xff")) + chunk(b"IEND", b""))


class NextBoot(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        os.chmod(self.folder, 0o755)
        self.write("token", b"0123456789abcdef0123456789abcdef\n", 0o640)
        os.chown(self.path("token"), -1, 65534) if os.geteuid() == 0 else os.chmod(self.path("token"), 0o644)
        self.write("picture.png", png(), 0o644)
        self.write("port", b"", 0o666)
        self.write("yuragi.service", UNIT.encode(), 0o644)
        for name, mode in (("recordings", 0o777), ("profiles", 0o755)):
            os.mkdir(self.path(name))
            os.chmod(self.path(name), mode)
        self.taken = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(self.taken.close)
        self.values = {"stream": "127.0.0.1:0", "page": "127.0.0.1:0", "token": self.path("token"), "device": self.path("port"),
                       "recording": self.path("recordings/wind.windlog"), "profiles": self.path("profiles"), "monitor": ""}

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content, mode):
        with open(self.path(name), "wb") as out:
            out.write(content)
        os.chmod(self.path(name), mode)

    def configuration(self, **values):
        v = {**self.values, **values}
        self.write("wall.toml", f"""
[stream]
listen = "{v["stream"]}"
[http]
listen = "{v["page"]}"
token_file = "{v["token"]}"
[recording]
file = "{v["recording"]}"
min_free = 0
[[sensor]]
name = "made-up"
driver = "synthetic"
[[sensor]]
name = "line"
driver = "line"
device = "{v["device"]}"
[[sensor]]
name = "roof"
driver = "modbus"
profile = "renke-rs-fsjt-rs-fxjt-n01"
profile_dir = "{v["profiles"]}"
host = "127.0.0.1"
[[scene]]
kind = "flag"
image = "picture.png"
[[output]]
[[output.window]]
monitor = "{v["monitor"]}"
""".encode(), 0o644)
        return self.path("wall.toml")

    def findings(self, **values):
        done = run("check-config", self.configuration(**values), "--as-service", "--unit", self.path("yuragi.service"), "--json")
        self.assertEqual(done.stderr, "")
        report = json.loads(done.stdout)
        self.assertEqual(done.returncode, 1 if report["verdict"] == "error" else 0)
        return [(one["verdict"], one["text"], one["remedy"]) for one in report["findings"] if one["verdict"] != "ok"]

    # Beside the built program there are no profiles: the service would miss them, too.
    def other_findings(self, **values):
        return [one for one in self.findings(**values) if not one[1].startswith(("profiles of ", "http.token_file"))]

    def test_a_service_that_finds_everything_has_no_finding(self):
        self.assertEqual(self.other_findings(), [])

    def test_each_prepared_fault_is_found_with_what_mends_it(self):
        taken = "127.0.0.1:%d" % self.taken.getsockname()[1]
        faults = [  # what is prepared, what is configured, the beginning of the finding, a part of it and of the remedy
            ("token missing", None, {"token": self.path("none")}, "[http] token_file", "is missing", "yuragi token"),
            ("token of others", ("token", 0o600, 0o640), {}, "[http] token_file", "may not read it", "sudo chgrp nogroup"),
            ("token at home", None, {"token": "/home/nobody-there/token"}, "[http] token_file", "cannot see /home", "sudo cp"),
            ("stream port taken", None, {"stream": taken}, "[stream] listen", "cannot listen here", "ss -lntup"),
            ("page port taken", None, {"page": taken}, "[http] listen", "cannot listen here", "ss -lntup"),
            ("recording's folder missing", None, {"recording": self.path("none/a.windlog")}, "[recording] file", "is missing",
             "sudo install -d -o nobody -g nogroup"),
            ("recording's folder of others", ("recordings", 0o755, 0o777), {}, "[recording] file", "may not write it",
             "sudo chown nobody:nogroup"),
            ("picture of others", ("picture.png", 0o600, 0o644), {}, "scene flag image", "may not read it", "chmod g+r"),
            ("serial port of others", ("port", 0o600, 0o666), {}, "sensor line", "may not open it", ""),
            ("profiles missing", None, {"profiles": self.path("none")}, "sensor roof profile_dir", "is missing", "ls -l"),
            ("profiles of others", ("profiles", 0o700, 0o755), {}, "sensor roof profile_dir", "may not read it", "chmod g+rx"),
        ]
        with open("/proc/sys/net/ipv4/ip_unprivileged_port_start", encoding="ascii") as file:
            if int(file.read()) > 81:
                faults.append(("low port", None, {"page": "127.0.0.1:81"}, "[http] listen", "below", "CAP_NET_BIND_SERVICE"))
        for name, mode, values, beginning, text, remedy in faults:
            with self.subTest(name):
                if mode:
                    os.chmod(self.path(mode[0]), mode[1])
                found = self.other_findings(**values)
                if mode:
                    os.chmod(self.path(mode[0]), mode[2])
                self.assertEqual(len(found), 1, found)
                self.assertEqual(found[0][0], "error")
                self.assertTrue(found[0][1].startswith(beginning), found)
                self.assertIn(text, found[0][1])
                self.assertIn(remedy, found[0][2])

    def test_a_token_that_everybody_can_read_is_a_warning(self):
        os.chmod(self.path("token"), 0o644)
        self.assertIn(f"everybody on this machine can read {self.path('token')}", self.findings()[0][1])

    def test_the_unit_has_to_have_its_user_and_its_program(self):
        self.write("yuragi.service", UNIT.replace("nobody", "no-such-user").encode(), 0o644)
        self.assertIn("there is no user no-such-user", self.other_findings()[0][1])
        self.write("yuragi.service", UNIT.replace(YURAGI, "/usr/bin/yuragi-none").encode(), 0o644)
        self.assertIn("starts /usr/bin/yuragi-none, which is not installed", self.other_findings()[-1][1])

    def test_a_unit_that_is_not_there_is_said_so(self):
        done = run("check-config", self.configuration(), "--as-service", "--unit", self.path("none.service"))
        self.assertEqual(done.returncode, 66)
        self.assertIn("none.service: the unit cannot be read", done.stderr)

    def test_a_reload_applies_the_configuration_and_warns(self):
        scene = '[stream]\nlisten = "127.0.0.1:0"\n[shaping]\nfloor = %s\n'
        self.write("small.toml", (scene % "0.5").encode(), 0o644)
        with Program(YURAGI, "run", "--config", self.path("small.toml")) as daemon:
            address = daemon.address()
            recording = f'[recording]\nfile = "{self.path("none/a.windlog")}"\n'
            self.write("small.toml", ((scene % "1.5") + recording).encode(), 0o644)
            done = run("reload", "--connect", address)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("applied: [shaping] floor: 0.5 -> 1.5\n", done.stdout)
            self.assertIn(f"at the next start: [recording] file: {self.path('none')}: is missing; fix: sudo install", done.stdout)
            daemon.wait_for("reload: at the next start: .*none: is missing")


if __name__ == "__main__":
    unittest.main()
