#!/usr/bin/env python3
"""`yuragi export`: --resample against the same means in plain Python; --quantities from a station's lines to the CSV; a take.

usage: export_command_test.py YURAGI
"""
import csv
import datetime
import io
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import unittest

from programs import Program

YURAGI = sys.argv.pop(1)
BEGIN = datetime.datetime(2026, 5, 1, 11, 58, 13, tzinfo=datetime.timezone.utc)
BLOCK_S = 30


def yuragi(*arguments):
    done = subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def utc_text(moment):
    return moment.strftime("%Y-%m-%dT%H:%M:%S.%f") + "000Z"


class Quantities(unittest.TestCase):
    def test_a_station_s_weather_goes_from_its_lines_into_the_csv(self):
        def line(body):
            checksum = 0
            for letter in body.encode():
                checksum ^= letter
            return f"${body}*{checksum:02X}\r\n"

        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder, "voyage.log")
            log.write_bytes("".join(
                line(f"WIMDA,,I,1.0132,B,{12 + i / 10:.1f},C,,,55.0,,3.7,C,230.6,T,,M,6.65,N,3.42,M")
                + line("WIXDR,V,1.5,M,0,R,0.3,M,0") for i in range(30)).encode())
            config = pathlib.Path(folder, "site.toml")
            config.write_text(f'[[sensor]]\nname = "mast"\ndriver = "nmea"\ntransport = "file"\nfile = "{log}"\nplay_rate = 20.0\n')
            wall, weather = pathlib.Path(folder, "wall.windlog"), pathlib.Path(folder, "weather.csv")
            with Program(YURAGI, "run", "-c", config, "--record", wall, "--listen", "127.0.0.1:0") as daemon:
                daemon.wait_for("sensor mast: finished")
                self.assertEqual(daemon.end(), 0)
            yuragi("export", wall, "--quantities", "-o", weather)
            table = list(csv.DictReader(io.StringIO(weather.read_text(encoding="utf-8"))))
            none = list(csv.DictReader(io.StringIO(yuragi("export", wall, "--quantities", "-o", "-", "--from", "3600"))))
            readings = list(csv.DictReader(io.StringIO(yuragi("export", wall, "-o", "-"))))

        self.assertEqual(list(table[0]), ["time_utc", "sensor", "vertical_speed_m_s", "air_temperature_c", "pressure_hpa",
                                          "relative_humidity_percent", "rain_total_mm", "rain_rate_mm_h"])
        self.assertEqual(len({row["time_utc"] for row in table}), len(table))
        self.assertLessEqual(len(table), 6)  # one row a second
        self.assertEqual({row["sensor"] for row in table}, {"mast"})
        # A second may begin between two lines, so that its row has what the second of them says, and no more.
        last = {name: next((row[name] for row in reversed(table) if row[name]), "") for name in table[0]}
        self.assertEqual(float(last["air_temperature_c"]), 14.9)
        self.assertAlmostEqual(float(last["pressure_hpa"]), 1013.2)
        self.assertEqual((last["relative_humidity_percent"], last["rain_total_mm"], last["rain_rate_mm_h"],
                          last["vertical_speed_m_s"]), ("55", "1.5", "0.3", ""))
        self.assertEqual(none, [])
        self.assertGreater(len(readings), 20)


