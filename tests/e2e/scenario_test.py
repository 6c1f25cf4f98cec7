#!/usr/bin/env python3
"""`yuragi-sim scenario`: several simulated devices in one wind.

    scenario_test.py BIN REHEARSALS [CLASS.METHOD]

REHEARSALS is the folder of the scenarios that the project comes with, each beside the configuration of its daemon.
"""
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

from programs import HANG_S, Program, free_ports

BIN, REHEARSALS = sys.argv.pop(1), sys.argv.pop(1)
YURAGI = os.path.join(BIN, "yuragi")
SIM = os.path.join(BIN, "yuragi-sim")

TWO_MASTS = """\
[[wind]]
speed = 5

[[device]]
name = "west"
simulate = "nmea --tcp 127.0.0.1:0 --format mwv --rate 10"
faults = ["silence@1h+1min"]

[[device]]
name = "east"
simulate = "nmea --tcp 127.0.0.1:0 --format mwv --rate 10"
"""


def is_running(process):
    try:
        with open(f"/proc/{process}/stat", encoding="ascii") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def wait_until(condition):
    deadline_s = time.monotonic() + HANG_S
    while not condition():
        if time.monotonic() > deadline_s:
            return False
        time.sleep(0.05)
    return True


class ScenarioTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-scenario-")
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def write(self, text, name="here.scenario.toml"):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        return path

    def first_speed(self, port):
        """Of the first whole sentence that a device sends."""
        with socket.create_connection(("127.0.0.1", int(port)), HANG_S) as device:
            with device.makefile(encoding="ascii") as lines:
                lines.readline()
                return float(lines.readline().split(",")[3])

    def test_its_devices_are_in_its_wind_and_take_faults_while_they_run(self):
        path = self.write(TWO_MASTS.replace("speed = 5", "speed = 5\nturbulence = 0"))
        with Program(SIM, "scenario", path, stdin=subprocess.PIPE) as scenario:
            west = scenario.wait_for(r"west: listening on \S+:(\d+)").group(1)
            east = scenario.wait_for(r"east: listening on \S+:(\d+)").group(1)
            self.assertAlmostEqual(self.first_speed(west), 5.0, delta=0.1)
            self.assertAlmostEqual(self.first_speed(east), 5.0, delta=0.1)
            scenario.process.stdin.write(b"east freeze 2min\nnorth freeze\nwest noise\n")
            scenario.process.stdin.flush()
            scenario.wait_for("east: freeze for 120 s")
            scenario.wait_for("with DEVICE one of west east")
            scenario.wait_for("west: allowed: KIND")
            self.assertEqual(scenario.end(), 0)
            scenario.process.stdin.close()

    def test_it_ends_with_the_duration_of_the_file(self):
        with Program(SIM, "scenario", self.write('duration = "0.5s"\n' + TWO_MASTS)) as scenario:
            self.assertEqual(scenario.process.wait(HANG_S), 0)

    def test_a_device_that_fails_ends_it_with_the_reason(self):
        with Program(SIM, "scenario", self.write(TWO_MASTS + 'faults = ["exception@1+1"]\n')) as scenario:
            self.assertEqual(scenario.process.wait(HANG_S), 69)
            self.assertRegex(scenario.text(), r"east: --fault: \"exception@1\+1\" is not a fault")
            self.assertIn("the device east has failed with exit code 64", scenario.text())

    def test_no_device_outlives_it(self):
        for how in (signal.SIGTERM, signal.SIGKILL):
            with Program(SIM, "scenario", self.write(TWO_MASTS)) as scenario:
                scenario.wait_for("west: listening")
                scenario.wait_for("east: listening")
                with open(f"/proc/{scenario.process.pid}/task/{scenario.process.pid}/children", encoding="ascii") as children:
                    devices = children.read().split()
                self.assertEqual(len(devices), 2)
                scenario.end(how)
                for device in devices:
                    self.assertTrue(wait_until(lambda: not is_running(device)), how)  # pylint: disable=cell-var-from-loop

    def test_every_rehearsal_reaches_its_daemon(self):
        names = sorted(name for name in os.listdir(REHEARSALS) if name.endswith(".scenario.toml"))
        self.assertTrue(names)
        for name in names:
            with self.subTest(name):
                self.rehearse(name)

    def rehearse(self, name):
        """On free ports in place of the written ones, with all faults left out: they have tests of their own."""
        with open(os.path.join(REHEARSALS, name), encoding="utf-8") as text:
            scenario = text.read()
        config_name = name.replace(".scenario.toml", ".toml")
        with open(os.path.join(REHEARSALS, config_name), encoding="utf-8") as text:
            config = text.read()
        sensors = [sensor["name"] for sensor in tomllib.loads(config)["sensor"]]
        written = sorted(set(re.findall(r"127\.0\.0\.1:(\d+)", scenario)))
        kinds = [socket.SOCK_DGRAM if f"--udp 127.0.0.1:{port}" in scenario else socket.SOCK_STREAM for port in written]
        for old, new in zip(written, free_ports(kinds)):
            scenario = scenario.replace(f"127.0.0.1:{old}", f"127.0.0.1:{new}")
            config, count = re.subn(rf"^port = {old}\b", f"port = {new}", config, flags=re.M)
            self.assertEqual(count, 1, f"{config_name} is to listen to each port of {name}")
        scenario = re.sub(r"^faults = .*", "", scenario, flags=re.M)
        with Program(SIM, "scenario", self.write(scenario, name)) as devices, \
                Program(YURAGI, "run", "--config", self.write(config, config_name), "--listen", "127.0.0.1:0") as daemon:
            address = daemon.address()

            def all_are_believed():
                status = subprocess.run([YURAGI, "sensors", "watch", "--connect", address, "--once", "--json"],
                                        capture_output=True, text=True, timeout=HANG_S, check=False)
                found = json.loads(status.stdout)["sensors"] if status.returncode == 0 else []
                return [one["name"] for one in found if one["speed_m_s"] is not None] == sensors

            self.assertTrue(wait_until(all_are_believed), devices.text() + daemon.text())
            self.assertEqual(daemon.end(), 0)
            self.assertEqual(devices.end(), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
