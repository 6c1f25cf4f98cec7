#!/usr/bin/env python3
"""`yuragi wind`: the daemon's wind over a recording, checked from outside.

usage: wind_command_test.py YURAGI
"""
import csv
import io
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

YURAGI = sys.argv.pop(1)
RATE_HZ = 10


def yuragi(*arguments):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True)


class WindCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.log = pathlib.Path(cls.folder.name, "hill.windlog")
        lines = ["time_s,speed_m_s,direction_deg"]
        lines += [f"{i},{6 + math.sin(0.3 * i):.3f},{(350 + 10 * math.sin(0.1 * i)) % 360:.2f}" for i in range(300)]
        table = cls.log.with_suffix(".csv")
        table.write_text("\n".join(lines) + "\n", encoding="ascii")
        assert yuragi("import", table, "-o", cls.log).returncode == 0
        cls.plain = yuragi("wind", cls.log, "-o", "-", "--rate", RATE_HZ)  # several tests compare theirs with it
        assert cls.plain.returncode == 0, cls.plain.stderr

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def wind(self, *arguments):
        run = yuragi("wind", self.log, "-o", "-", *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return self.rows_of(run), run.stderr

    def rows_of(self, run):
        rows = list(csv.DictReader(io.StringIO(run.stdout)))
        return [{key: value if key == "state" else float(value) for key, value in row.items()} for row in rows]

    def test_has_a_state_a_tick_up_to_the_last_reading(self):
        rows, told = self.rows_of(self.plain), self.plain.stderr
        self.assertEqual(len(rows), 299 * RATE_HZ + 1)
        self.assertEqual(rows[0]["time_s"], 0.0)
        self.assertAlmostEqual(rows[-1]["time_s"], 299.0)
        self.assertIn("from 300 readings", told)
        for row in rows:
            self.assertAlmostEqual(math.hypot(row["u_m_s"], row["v_m_s"]), row["speed_m_s"], places=4)
            self.assertTrue(0.0 <= row["trust"] <= 1.0)

    def test_what_the_daemon_would_not_believe_moves_nothing(self):
        table = self.log.with_name("bad.csv")
        lines = ["time_s,speed_m_s,direction_deg"]
        speeds = [6 + math.sin(0.3 * i) for i in range(400)]
        for spike in (100, 160, 161, 170):
            speeds[spike] = 60.0
        speeds[200:320] = [7.25] * 120  # frozen
        lines += [f"{i},{speed:.3f},250" for i, speed in enumerate(speeds)]
        table.write_text("\n".join(lines) + "\n", encoding="ascii")
        bad = table.with_suffix(".windlog")
        self.assertEqual(yuragi("import", table, "-o", bad).returncode, 0)
        everything = table.with_suffix(".toml")
        everything.write_text('[[sensor]]\ndriver = "synthetic"\n[sensor.judge]\nenabled = false\n', encoding="ascii")

        judged = yuragi("wind", bad, "-o", "-", "--rate", RATE_HZ)
        self.assertIn("; 94 rejected", judged.stderr)
        rows = list(csv.DictReader(io.StringIO(judged.stdout)))
        self.assertLess(max(float(row["speed_m_s"]) for row in rows), 15.0)
        self.assertIn("default", {row["state"] for row in rows if 300 < float(row["time_s"]) < 320})
        raw = yuragi("wind", bad, "-o", "-", "--rate", RATE_HZ, "--config", everything)
        self.assertIn("from 400 readings\n", raw.stderr)
        rows = list(csv.DictReader(io.StringIO(raw.stdout)))
        self.assertGreater(max(float(row["speed_m_s"]) for row in rows), 25.0)

    def test_follows_the_sensor_and_passes_through_north(self):
        rows = self.rows_of(self.plain)
        live = [row for row in rows if row["time_s"] > 60.0]
        self.assertTrue(all(row["state"] == "live" for row in live))
        mean = sum(row["speed_m_s"] for row in live) / len(live)
        self.assertAlmostEqual(mean, 6.0, delta=0.3)
        north = [row["direction_deg"] for row in live if 90.0 < row["direction_deg"] < 270.0]
        self.assertEqual(north, [])

    def test_averages_through_north(self):
        # 350 and 10 degrees in turn: their mean is north, whatever the average is over.
        table = self.log.with_name("north.csv")
        lines = [f"{i / 4},6,{350 if i % 2 else 10}" for i in range(400)]
        table.write_text("time_s,speed_m_s,direction_deg\n" + "\n".join(lines) + "\n", encoding="ascii")
        north = self.log.with_name("north.windlog")
        self.assertEqual(yuragi("import", table, "-o", north).returncode, 0)
        run = yuragi("wind", north, "-o", "-", "--sensor-interval", "2", "--rate", "10")
        rows = [row for row in csv.DictReader(io.StringIO(run.stdout)) if float(row["time_s"]) > 30.0]
        self.assertGreater(len(rows), 600)
        v = sum(float(row["v_m_s"]) for row in rows) / len(rows)
        self.assertAlmostEqual(v, -6.0 * math.cos(math.radians(10.0)), delta=0.5)
        for row in rows:
            direction = float(row["direction_deg"])
            self.assertTrue(0.0 <= direction < 360.0 and (direction < 60.0 or direction > 300.0), direction)

    def test_says_the_same_again_and_something_else_with_another_seed(self):
        again = self.wind("--rate", RATE_HZ, "--seed", 1)  # the seed of a configuration that has none
        self.assertEqual(again, (self.rows_of(self.plain), self.plain.stderr))
        self.assertNotEqual(self.wind("--rate", RATE_HZ, "--seed", 6)[0], again[0])

    def test_plays_a_slower_sensor(self):
        _, told = self.wind("--rate", 1, "--sensor-interval", 14)
        self.assertIn("from 22 readings", told)  # 300 s make 21.4 blocks; the last is heard at its end

    def test_plays_a_sensor_as_quick_as_the_recording(self):
        # Of an interval that is no sum of halves each reading stands on the edge of two blocks.
        table = self.log.with_name("quick.csv")
        table.write_text("time_s,speed_m_s,direction_deg\n" + "".join(f"{i / 10:.1f},6,200\n" for i in range(500)), encoding="ascii")
        quick = self.log.with_name("quick.windlog")
        self.assertEqual(yuragi("import", table, "-o", quick).returncode, 0)
        run = yuragi("wind", quick, "-o", "-", "--sensor-interval", "0.1", "--rate", "10")
        self.assertIn("from 500 readings", run.stderr)

    def test_leaves_out_a_gap_and_returns(self):
        run = yuragi("wind", "--gap", "100,200", self.log, "-o", "-")  # a file is no gap
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = self.rows_of(run)
        trust = {round(row["time_s"], 3): row["trust"] for row in rows}
        self.assertGreater(trust[99.0], 0.9)
        self.assertLess(trust[190.0], 0.5)
        self.assertGreater(trust[240.0], 0.9)
        steps = [math.hypot(b["u_m_s"] - a["u_m_s"], b["v_m_s"] - a["v_m_s"]) for a, b in zip(rows, rows[1:])]
        self.assertLess(max(steps), 0.5)

    def test_shapes_the_wind_for_the_scenes_where_it_is_asked_to(self):
        real = self.rows_of(self.plain)
        self.assertEqual(self.wind("--rate", RATE_HZ, "--shaped")[0], real, "an ordinary wind is as it is")
        config = self.log.with_name("wall.toml")
        config.write_text("[shaping]\nceiling = 5\nceiling_most = 6.5\n", encoding="ascii")
        shaped, _ = self.wind("--rate", RATE_HZ, "--shaped", "--config", config)
        self.assertEqual([row["time_s"] for row in shaped], [row["time_s"] for row in real])
        self.assertGreater(max(row["speed_m_s"] for row in real), 6.8)
        for before, after in zip(real, shaped):
            self.assertLess(after["speed_m_s"], 6.5)
            if before["speed_m_s"] <= 5.0:
                self.assertEqual(after["speed_m_s"], before["speed_m_s"])
            turn_deg = (after["direction_deg"] - before["direction_deg"] + 180.0) % 360.0 - 180.0
            self.assertAlmostEqual(turn_deg, 0.0, delta=0.001)
        self.assertEqual(self.wind("--rate", RATE_HZ, "--config", config)[0], real, "the real wind, without --shaped")

    def test_adds_the_wind_at_places(self):
        plain = self.plain.stdout.splitlines()
        run = yuragi("wind", self.log, "-o", "-", "--rate", RATE_HZ, "--place", "0,0", "--place=-3,2.5")
        self.assertEqual(run.returncode, 0, run.stderr)
        with_places = run.stdout.splitlines()
        self.assertEqual(with_places[0], "# u1_m_s, v1_m_s: 0 m east and 0 m south of the middle; "
                                         "u2_m_s, v2_m_s: -3 m east and 2.5 m south of the middle")
        self.assertEqual(with_places[1], plain[0] + ",u1_m_s,v1_m_s,u2_m_s,v2_m_s")
        cells = [line.split(",") for line in with_places[2:]]
        self.assertEqual([",".join(row[:7]) for row in cells], plain[1:])
        # Scenes without an extent: the wind that is shown is that of their middle.
        for row in cells:
            for at_place, shown in zip(row[7:9], row[1:3]):
                self.assertAlmostEqual(float(at_place), float(shown), delta=2.1e-6)  # sums of another order, rounded
        self.assertNotEqual([row[9:11] for row in cells], [row[1:3] for row in cells])

    def test_hears_anemometers_at_their_places(self):
        # Two of them that hear the same: whoever stands between them hears it, too.
        told = ["--sensor-place", "-4,0", "--also", f"{self.log}@4,0"]
        rows, said = self.wind("--rate", RATE_HZ, "--sensor-interval", 1, *told)
        self.assertIn("from 600 readings", said)
        self.assertTrue(all(math.isfinite(row["speed_m_s"]) for row in rows))
        self.assertAlmostEqual(sum(row["speed_m_s"] for row in rows[60 * RATE_HZ:]) / len(rows[60 * RATE_HZ:]), 6.0, delta=0.3)

    def test_writes_a_file_and_keeps_one_that_is_there(self):
        file = self.log.with_name("out.csv")
        self.assertEqual(yuragi("wind", self.log, "--rate", 1, "-o", file).returncode, 0)
        self.assertTrue(file.read_text(encoding="ascii").startswith("time_s,u_m_s,v_m_s,speed_m_s,direction_deg,trust,state\n"))
        self.assertEqual(yuragi("wind", self.log, "--rate", 1, "-o", file).returncode, 73)
        self.assertEqual(yuragi("wind", self.log, "--rate", 1, "-o", file, "--force").returncode, 0)

    def test_says_what_is_wrong(self):
        for arguments, code, text in (
            (["/no/such.windlog", "-o", "-"], 66, "the recording does not exist"),
            ([self.log, "-o", "-", "--gap", "9,3"], 64, "allowed: FROM,TO"),
            ([self.log, "-o", "-", "--rate", "0"], 64, "--rate"),
            ([self.log, "-o", "-", "--place", "3"], 64, "allowed: X,Z"),
            ([self.log, "-o", "-", "--place", "3,nan"], 64, "allowed: X,Z"),
            ([self.log, "-o", "-", "--lead", "3"], 64, "--sensor-place"),
            ([self.log, "-o", "-", "--sensor-place", "0,0", "--also", self.log], 64, "allowed: FILE.windlog@X,Z"),
            ([self.log, "-o", "-", "--sensor-place", "0,0", "--also", "/no/such.windlog@1,2"], 66, "the recording does not exist"),
            ([self.log, "-o", "/no/such/folder/a.csv"], 73, "/no/such/folder"),
        ):
            run = yuragi("wind", *arguments)
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertIn(text, run.stderr)


if __name__ == "__main__":
    unittest.main()
