#!/usr/bin/env python3
"""What each USB weather station says besides the wind, from its reports into a recording and out of it: a simulated station in a
testbed of umockdev's, `yuragi run --record`, `yuragi export --quantities` while it records and after it.

usage: station_weather_test.py DIRECTORY-OF-THE-PROGRAMS
"""
import csv
import io
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

from programs import HANG_S, Program

PROGRAMS = pathlib.Path(sys.argv.pop(1))
YURAGI = PROGRAMS / "yuragi"
PACE = 60  # times as fast as the real station: a WMR300's pressure, every 15 minutes, comes every 15 s

# What the simulated stations say (simulators/usb), in the units of the recording.
WEATHER = {
    "wmr100": {"air_temperature_c": 19.6, "relative_humidity_percent": 58, "pressure_hpa": 1005, "rain_total_mm": 63.5},
    "wmr300": {"air_temperature_c": -3.6, "relative_humidity_percent": 58, "pressure_hpa": 981.7, "rain_total_mm": 63.5,
               "rain_rate_mm_h": 2.54},
    "te923": {"air_temperature_c": 19.65, "relative_humidity_percent": 58, "pressure_hpa": 1005, "rain_total_mm": 25.4},
    "acurite": {"air_temperature_c": 1055 / 18 - 40, "relative_humidity_percent": 83, "rain_total_mm": 3.048},
    "fineoffset": {"air_temperature_c": 12, "relative_humidity_percent": 58, "pressure_hpa": 1014.8, "rain_total_mm": 0},
}
NAMES = ("vertical_speed_m_s", "air_temperature_c", "pressure_hpa", "relative_humidity_percent", "rain_total_mm", "rain_rate_mm_h")


def rows_of(recording, *options):
    """The rows of an export; none where there is no recording yet."""
    done = subprocess.run([YURAGI, "export", recording, "-o", "-", *options], capture_output=True, text=True, check=False)
    return list(csv.DictReader(io.StringIO(done.stdout))) if done.returncode == 0 else []


def said_in(rows):
    """All values of each quantity."""
    return {name: {float(row[name]) for row in rows if row[name]} for name in NAMES}


class StationWeather(unittest.TestCase):
    def record(self, station):
        with tempfile.TemporaryDirectory() as folder:
            config, wall = pathlib.Path(folder, "site.toml"), pathlib.Path(folder, "wall.windlog")
            config.write_text(f'[[sensor]]\nname = "roof"\ndriver = "hid"\nstation = "{station}"\npace = {PACE}.0\n')
            with Program(PROGRAMS / "yuragi-sim", "hid", "--device", station, "--pace", PACE, "--umockdev", "--",
                         YURAGI, "run", "-c", config, "--record", wall, "--listen", "127.0.0.1:0") as daemon:
                daemon.wait_for("sensor roof: connected")
                until = time.monotonic() + HANG_S
                wanted = set(WEATHER[station])
                while not wanted <= {name for name, values in said_in(rows_of(wall, "--quantities")).items() if values}:
                    self.assertIsNone(daemon.process.poll(), daemon.text())
                    self.assertLess(time.monotonic(), until, daemon.text())
                daemon.end()
            return rows_of(wall, "--quantities"), rows_of(wall)

    def check(self, station):
        rows, readings = self.record(station)
        self.assertEqual({row["sensor"] for row in rows}, {"roof"})
        self.assertEqual(len({row["time_utc"] for row in rows}), len(rows), "one row a second")
        said = said_in(rows)
        for name in NAMES:
            with self.subTest(quantity=name):
                expected = WEATHER[station].get(name)
                self.assertEqual(len(said[name]), 0 if expected is None else 1, said[name])
                if expected is not None:
                    self.assertAlmostEqual(said[name].pop(), expected, places=9)
        self.assertTrue(readings, "besides the wind, not in its place")

    def test_of_a_wmr100(self):
        self.check("wmr100")

    def test_of_a_wmr300(self):
        self.check("wmr300")

    def test_of_a_te923(self):
        self.check("te923")

    def test_of_an_acurite(self):
        self.check("acurite")

    def test_of_a_fineoffset(self):
        self.check("fineoffset")


if __name__ == "__main__":
    unittest.main()
