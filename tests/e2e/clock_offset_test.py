#!/usr/bin/env python3
"""The offset of this machine's clock, by a real chronyd: `yuragi doctor`, `yuragi status` and the viewer's --age show it.

usage: clock_offset_test.py DIRECTORY-OF-THE-PROGRAMS DIRECTORY-OF-CHRONY
"""
import getpass
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

from programs import HANG_S, Program, free_ports

PROGRAMS = os.path.abspath(sys.argv.pop(1))
UNPACKED = os.path.abspath(sys.argv.pop(1))  # chrony's package by config/setup.sh, which does not install it
YURAGI, VIEWER = (os.path.join(PROGRAMS, name) for name in ("yuragi", "yuragi-viewer"))
WHERE = os.pathsep.join([os.environ["PATH"], "/usr/sbin", os.path.join(UNPACKED, "usr/sbin"), os.path.join(UNPACKED, "usr/bin")])
CHRONYD, CHRONYC = (shutil.which(name, path=WHERE) for name in ("chronyd", "chronyc"))
CONFIG = """
[[scene]]
name = "meadow"
kind = "grass"
blades_across = 10
blades_deep = 10
[[output]]
delay = 0.12
"""


@unittest.skipUnless(CHRONYD and CHRONYC, "chrony is not there")
class ClockOffset(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        self.config = self.file("wall.toml", CONFIG)

    def file(self, name, text, mode=0o600):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        os.chmod(path, mode)
        return path

    def chronyd(self, name, text):
        """A chronyd that leaves the clock alone, with a server or as one."""
        text += f"bindcmdaddress /\npidfile {self.folder}/{name}.pid\n"
        # -x: never sets the clock; -U: by any user.
        return self.enterContext(Program(CHRONYD, "-x", "-d", "-U", "-u", getpass.getuser(), "-f", self.file(name + ".conf", text)))

    def be_off(self, offset_s):
        """From now on the programs find a chronyc that speaks to a chronyd whose server is ahead of this machine by so much."""
        server_port, command_port = free_ports([socket.SOCK_DGRAM, socket.SOCK_DGRAM])
        self.chronyd("server", f"port {server_port}\nbindaddress 127.0.0.1\nlocal stratum 1\nallow 127.0.0.1\ncmdport 0\n")
        client = self.chronyd("client", f"server 127.0.0.1 port {server_port} offset {offset_s} minpoll -4 maxpoll -2 iburst\nport 0\n"
                              f"cmdport {command_port}\nbindcmdaddress 127.0.0.1\n")
        client.wait_for("Selected source")
        self.file("chronyc", f'#!/bin/sh\nexec {CHRONYC} -h 127.0.0.1 -p {command_port} "$@"\n', 0o700)
        self.environment = {**os.environ, "PATH": self.folder + os.pathsep + os.environ["PATH"]}

    def doctor(self):
        return subprocess.run([YURAGI, "doctor", "--config", self.config], env=self.environment, stdin=subprocess.DEVNULL, capture_output=True,
                              encoding="utf-8", timeout=HANG_S, check=False).stdout

    def test_a_clock_that_is_off_is_reported_by_every_program(self):
        self.be_off(0.02)
        self.assertIn("clock 20 ms behind UTC (chrony)", self.doctor())
        daemon = self.enterContext(Program(YURAGI, "run", "--config", self.config, "--listen", "127.0.0.1:0", env=self.environment))
        address = daemon.address()
        for _ in range(100):
            status = subprocess.run([YURAGI, "status", "--connect", address], stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8",
                                    timeout=HANG_S, check=False)
            if "out of step" in status.stdout:
                break
        self.assertIn("out of step by more than 5 ms: clock 20 ms behind UTC (chrony)", status.stdout)
        self.assertEqual(status.returncode, 1)

    def test_a_clock_that_is_right_needs_nothing(self):
        self.be_off(0.0)
        self.assertRegex(self.doctor(), r"clock 0\.\d\d ms (ahead of|behind) UTC \(chrony\)")

    def test_a_clock_without_a_time_service_is_reported_for_a_wall(self):
        programs = {name: self.file(name, "#!/bin/sh\nexit 1\n", 0o700) for name in ("chronyc", "busctl")}
        self.environment = {**os.environ, "PATH": os.path.dirname(programs["chronyc"]) + os.pathsep + os.environ["PATH"]}
        self.assertRegex(self.doctor(), r"no time server sets it|clock's offset unknown \(|kernel's estimate")


if __name__ == "__main__":
    unittest.main()