class Resample(unittest.TestCase):
    def test_means_over_a_series_of_files_are_those_of_plain_arithmetic(self):
        draw = random.Random(13)
        readings = []  # (milliseconds since BEGIN, sensor, speed, direction or None, gust or None)
        for part_begin_s in (0, 400, 3600):
            for ms in range(0, 300_000, 250):
                if 100_000 <= ms < 190_000:
                    continue  # both are silent for three blocks
                readings.append((1000 * part_begin_s + ms, "roof", draw.uniform(0, 12), draw.uniform(0, 360), None))
                if ms % 1000 == 0:
                    readings.append((1000 * part_begin_s + ms, "mast", draw.uniform(0, 9), None, draw.uniform(0, 15)))
        with tempfile.TemporaryDirectory() as folder:
            wall = pathlib.Path(folder, "wall.windlog")
            names = [pathlib.Path(folder, "wall-20260501T115813Z.windlog"), pathlib.Path(folder, "wall-20260501T120453Z.windlog"), wall]
            for begin_s, name in zip((0, 400, 3600), names):
                self.write_part(name, [row for row in readings if 0 <= row[0] - 1000 * begin_s < 300_000])
            table = list(csv.DictReader(io.StringIO(yuragi("export", wall, "-o", "-", "--resample", BLOCK_S))))

            copy = pathlib.Path(folder, "copy.windlog")
            of_series = subprocess.run([YURAGI, "export", wall, "-o", copy], capture_output=True, text=True)
            self.assertNotEqual(of_series.returncode, 0)
            yuragi("export", wall, "-o", copy, "--this-file")
            self.assertEqual(yuragi("export", copy, "-o", "-").count("\n"), yuragi("export", names[1], "-o", "-").count("\n"))
            as_table = subprocess.run([YURAGI, "export", wall, "-o", "-", "--this-file"], capture_output=True, text=True)
            self.assertEqual(as_table.returncode, 64, as_table.stderr)

        blocks = {}
        for ms, sensor, *values in readings:
            moment = BEGIN + datetime.timedelta(milliseconds=ms)
            blocks.setdefault((int(moment.timestamp()) // BLOCK_S * BLOCK_S, sensor), []).append(values)
        first, last = min(blocks)[0], max(blocks)[0]
        expected = [(begin, sensor) for begin in range(first, last + 1, BLOCK_S) for sensor in ("roof", "mast")]
        self.assertEqual(len(table), len(expected))
        for row, key in zip(table, expected):
            begin = datetime.datetime.fromtimestamp(key[0], datetime.timezone.utc)
            self.assertEqual((row["utc"], row["sensor"]), (utc_text(begin), key[1]))
            block = blocks.get(key, [])
            self.assertEqual(int(row["count"]), len(block))
            if not block:
                self.assertEqual((row["speed_m_s"], row["direction_deg"], row["gust_m_s"]), ("", "", ""))
                continue
            self.assertAlmostEqual(float(row["speed_m_s"]), sum(speed for speed, _, _ in block) / len(block), places=9)
            self.assertEqual(float(row["gust_m_s"]), max(max(speed, gust or 0) for speed, _, gust in block))
            if key[1] == "mast":
                self.assertEqual(row["direction_deg"], "")
                continue
            u = sum(speed * math.sin(math.radians(direction)) for speed, direction, _ in block)
            v = sum(speed * math.cos(math.radians(direction)) for speed, direction, _ in block)
            difference_deg = float(row["direction_deg"]) - math.degrees(math.atan2(u, v))
            self.assertAlmostEqual(math.remainder(difference_deg, 360), 0, places=6)

    def write_part(self, file, readings):
        lines = ["utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,quality"]
        for ms, sensor, speed, direction, gust in readings:
            moment = BEGIN + datetime.timedelta(milliseconds=ms)
            cells = [utc_text(moment), f"{(ms - readings[0][0]) / 1000:.9f}", sensor, repr(speed)]
            cells += ["" if value is None else repr(value) for value in (direction, gust)]
            lines.append(",".join([*cells, "good"]))
        table = file.with_suffix(".csv")
        table.write_text("\n".join(lines) + "\n", encoding="ascii")
        yuragi("import", table, "-o", file)
        table.unlink()


class Take(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "wall.toml").write_text('[[scene]]\nkind = "flag"\nrows = 20\ncolumns = 10\n[[scene]]\nkind = "fur"\n')
        rows = "".join(f"{second},roof,{4 + second % 3}\n" for second in range(5))
        (self.folder / "wind.csv").write_text("time_s,sensor,speed_m_s\n" + rows)
        yuragi("import", self.folder / "wind.csv", "-o", self.folder / "wind.windlog")

    def take(self, *options):
        return subprocess.run([YURAGI, "export", self.folder / "wind.windlog", "-o", self.folder / "take.glb", "--config",
                               self.folder / "wall.toml", *options], capture_output=True, text=True, check=False)

    def test_a_take_has_a_curve_for_each_joint_that_moves(self):
        done = self.take("--scene", "flag", "--fps", "10", "--duration", "2", "--every", "1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("20 pictures of flag, 2.0 s, 201 joints", done.stderr)
        file = (self.folder / "take.glb").read_bytes()
        magic, version, size, json_size, kind = struct.unpack_from("<4sIII4s", file)
        self.assertEqual((magic, version, size, kind), (b"glTF", 2, len(file), b"JSON"))
        model = json.loads(file[20:20 + json_size])
        self.assertEqual(len(model["skins"][0]["joints"]), 201)
        self.assertEqual(len(model["animations"][0]["channels"]), 200 - 10, "the hoist stays on its pole")
        self.assertEqual({accessor["count"] for accessor in (model["accessors"][sampler["output"]]
                                                             for sampler in model["animations"][0]["samplers"])}, {20})

    def test_what_is_wrong_is_said_and_leaves_no_file(self):
        for options, code, pattern in ((("--scene", "sea"), 64, "there is no 'sea'; there are: flag, fur"), ((), 64, "flag, fur"),
                                       (("--scene", "flag", "--to", "3"), 64, "--to"),
                                       (("--scene", "flag", "--duration", "5h", "--every", "1"), 64, "the take is too large"),
                                       (("--scene", "flag", "--from", "900"), 65, "")):
            done = self.take(*options)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(pattern, done.stderr)
            self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["wall.toml", "wind.csv", "wind.windlog"])


if __name__ == "__main__":
    unittest.main()
