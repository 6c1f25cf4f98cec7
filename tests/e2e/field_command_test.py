#!/usr/bin/env python3
"""`yuragi field` as a user meets it: the program is run, and NumPy reads what it wrote.

usage: field_command_test.py PATH/TO/yuragi
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

YURAGI = os.path.abspath(sys.argv.pop(1))


class FieldCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "field.npy"

    def run_field(self, *arguments, **options):
        return subprocess.run([YURAGI, "field", "-o", self.file, "--force", *map(str, arguments)],
                              capture_output=True, text=True, timeout=100, **options)

    def field(self, *arguments):
        done = self.run_field(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(str(self.file), done.stdout)
        values = numpy.load(self.file)
        self.assertEqual(values.dtype, numpy.dtype("<f4"))
        self.assertTrue(numpy.isfinite(values).all())
        said = json.loads(self.file.with_suffix(".json").read_text(encoding="utf-8"))
        self.assertEqual(tuple(said["shape"]), values.shape)
        self.assertEqual(said["axes"], ["frame", "component", "z", "y", "x"])
        return values, said

    def refused(self, code, *arguments):
        done = self.run_field(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(list(self.folder.glob("field*")), [])
        return done.stderr

    def test_over_the_ground_it_has_two_components_and_says_where_they_stand(self):
        values, said = self.field("--size", "48,32", "--spacing", "0.5", "--frames", 3, "--rate", 4, "--time", 60)
        self.assertEqual(values.shape, (3, 2, 32, 1, 48))
        self.assertEqual(said["components"], ["u toward east", "v toward north"])
        self.assertEqual(said["x"], {"toward": "east", "first_m": -12.0, "step_m": 0.5})
        self.assertEqual(said["z"], {"toward": "south", "first_m": -8.0, "step_m": 0.5})
        self.assertEqual(said["time"], {"first_s": 60.0, "step_s": 0.25})

    def test_in_space_it_has_three(self):
        values, said = self.field("--dims", 3, "--size", "16,8,12")
        self.assertEqual(values.shape, (1, 3, 12, 8, 16))
        self.assertEqual(said["components"][2], "w up")
        self.assertGreater(values[0, 2].std(), 0.05)
        self.assertLess(abs(values[0, 2].mean()), 2.0)

    def test_in_space_gusts_come_down_as_much_as_the_stress_says(self):
        asked = ("--dims", 3, "--size", 32, "--tile", 32, "--spacing", 2, "--length", 8)
        for stress, told in ((-0.3, ()), (0.5, ("--stress", 0.5)), (-0.6, ("--stress", -0.6)), (0, ("--stress", 0))):
            together = 0.0
            for seed in range(2):  # the mean of two scatters by 0.007
                values, said = self.field(*asked, *told, "--seed", seed)
                together += ((values[0, 0].astype(float) - 8) * values[0, 2]).mean() / 2
            self.assertEqual(said["wind"]["stress"], stress)
            variance = said["wind"]["variance_m2_s2"]
            scale = math.sqrt(variance["along"] * variance["up"])
            self.assertAlmostEqual(said["wind"]["covariance_m2_s2"]["along_up"], stress * scale, places=9)
            self.assertAlmostEqual(together / scale, stress, delta=0.1)
        self.assertNotIn("stress", self.field("--size", 8)[1]["wind"])

    def test_the_variance_is_that_of_the_turbulence_intensity(self):
        total = 0.0
        for seed in range(8):
            values, said = self.field("--speed", 10, "--turbulence", 0.2, "--length", 8, "--size", 256, "--tile", 256,
                                      "--spacing", 0.5, "--seed", seed)
            total += ((values[0, 0].astype(float) - 10) ** 2).mean() / 8
        self.assertAlmostEqual(total / said["wind"]["variance_m2_s2"]["along"], 1.0, delta=0.15)
        self.assertAlmostEqual(said["wind"]["variance_m2_s2"]["along"] / 4.0, 1.0, delta=0.08)

    def test_a_frozen_field_travels_downwind_and_not_upwind(self):
        # From the south-east: toward north-west. 8 m/s for half a second is 4 m, 2 and 83/100 samples of 1 m.
        speed = 8 * math.sqrt(2)
        values, _ = self.field("--frozen", "--direction", 135, "--speed", speed, "--size", 64, "--tile", 64,
                               "--length", 10, "--frames", 2, "--rate", 2)
        gusts = values[:, 0, :, 0, :] - values[:, 0].mean(axis=(1, 2, 3))[:, None, None]

        def likeness(west, north):
            return (gusts[1] * numpy.roll(gusts[0], (-north, -west), axis=(0, 1))).mean() / gusts[0].var()

        self.assertGreater(likeness(4, 4), 0.99)
        self.assertLess(likeness(0, 0), 0.9)
        self.assertLess(likeness(-4, -4), 0.7)
        self.assertLess(likeness(4, -4), 0.8)

    def test_an_evolving_field_changes_while_it_travels(self):
        travelled = {}
        for how in ("--frozen", "--evolving"):
            values, _ = self.field(how, "--speed", 8, "--size", 64, "--tile", 64, "--length", 10, "--frames", 2,
                                   "--rate", 0.125)
            gusts = values[:, 0, :, 0, :] - values[:, 0].mean(axis=(1, 2, 3))[:, None, None]
            # 8 s of 8 m/s are once around.
            travelled[how] = (gusts[0] * gusts[1]).mean() / gusts[0].var()
        self.assertGreater(travelled["--frozen"], 0.99)
        self.assertLess(travelled["--evolving"], 0.8)

    def test_the_seed_decides_every_bit(self):
        first, _ = self.field("--size", 32, "--seed", 4)
        again, _ = self.field("--size", 32, "--seed", 4)
        other, _ = self.field("--size", 32, "--seed", 5)
        self.assertEqual(first.tobytes(), again.tobytes())
        self.assertNotEqual(first.tobytes(), other.tobytes())

    def test_a_size_can_be_in_metres(self):
        values, _ = self.field("--size", "10m", "--spacing", 0.25)
        self.assertEqual(values.shape, (1, 2, 40, 1, 40))

    def test_it_draws_the_first_frame(self):
        for name, begins in (("gusts.svg", b"<?xml"), ("gusts.png", b"\x89PNG")):
            picture = self.folder / name
            self.field("--size", 40, "--plot", picture)
            self.assertTrue(picture.read_bytes().startswith(begins))
            self.assertGreater(picture.stat().st_size, 5000)

    def test_the_live_wind_of_a_recording(self):
        log = self.folder / "hill.windlog"
        table = log.with_suffix(".csv")
        table.write_text("time_s,speed_m_s,direction_deg\n" +
                         "".join(f"{i},{6 + math.sin(0.3 * i):.3f},270\n" for i in range(145)), encoding="ascii")
        done = subprocess.run([YURAGI, "import", table, "-o", log], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        asked = ("--windlog", log, "--size", "20m", "--rate", 1, "--time", 100, "--seed", 3)
        values, said = self.field(*asked, "--frames", 40)
        self.assertEqual(values.shape, (40, 2, 20, 1, 20))
        self.assertEqual(said["wind"]["recording"], "hill.windlog")
        # The wind of the recording everywhere, and each place its own gusts.
        self.assertAlmostEqual(values[:, 0].mean(), 6.0, delta=0.6)
        self.assertAlmostEqual(values[:, 1].mean(), 0.0, delta=0.6)
        self.assertGreater(values[0, 0].std(), 0.02)

        # In the middle it is what `yuragi wind` says of that place, at the same moments.
        wind = subprocess.run([YURAGI, "wind", log, "-o", "-", "--rate", "50", "--seed", "3", "--place", "0,0",
                               "--scene-size", "20"], capture_output=True, text=True)
        rows = [row.split(",") for row in wind.stdout.splitlines() if row[0].isdigit()]
        for frame in (0, 17, 39):
            # But for waves of 25 Hz and more, which 50 states a second cannot show.
            row = rows[(100 + frame) * 50]
            self.assertAlmostEqual(values[frame, 0, 10, 0, 10], float(row[7]), delta=0.01)
            self.assertAlmostEqual(values[frame, 1, 10, 0, 10], float(row[8]), delta=0.01)
        frozen, _ = self.field(*asked, "--frozen", "--frames", 1)
        self.assertGreater(abs(frozen[0] - values[0]).max(), 0.01)

        done = self.run_field("--windlog", log, "--frames", 500, "--rate", 1, "--size", 4)
        self.assertEqual(done.returncode, 65)
        self.assertIn("ends after 144.0 s", done.stderr)

    def test_a_front_of_a_recording_crosses_the_field(self):
        # West wind, 6 m/s; from 200 s on 9 m/s. The windward edge is 28 m west of the middle of a square of 40 m.
        log = self.folder / "front.windlog"
        table = log.with_suffix(".csv")
        table.write_text("time_s,speed_m_s,direction_deg\n" +
                         "".join(f"{i},{9 if i >= 200 else 6},270\n" for i in range(240)), encoding="ascii")
        done = subprocess.run([YURAGI, "import", table, "-o", log], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        values, said = self.field("--windlog", log, "--size", "40m", "--frames", 100, "--rate", 5, "--time", 195)
        self.assertEqual((said["x"]["first_m"], said["x"]["step_m"]), (-20.0, 1.0))
        eastward = values[:, 0, :, 0, :].mean(axis=1)

        def step_s(speeds):
            # The step that fits best among the gusts of the noise.
            parts = [(i, speeds[i:].mean() - speeds[:i].mean()) for i in range(5, 95)]
            return 195 + max(parts, key=lambda part: part[1] ** 2 * part[0] * (100 - part[0]))[0] / 5

        arrived_s = [step_s(column) for column in eastward.T]
        # 8 m from the edge to the first column, and 30 m from there to the thirtieth, at 6 m/s and a little more.
        # The blend itself is up to 2.5 s late with a step.
        self.assertGreater(arrived_s[0] - 200, 8 / 7)
        self.assertLess(arrived_s[0] - 200, 8.3 / 6.1 + 2.5)
        self.assertAlmostEqual(arrived_s[30] - arrived_s[0], 30 / 6.3, delta=0.9)
        self.assertAlmostEqual(arrived_s[15] - arrived_s[0], 15 / 6.3, delta=0.6)

    def test_it_keeps_what_is_there(self):
        self.field("--size", 8)
        old = self.file.read_bytes()
        done = subprocess.run([YURAGI, "field", "-o", self.file, "--size", "16"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 73)
        self.assertIn("--force", done.stderr)
        self.assertEqual(self.file.read_bytes(), old)

    def test_it_says_what_is_wrong_and_leaves_nothing(self):
        self.assertIn("--size", self.refused(64, "--size", "12q"))
        self.assertIn("X,Y,Z", self.refused(64, "--dims", 3, "--size", "12,12"))
        self.assertIn("power of two", self.refused(64, "--tile", 100))
        self.assertIn("largest tile", self.refused(64, "--dims", 3, "--size", 300))
        self.assertIn("--speed", self.refused(64, "--speed", -1))
        self.assertIn("--dims 3", self.refused(64, "--stress", -0.3))
        self.assertIn("--stress", self.refused(64, "--dims", 3, "--stress", 0.7))
        self.assertIn("--windlog", self.refused(64, "--windlog", "some.windlog", "--stress", 0))
        self.assertIn("GB", self.refused(64, "--size", 4000, "--frames", 100000))
        self.assertIn("the recording does not exist", self.refused(66, "--windlog", "nowhere.windlog"))
        self.assertIn("--windlog", self.refused(64, "--windlog", "some.windlog", "--speed", 4))
        self.assertIn(".png or .svg", self.refused(64, "--plot", "field.gif"))

    def test_the_help_teaches_the_axes(self):
        done = subprocess.run([YURAGI, "field", "--help"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0)
        self.assertIn("[frame, component, z, y, x]", done.stdout)
        self.assertIn("yuragi field --speed", done.stdout)


if __name__ == "__main__":
    unittest.main()
