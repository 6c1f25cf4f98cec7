#!/usr/bin/env python3
"""yuragi accept: simulated devices are handed over by the real program, from the bytes that they send to a page to sign.

usage: accept_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import pty
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

from programs import HANG_S, Program, free_port

BIN = os.path.abspath(sys.argv.pop(1))
YURAGI = os.path.join(BIN, "yuragi")


class Accept(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-accept-")
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.page = os.path.join(self.folder, "page.html")
        self.port = free_port()

    def config(self, *sensors):
        path = os.path.join(self.folder, "wall.toml")
        with open(path, "w", encoding="utf-8") as out:
            out.write(f'[stream]\nlisten = "127.0.0.1:{self.port}"\n[recording]\nfile = "{self.folder}/wall.windlog"\n'
                      '[shaping]\nhours = "Mon 00:00-00:01"\n')
            for sensor in sensors:
                out.write("[[sensor]]\n" + sensor + "\n")
            out.write('[[scene]]\nkind = "grass"\nblades_across = 8\nblades_deep = 8\n')
        return path

    def accept(self, config, *options):
        return subprocess.run([YURAGI, "accept", "--config", config, "--for", "4", "--out", self.page, *options],
                              capture_output=True, text=True, timeout=HANG_S, check=False)

    def start_slave(self):
        slave = Program(os.path.join(BIN, "yuragi-sim"), "modbus", "--tcp", "127.0.0.1:0", "--profile",
                        "renke-rs-fsjt-rs-fxjt-n01")
        self.addCleanup(slave.__exit__)
        return slave.wait_for(r"127\.0\.0\.1:(\d+)").group(1)

    def test_devices_are_measured_from_device_to_pose(self):
        roof = ('name = "roof"\ndriver = "modbus"\nprofile = "renke-rs-fsjt-rs-fxjt-n01"\nhost = "127.0.0.1"\n'
                f"port = {self.start_slave()}")
        config = self.config(roof)
        with open(config + ".page.toml", "w", encoding="utf-8") as out:
            out.write('[[sensor]]\nname = "mast"\ndriver = "modbus"\nprofile = "renke-rs-fsjt-n01"\nport = 1\n')
        done = self.accept(config, "--json", "--site", "Museum")
        self.assertEqual(done.returncode, 1, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual(said["verdict"], "failed")
        measured, missing = said["sensors"]
        self.assertIn(measured["verdict"], ("passed", "remark"), measured)
        self.assertGreater(measured["readings"], 0)
        self.assertGreater(measured["moved_frames"], 0)
        self.assertGreater(measured["delays"], 0)
        self.assertGreaterEqual(measured["median_delay_s"], 0)
        self.assertEqual(missing["verdict"], "failed")
        self.assertIn("Connection refused", missing["remarks"][0])
        self.assertIsNone(missing["median_delay_s"])
        with open(self.page, encoding="utf-8") as page:
            text = page.read()
        self.assertIn("<h1>Hand-over: Museum</h1>", text)
        self.assertIn("taken over by (name)", text)
        self.assertEqual(sorted(os.listdir(self.folder)), ["page.html", "wall.toml", "wall.toml.page.toml"], "nothing is recorded")

    def test_a_sensor_is_simulated_before_it_is_measured(self):
        config = self.config('name = "roof"\ndriver = "modbus"\nport = 1')
        done = self.accept(config, "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual(said["simulated"][0]["verdict"], "passed", said)
        self.assertEqual(said["sensors"][0]["verdict"], "failed", said)
        with open(self.page, encoding="utf-8") as page:
            self.assertIn('<span class="passed">passed</span></td><td><span class="failed">failed</span>', page.read())

    def test_sensors_are_simulated_with_nothing_connected(self):
        config = self.config('name = "roof"\ndriver = "modbus"\ntransport = "rtu"\ndevice = "/dev/ttyUSB77"\n'
                             'speed_slave = 5\ndirection_slave = 6\n[sensor.calibration]\ngain = 1.5\nnorth_offset = 20',
                             'name = "mast"\ndriver = "nmea"\ndevice = "/dev/ttyUSB78"\nnorth_offset = -30',
                             'name = "yard"\ndriver = "line"\ndevice = "/dev/ttyACM77"\nformat = "keys"',
                             'name = "made-up"\ndriver = "synthetic"')
        done = self.accept(config, "--simulated-only", "--json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual(said["sensors"], [])
        self.assertTrue(said["is_rehearsal"])
        roof, mast, yard, made_up = said["simulated"]
        self.assertEqual([one["verdict"] for one in (roof, mast, yard)], ["passed"] * 3, said)
        self.assertAlmostEqual(roof["mean_speed_m_s"], 12, delta=0.15)
        self.assertAlmostEqual(roof["direction_deg"], 245, delta=1)
        self.assertAlmostEqual(mast["mean_speed_m_s"], 8, delta=0.1)
        self.assertAlmostEqual(mast["direction_deg"], 195, delta=1)
        self.assertGreater(mast["moved_frames"], 0)
        self.assertGreater(mast["delays"], 0)
        self.assertIsNone(made_up["verdict"])
        self.assertIn("no simulated device", made_up["remarks"][0])

    def test_the_wind_on_board_is_simulated(self):
        config = self.config('name = "bus"\ndriver = "nmea2000"\ntransport = "can"\ninterface = "can7"\nreference = "north"',
                             'name = "program"\ndriver = "nmea2000"\ndevice = "/dev/ttyUSB77"\nformat = "canboat"\nangle_unit = "rad"',
                             'name = "server"\ndriver = "signalk"\nhost = "boat.example"\nnorth_offset = -30')
        done = self.accept(config, "--simulated-only", "--json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        simulated = json.loads(done.stdout)["simulated"]
        self.assertEqual([one["verdict"] for one in simulated], ["passed"] * 3, simulated)
        for one, direction_deg in zip(simulated, (225, 225, 195)):
            self.assertAlmostEqual(one["mean_speed_m_s"], 8, delta=0.1)
            self.assertAlmostEqual(one["direction_deg"], direction_deg, delta=1)

    def test_stations_in_the_network_are_simulated_on_this_machine(self):
        # One that pushes, one that is asked and sends, too, and a program that sends; the plans of all are in simulated_sensor_test.cpp.
        config = self.config('name = "console"\ndriver = "ecowitt-push"\nhost = "0.0.0.0"\nfrom = "192.0.2.0/24"\npath = "/roof/"\n'
                             f'station_key = "hunter2"\nport = {free_port()}',
                             f'name = "live"\ndriver = "weatherlink"\nhost = "192.0.2.8"\nport = {free_port(socket.SOCK_DGRAM)}',
                             'name = "airport"\ndriver = "json"\nurl = "https://192.0.2.9/metar?key=hunter2"\nspeed = "/0/wspd"\n'
                             'direction = "/0/wdir"\ntime = "/0/obsTime"\nspeed_unit = "kn"',
                             f'name = "show"\ndriver = "osc"\naddress = "/roof"\nspeed_argument = 2\nport = {free_port(socket.SOCK_DGRAM)}')
        done = self.accept(config, "--simulated-only", "--json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        for one in json.loads(done.stdout)["simulated"]:
            self.assertEqual(one["verdict"], "passed", one)
            self.assertAlmostEqual(one["mean_speed_m_s"], 8, delta=0.1)
            self.assertAlmostEqual(one["direction_deg"], 225, delta=1)
        with open(self.page, encoding="utf-8") as page:
            self.assertNotIn("hunter2", page.read() + done.stdout + done.stderr)

    def test_wrong_slave_ids_in_a_profile_are_a_verdict(self):
        source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../drivers/modbus/profiles/renke-rs-fsjt-n01.toml")
        profile = os.path.join(self.folder, "renke-rs-fsjt-n01.toml")
        with open(source, encoding="utf-8") as right, open(profile, "w", encoding="utf-8") as wrong:
            wrong.write(right.read().replace("\nslave = 1\n", "\nslave = 7\n"))
        done = self.accept(self.config(f'name = "roof"\ndriver = "modbus"\nprofile = "{profile}"'), "--simulated-only", "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        roof = json.loads(done.stdout)["simulated"][0]
        self.assertEqual(roof["verdict"], "failed")
        self.assertRegex(roof["remarks"][0], "no reading in")

    def test_what_the_simulator_does_not_know_is_said(self):
        source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../drivers/modbus/profiles/renke-rs-fsjt-n01.toml")
        profile = os.path.join(self.folder, "my-own.toml")
        shutil.copy(source, profile)
        done = self.accept(self.config(f'name = "roof"\ndriver = "modbus"\nprofile = "{profile}"'), "--simulated-only")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("  - not simulated: yuragi-sim cannot simulate it", done.stdout)
        self.assertRegex(done.stdout, r"(?m)^rehearsal .*not a hand-over.*: remark$", "nothing was measured")
        self.assertIn("my-own", done.stderr)
        self.assertNotIn("sign it", done.stderr)
        with open(self.page, encoding="utf-8") as page:
            text = page.read()
        self.assertRegex(text, "<h1>Rehearsal")
        self.assertIn("This is not a hand-over", text)
        self.assertNotIn("signature", text)

    @unittest.skipIf(shutil.which("yuragi-sim", path="/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin"), "one is installed")
    def test_a_simulator_that_is_not_installed_is_said(self):
        alone = shutil.copy(YURAGI, os.path.join(self.folder, "yuragi"))
        config = self.config('name = "roof"\ndriver = "modbus"')
        done = subprocess.run([alone, "accept", "--config", config, "--simulated-only", "--out", self.page],
                              capture_output=True, text=True, timeout=HANG_S, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("  - not simulated: yuragi-sim is not installed", done.stdout)

    def test_the_simulator_ends_with_an_interrupt(self):
        config = self.config('name = "roof"\ndriver = "nmea"\ndevice = "/dev/ttyUSB77"')
        with Program(YURAGI, "accept", "--config", config, "--simulated-only", "--for", "1h", "--out", self.page) as accept:
            port = int(accept.wait_for(r"simulated at 127\.0\.0\.1:(\d+)").group(1))
            with socket.create_connection(("127.0.0.1", port), HANG_S) as device:
                self.assertNotEqual(device.recv(1), b"", "it sends")
                self.assertNotEqual(accept.end(signal.SIGINT), 0)
                try:
                    while device.recv(65536):
                        pass  # until it ends
                except ConnectionResetError:
                    pass

    def test_it_passes_with_remarks_where_readings_are_made_up(self):
        done = self.accept(self.config('name = "made-up"\ndriver = "synthetic"'))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"made-up +remark ")
        self.assertIn("no device was measured", done.stdout)
        self.assertIn("hand-over: remark", done.stdout)
        self.assertEqual(self.accept(self.config('name = "a"\ndriver = "synthetic"')).returncode, 73, "the page is there")

    def test_it_leaves_a_running_daemon_alone(self):
        config = self.config('name = "a"\ndriver = "synthetic"')
        with Program(YURAGI, "run", "--config", config) as daemon:
            daemon.address()
            done = self.accept(config)
            self.assertEqual(done.returncode, 69)
            self.assertIn("stop it first", done.stderr)
            self.assertEqual(daemon.end(), 0)

    def test_it_asks_only_a_person(self):
        config = self.config('name = "a"\ndriver = "synthetic"')
        done = subprocess.run([YURAGI, "accept", "--config", config, "--ask", "--out", self.page], capture_output=True,
                              stdin=subprocess.DEVNULL, text=True, timeout=HANG_S, check=False)
        self.assertEqual(done.returncode, 64)
        self.assertIn("--ask needs a terminal", done.stderr)

    def test_a_vane_is_held_to_the_north(self):
        config = self.config('name = "north"\ndriver = "synthetic"\ndirection = 0\nturbulence = 0',
                             'name = "east"\ndriver = "synthetic"\ndirection = 90\nturbulence = 0',
                             'name = "left out"\ndriver = "synthetic"')
        person, terminal = pty.openpty()
        try:
            os.write(person, b"\n\ns\n")
            done = subprocess.run([YURAGI, "accept", "--config", config, "--ask", "--for", "1", "--json", "--out", self.page],
                                  stdin=terminal, capture_output=True, text=True, timeout=HANG_S, check=False)
        finally:
            os.close(person)
            os.close(terminal)
        self.assertEqual(done.returncode, 1, done.stderr)
        checks = json.loads(done.stdout)["north_checks"]
        self.assertEqual([(check["sensor"], check["verdict"]) for check in checks], [("north", "passed"), ("east", "failed")])
        self.assertAlmostEqual(checks[1]["direction_deg"], 90, delta=5)


if __name__ == "__main__":
    unittest.main(verbosity=2)
