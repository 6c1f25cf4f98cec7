#!/usr/bin/env python3
"""`yuragi calibrate` as a technician meets it: simulated sensors, recordings, a terminal, and a file that is theirs.

usage: calibrate_test.py FOLDER_OF_PROGRAMS
"""
import csv
import math
import os
import pty
import random
import re
import select
import subprocess
import sys
import tempfile
import time
import unittest
import wave

import numpy

from programs import Program, shared_data

BIN = os.path.abspath(sys.argv.pop(1))
YURAGI = os.path.join(BIN, "yuragi")
SIMULATOR = os.path.join(BIN, "yuragi-sim")
RENKE = "renke-rs-fsjt-rs-fxjt-n01"
NOBODY = "127.0.0.1:1"  # where no daemon listens


class Calibrate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def file(self, name, text):
        with open(self.path(name), "w", encoding="utf-8", newline="") as out:
            out.write(text)
        return self.path(name)

    def read(self, name):
        with open(self.path(name), encoding="utf-8", newline="") as source:
            return source.read()

    def yuragi(self, *arguments, code=0):
        done = subprocess.run([YURAGI, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=120, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout if code == 0 else done.stderr

    def start(self, *command):
        program = Program(*command)
        self.addCleanup(program.__exit__)
        return program

    def value(self, key, name="wall.toml"):
        """The value of a key, of which the file has one."""
        found = re.findall(rf"^\s*{key}\s*=\s*(\S+)", self.read(name), re.MULTILINE)
        self.assertEqual(len(found), 1, self.read(name))
        return float(found[0])

    def recording(self, rows, name="field"):
        """A recording of rows (time_s, sensor, speed_m_s, direction_deg or None)."""
        table = self.path(name + ".csv")
        with open(table, "w", encoding="ascii", newline="") as out:
            writer = csv.writer(out)
            writer.writerow("utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,quality".split(","))
            begun = 1_700_000_000.0
            for time_s, sensor, speed_m_s, direction_deg in sorted(rows, key=lambda row: row[0]):
                utc = time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(begun + math.floor(time_s)))
                writer.writerow([f"{utc}.{round(1e6 * (time_s % 1.0)):06d}Z", f"{time_s:.6f}", sensor, f"{speed_m_s:.6f}",
                                 "" if direction_deg is None else f"{direction_deg:.4f}", "", "good"])
        log = self.path(name + ".windlog")
        self.yuragi("import", table, "-o", log)
        return log

    TWO_SENSORS = """# the wall of the foyer
[[sensor]]
name = "roof"       # the new one
driver = "modbus"

[[sensor]]
name = "mast"
driver = "modbus"
speed_slave = 3
[sensor.calibration]
gain = 1.0          # from the institute
"""

    # ---- recordings ----

    def test_zero_makes_a_calm_a_calm_and_keeps_the_file_as_it_is(self):
        noise = random.Random(1)
        log = self.recording([(0.5 * i, "roof", 0.31 + noise.gauss(0, 0.02), None) for i in range(200)])
        config = self.file("wall.toml", self.TWO_SENSORS.replace("\n", "\r\n"))
        told = self.yuragi("calibrate", "zero", "--config", config, "--sensor", "roof", "--recording", log, "--yes")
        self.assertRegex(told, r"In still air the sensor reads 0\.3\d\d m/s")
        offset = float(re.search(r"calibration\.offset +0\.0 -> (\S+)", told).group(1))
        self.assertAlmostEqual(offset, -0.31, delta=0.01)
        expected = self.TWO_SENSORS.replace('driver = "modbus"\n\n', f'driver = "modbus"\n[sensor.calibration]\noffset = {offset}\n\n')
        self.assertEqual(self.read("wall.toml"), expected.replace("\n", "\r\n"))
        self.assertEqual(self.read("wall.toml.bak"), self.TWO_SENSORS.replace("\n", "\r\n"))
        self.yuragi("check-config", config)
        again = self.yuragi("calibrate", "zero", "--config", config, "--sensor", "roof", "--recording", log, "--yes")
        self.assertIn("nothing to write", again)

    def test_zero_refuses_wind_and_writes_nothing(self):
        noise = random.Random(2)
        log = self.recording([(0.5 * i, "roof", 3.0 + noise.gauss(0, 0.8), None) for i in range(200)])
        config = self.file("wall.toml", self.TWO_SENSORS)
        told = self.yuragi("calibrate", "zero", "--config", config, "--sensor", "roof", "--recording", log, "--yes", code=65)
        self.assertIn("the air is not still", told)
        self.assertEqual(self.read("wall.toml"), self.TWO_SENSORS)
        self.assertEqual(sorted(os.listdir(self.folder)), ["field.csv", "field.windlog", "wall.toml"])

    def test_north_is_a_mean_through_north(self):
        noise = random.Random(3)
        log = self.recording([(0.5 * i, "roof", 2.0, noise.gauss(0, 3) % 360) for i in range(200)])
        config = self.file("wall.toml", self.TWO_SENSORS)
        told = self.yuragi("calibrate", "north", "--config", config, "--sensor", "roof", "--bearing", 214, "--recording", log, "--yes")
        self.assertRegex(told, r"The vane reads (0\.\d|359\.\d) deg")
        self.assertAlmostEqual(self.value("north_offset"), -146.0, delta=0.8)

    def test_north_refuses_a_vane_that_turns(self):
        log = self.recording([(0.5 * i, "roof", 2.0, (350 + i) % 360) for i in range(100)])
        config = self.file("wall.toml", self.TWO_SENSORS)
        told = self.yuragi("calibrate", "north", "--config", config, "--sensor", "roof", "--bearing", 90, "--recording", log, "--yes", code=65)
        self.assertIn("the vane moved", told)
        still = self.recording([(0.5 * i, "roof", 2.0, None) for i in range(100)], "vaneless")
        told = self.yuragi("calibrate", "north", "--config", config, "--sensor", "roof", "--bearing", 90, "--recording", still, "--yes", code=65)
        self.assertIn("does this sensor have a vane", told)

    def field(self, said_of, turn_deg=0.0, seed=5):
        """Half an hour of two sensors in one wind, which swings about north; `said_of` makes of it what the new one says."""
        noise = random.Random(seed)
        rows = []
        for i in range(1800):
            speed = 6.0 + 4.0 * math.sin(0.011 * i) + noise.gauss(0, 0.3)
            direction = 20.0 * math.sin(0.017 * i)
            rows.append((float(i), "mast", max(0.0, speed), (direction + noise.gauss(0, 4)) % 360))
            rows.append((i + 0.3, "roof", max(0.0, said_of(speed)), (direction - turn_deg + noise.gauss(0, 4)) % 360))
        return self.recording(rows)

    def test_span_against_another_sensor_finds_gain_and_offset(self):
        log = self.field(lambda true: (true - 0.3) / 1.08)
        config = self.file("wall.toml", self.TWO_SENSORS)
        told = self.yuragi("calibrate", "span", "--config", config, "--sensor", "roof", "--reference", "mast", "--recording", log, "--yes")
        fit = re.search(r"line through (\d+) pairs with wind: R\^2 = (\S+), residual (\S+) m/s", told)
        self.assertGreaterEqual(int(fit.group(1)), 175)
        self.assertGreater(float(fit.group(2)), 0.99)
        after = self.read("wall.toml")
        self.assertIn("gain = 1.0          # from the institute", after)
        roof = after[:after.index('name = "mast"')]
        self.assertAlmostEqual(float(re.search(r"gain = (\S+)", roof).group(1)), 1.08, delta=0.01)
        self.assertAlmostEqual(float(re.search(r"offset = (\S+)", roof).group(1)), 0.3, delta=0.06)

    def test_sensors_at_two_heights_are_compared_at_one(self):
        lower = math.log(2.0 / 0.03) / math.log(10.0 / 0.03)  # the wind at 2 m over that at 10 m
        log = self.field(lambda true: lower * true / 1.1)
        config = self.file("wall.toml", self.TWO_SENSORS.replace('"modbus"\n\n', '"modbus"\ncalibration.height = 2\n\n') + "height = 10\n")
        self.yuragi("calibrate", "span", "--config", config, "--sensor", "roof", "--reference", "mast", "--recording", log, "--yes")
        roof = self.read("wall.toml").split('name = "mast"', maxsplit=1)[0]
        self.assertAlmostEqual(float(re.search(r"calibration\.gain = (\S+)", roof).group(1)), 1.1, delta=0.01)

    def test_north_against_another_vane(self):
        log = self.field(lambda true: true, turn_deg=-25.0)
        config = self.file("wall.toml", self.TWO_SENSORS)
        self.yuragi("calibrate", "north", "--config", config, "--sensor", "roof", "--reference", "mast", "--recording", log, "--yes")
        self.assertAlmostEqual(self.value("north_offset"), -25.0, delta=1.0)

    def test_span_makes_a_curve_where_a_line_does_not_fit(self):
        log = self.field(lambda true: 0.5 * true + 0.05 * true * true)
        config = self.file("wall.toml", self.TWO_SENSORS)
        line = self.yuragi("calibrate", "span", "--config", config, "--sensor", "roof", "--reference", "mast", "--recording", log, "--dry-run")
        self.assertIn("nothing was written", line)
        self.assertEqual(self.read("wall.toml"), self.TWO_SENSORS)
        curve = self.yuragi("calibrate", "span", "--config", config, "--sensor", "roof", "--reference", "mast", "--recording", log,
                            "--curve", "--yes")
        residual = r"residual (\S+) m/s"
        self.assertLess(float(re.search(residual, curve).group(1)), 0.7 * float(re.search(residual, line).group(1)))
        self.assertRegex(self.read("wall.toml"), r'\ncurve = "(\d+\.\d+:\d+\.\d+ ?){5,}"\n')
        self.yuragi("check-config", config)

    def test_span_against_two_winds_of_a_recording(self):
        noise = random.Random(7)
        rows = [(0.5 * i, "roof", (3.1 if i < 200 else 10.4) + noise.gauss(0, 0.2), None) for i in range(400)]
        log = self.recording(rows)
        config = self.file("wall.toml", self.TWO_SENSORS)
        self.yuragi("calibrate", "span", "--config", config, "--sensor", "roof", "--speed", 3, "--speed", 11, "--recording", log,
                    "--part", "0,100", "--part", "100,200", "--yes")
        roof = self.read("wall.toml").split('name = "mast"', maxsplit=1)[0]
        gain, offset = (float(re.search(key + r" = (\S+)", roof).group(1)) for key in ("gain", "offset"))
        self.assertAlmostEqual(gain, 8.0 / 7.3, delta=0.02)
        self.assertAlmostEqual(3.1 * gain + offset, 3.0, delta=0.1)
        self.assertIn("as many --part as --speed",
                      self.yuragi("calibrate", "span", "--config", config, "--sensor", "roof", "--speed", 3, "--speed", 11,
                                  "--recording", log, "--part", "0,100", "--yes", code=64))

    def test_span_takes_a_certificate_and_sees_a_unit_in_a_gain(self):
        config = self.file("wall.toml", self.TWO_SENSORS)
        told = self.yuragi("calibrate", "span", "--config", config, "--sensor", "roof", "--points", "10.8:3.0 36:10.0 54:15.0",
                           "--dry-run")
        self.assertIn('set unit = "km/h"', told)
        self.assertIn("R^2 = 1.0000", told)

    def test_span_refuses_nonsense(self):
        config = self.file("wall.toml", self.TWO_SENSORS)
        even = self.recording([(float(i), name, 5.0 + 0.2 * math.sin(i), None) for i in range(600) for name in ("roof", "mast")], "even")
        apart = random.Random(9)
        strangers = self.recording([(float(i), name, 6.0 + 4.0 * math.sin(apart.uniform(0, 6)), None)
                                    for i in range(0, 6000, 10) for name in ("roof", "mast")], "strangers")
        for log, text in ((even, "2 m/s between the slowest and the fastest"), (strangers, "agree too little")):
            told = self.yuragi("calibrate", "span", "--config", config, "--sensor", "roof", "--reference", "mast", "--recording", log,
                               "--yes", code=65)
            self.assertIn(text, told)
        self.assertEqual(self.read("wall.toml"), self.TWO_SENSORS)

    def test_says_what_is_wrong(self):
        config = self.file("wall.toml", self.TWO_SENSORS)
        log = self.recording([(float(i), "attic", 1.0, None) for i in range(20)])
        base = ("--config", config, "--sensor", "roof")
        for arguments, code, text in (
            (("zero", "--config", config, "--yes"), 64, "there are several sensors"),
            (("zero", "--config", config, "--sensor", "cellar", "--yes"), 64, "there are: roof, mast"),
            (("zero", *base), 64, "there is no terminal for questions"),
            (("zero", *base, "--yes", "--recording", log), 65, "there are: attic"),
            (("zero", *base, "--yes", "--recording", self.path("none.windlog")), 66, "the recording does not exist"),
            (("zero", *base, "--yes", "--part", "1,2"), 64, "--part needs --recording"),
            (("north", *base, "--yes", "--connect", NOBODY), 64, "give --bearing"),
            (("span", *base, "--yes"), 64, "the known wind is missing"),
            (("span", *base, "--yes", "--reference", "roof"), 64, "its own reference"),
            (("microphone", *base, "--yes", "--reference", "mast", "--connect", NOBODY), 64, "is not a microphone"),
            (("zero", "--config", self.path("none.toml"), "--yes"), 78, "does not exist"),
        ):
            self.assertIn(text, self.yuragi("calibrate", *arguments, code=code))

    # ---- the microphone ----

    MICROPHONE = """[[sensor]]
name = "mic"
driver = "microphone"
noise_floor = -110.0   # in the cellar, at night

[[sensor]]
name = "cup"
driver = "modbus"
"""

    def microphone_log(self):
        """The real microphones beside a cup, as the driver with no calibration says their sound: 20 P^(1/4) m/s."""
        sound_file = shared_data("mic", "asu_inmp441_north3_2ch_250hz.wav")
        if sound_file is None:
            self.skipTest("../shared/data/mic is not there")
        with wave.open(sound_file) as sound:
            rate = sound.getframerate()
            samples = numpy.frombuffer(sound.readframes(sound.getnframes()), "<i2").reshape(-1, sound.getnchannels()) / 32768.0
        rows = []
        for begin in range(0, len(samples) - rate, rate // 4):
            spectrum = numpy.fft.rfft(samples[begin:begin + rate] * numpy.hanning(rate)[:, None], axis=0)
            hertz = numpy.fft.rfftfreq(rate, 1.0 / rate)
            band = (hertz >= 20.0) & (hertz <= 110.0)
            power = float(2.0 * (numpy.abs(spectrum[band]) ** 2).sum(axis=0).mean() / (0.375 * rate * rate))
            rows.append(((begin + 0.5 * rate) / rate, "mic", 20.0 * power ** 0.25, None))
        with open(shared_data("mic", "asu_inmp441_north3_labels.csv"), encoding="ascii") as labels:
            for line in labels:
                if line[0].isdigit():
                    start, _, _, speed = line.split(",")
                    rows.append((int(start) / rate, "cup", float(speed), None))
        return self.recording(rows, "mic")

    def test_a_real_microphone_beside_a_real_cup(self):
        log = self.microphone_log()
        config = self.file("wall.toml", self.MICROPHONE)
        told = self.yuragi("calibrate", "microphone", "--config", config, "--sensor", "mic", "--reference", "cup", "--recording", log, "--yes")
        error = float(re.search(r"mean error (\S+) m/s on pairs that were not used for the fit", told).group(1))
        print(f"\ncalibrate microphone on the real recording: {error} m/s")
        self.assertLess(error, 0.8)
        after = self.read("wall.toml")
        self.assertIn("noise_floor = -110.0   # in the cellar, at night", after)
        self.assertRegex(after, r'\n(curve = "|exponent = )')
        self.yuragi("check-config", config)

    def test_a_microphone_by_two_winds(self):
        # Heard through the driver's own law: gain 20, exponent 2; made by gain 31, exponent 1.6.
        def said(true):
            return 20.0 * ((true / 31.0) ** (2 * 1.6)) ** 0.25
        log = self.recording([(0.25 * i, "mic", said(3.0 if i < 240 else 9.0), None) for i in range(480)])
        config = self.file("wall.toml", self.MICROPHONE.replace("noise_floor", "# noise_floor"))
        self.yuragi("calibrate", "microphone", "--config", config, "--sensor", "mic", "--speed", 3, "--speed", 9, "--recording", log,
                    "--part", "0,60", "--part", "60,120", "--yes")
        self.assertAlmostEqual(self.value("gain"), 31.0, delta=0.1)
        self.assertAlmostEqual(self.value("exponent"), 1.6, delta=0.01)

    # ---- live ----

    def start_simulator(self, speed, direction):
        return self.start(SIMULATOR, "modbus", "--tcp", "127.0.0.1:0", "--profile", RENKE, "--speed", speed, "--direction", direction,
                          "--turbulence", 0)

    def modbus_entry(self, simulator, calibration=""):
        host, port = simulator.address().rsplit(":", 1)
        return f'[[sensor]]\nname = "roof"\ndriver = "modbus"\nprofile = "{RENKE}"\nhost = "{host}"\nport = {port}\npoll_interval = 0.1\n' + calibration

    def test_a_device_is_calibrated_live(self):
        config = self.file("wall.toml", self.modbus_entry(self.start_simulator(8, 350)))
        told = self.yuragi("calibrate", "span", "--config", config, "--connect", NOBODY, "--speed", 8.8, "--for", 2, "--yes")
        self.assertIn("the devices themselves", told)
        self.assertAlmostEqual(self.value("gain"), 1.1, delta=0.01)
        told = self.yuragi("calibrate", "north", "--config", config, "--connect", NOBODY, "--bearing", 10, "--for", 6, "--yes")
        self.assertAlmostEqual(self.value("north_offset"), 20.0, delta=1.0)
        self.assertIn("not a zero error", self.yuragi("calibrate", "zero", "--config", config, "--connect", NOBODY, "--for", 6, "--yes", code=65))

    def test_the_daemon_that_has_the_device_is_asked_and_what_it_calibrated_is_undone(self):
        old = "[sensor.calibration]\ngain = 1.5\noffset = 1.0\nnorth_offset = 90\n"
        config = self.file("wall.toml", self.modbus_entry(self.start_simulator(8, 350), old))
        daemon = self.start(YURAGI, "run", "--config", config, "--listen", "127.0.0.1:0")
        told = self.yuragi("calibrate", "north", "--config", config, "--connect", daemon.address(), "--bearing", 10, "--for", 6, "--yes")
        self.assertIn("from the running daemon at", told)
        self.assertAlmostEqual(self.value("north_offset"), 20.0, delta=1.0)
        # The line through its zero (-2/3 m/s) and (8, 10): 10 / 8.667.
        self.yuragi("calibrate", "span", "--config", config, "--connect", daemon.address(), "--speed", 10, "--for", 2, "--yes")
        self.assertAlmostEqual(self.value("gain"), 10.0 / (8.0 + 2.0 / 3.0), delta=0.01)

    def test_a_recording_of_the_daemon_holds_what_the_sensor_itself_said(self):
        entry = self.modbus_entry(self.start_simulator(8, 350), "[sensor.calibration]\ngain = 1.5\noffset = 1.0\n")
        config = self.file("wall.toml", entry)
        log = self.path("day.windlog")
        self.yuragi("record", log, "--config", config, "--listen", "127.0.0.1:0", "--duration", "3")
        self.file("wall.toml", entry.replace("poll_interval = 0.1", "poll_interval = 0.5"))
        told = self.yuragi("calibrate", "span", "--config", config, "--speed", 10, "--recording", log, "--yes")
        self.assertRegex(told, r"At 10 m/s the sensor reads 8\.\d+ m/s")
        self.assertIn('the driver of "roof" had different settings: poll_interval', told)
        self.assertAlmostEqual(self.value("gain"), 10.0 / (8.0 + 2.0 / 3.0), delta=0.01)

    def test_a_daemon_that_has_the_microphone_must_be_ended_first(self):
        config = self.file("wall.toml", '[[sensor]]\ndriver = "microphone"\nworker = "/bin/false"\n')
        daemon = self.start(YURAGI, "run", "--config", config, "--listen", "127.0.0.1:0")
        told = self.yuragi("calibrate", "microphone", "--config", config, "--speed", 3, "--speed", 9, "--connect", daemon.address(),
                           "--yes", code=69)
        self.assertIn("stop it for the calibration", told)
        self.assertIn("has no zero", self.yuragi("calibrate", "zero", "--config", config, "--yes", code=64))

    def test_a_person_is_led_through_it(self):
        config = self.file("wall.toml", self.modbus_entry(self.start_simulator(8, 350)))
        for answer, written in (("", False), ("y", True)):
            controller, terminal = pty.openpty()
            self.addCleanup(os.close, controller)
            led = subprocess.Popen([YURAGI, "calibrate", "north", "--config", config, "--connect", NOBODY, "--for", "4"],
                                   stdin=terminal, stdout=terminal, stderr=terminal)
            os.close(terminal)
            self.addCleanup(led.wait)
            self.addCleanup(led.kill)
            shown = ""

            def wait_for(text):
                nonlocal shown
                deadline = time.monotonic() + 60.0
                while text not in shown:
                    self.assertLess(time.monotonic(), deadline, shown)
                    if select.select([controller], [], [], 0.1)[0]:
                        try:
                            shown += os.read(controller, 4096).decode("utf-8", "replace")
                        except OSError:  # the other end is closed
                            self.fail(shown)

            def type_line(text):
                os.write(controller, (text + "\n").encode())

            wait_for("Its bearing")
            type_line("west")
            wait_for("Its bearing")
            type_line("10")
            wait_for("Press Enter when ready")
            type_line("")
            wait_for("Write this to")
            self.assertIn("of 4 s", shown)
            self.assertIn("from 350 deg", shown)
            type_line(answer)
            wait_for("was written" if written else "Nothing was written.")
            self.assertEqual(led.wait(10.0), 0)
            self.assertEqual(os.path.exists(config + ".bak"), written)
        self.assertAlmostEqual(self.value("north_offset"), 20.0, delta=1.0)


if __name__ == "__main__":
    unittest.main()
