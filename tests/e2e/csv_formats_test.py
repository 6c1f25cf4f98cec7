#!/usr/bin/env python3
"""`yuragi import` of what loggers, stations and archives write (csv_formats.py), against a reader of each in plain Python:
times to the nanosecond, speeds, directions and gusts to 1e-9. Prints the table of formats. Then what is refused.

usage: csv_formats_test.py YURAGI
"""
import csv
import datetime
import io
import math
import os
import pathlib
import pty
import re
import subprocess
import sys
import tempfile
import unittest

import csv_formats

YURAGI = sys.argv.pop(1)
EPOCH = datetime.datetime(1970, 1, 1, tzinfo=datetime.timezone.utc)


def yuragi(*arguments, text=None):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, input=text, text=True, encoding="utf-8", check=False)


def ns_of(moment):
    """Since 1970; a number is one already."""
    if isinstance(moment, int):
        return moment
    return (moment - EPOCH) // datetime.timedelta(microseconds=1) * 1000


def ns_of_text(text):
    whole, fraction = text.rstrip("Z").split(".")
    return ns_of(datetime.datetime.fromisoformat(whole + "+00:00")) + int(fraction)


def number(text):
    return float(text) if text else None


class Formats(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.source = pathlib.Path(self.folder.name, "sample.csv")
        self.recording = pathlib.Path(self.folder.name, "sample.windlog")

    def imported(self, sample, from_pipe=False):
        """The import's output, and the readings and weather that were recorded."""
        self.source.write_bytes(sample.text.encode(sample.encoding))
        done = yuragi("import", "-" if from_pipe else self.source, "-o", self.recording, "--force", *sample.options,
                      text=sample.text if from_pipe else None)
        self.assertEqual(done.returncode, 0, f"{sample.name}: {done.stderr}{done.stdout}")
        rows = csv.DictReader(io.StringIO(yuragi("export", self.recording, "-o", "-").stdout))
        found = [(ns_of_text(r["utc"]), float(r["speed_m_s"]), number(r["direction_deg"]), number(r["gust_m_s"])) for r in rows]
        weather = list(csv.DictReader(io.StringIO(yuragi("export", self.recording, "--quantities", "-o", "-").stdout)))
        return done.stdout, found, weather

    def compare(self, sample, found):
        expected = [(ns_of(r[0]), *r[1:]) for r in sample.read(sample.text.lstrip("\ufeff"))]
        self.assertEqual([r[0] for r in found], [r[0] for r in expected], sample.name)
        for one, other in zip(found, expected):
            for mine, theirs in zip(one[1:], other[1:]):
                self.assertEqual(mine is None, theirs is None, f"{sample.name}: {one} {other}")
                if mine is not None:
                    self.assertTrue(math.isclose(mine, theirs % 360 if theirs == 360 else theirs, rel_tol=1e-9, abs_tol=1e-9),
                                    f"{sample.name}: {one} {other}")

    def test_each_format_is_read_as_by_an_independent_reader(self):
        print(f"{'format':30} {'rows':>5} {'taken':>6} {'refused':>8}  {'unit found':10} as the independent reader")
        self.assertGreaterEqual(len(csv_formats.SAMPLES), 25)
        for sample in csv_formats.SAMPLES:
            with self.subTest(sample.name):
                said, found, weather = self.imported(sample)
                taken, rows, refused = map(int, re.search(r"(\d+) readings of (\d+) rows, (\d+) left out", said).groups())
                self.compare(sample, found)
                self.assertEqual((taken, refused), (len(found), sample.refused), said)
                for text in sample.told:
                    self.assertIn(text, said)
                unit = re.search(r'^ *(?:speed|u) from ".*?" \((.*?),', said, re.M)
                if sample.units:
                    self.assertEqual(unit.group(1), sample.units, said)
                for quantity, value in sample.weather.items():
                    self.assertTrue(weather[0][quantity], f"{sample.name}: {quantity}")
                    if value is not None:
                        self.assertAlmostEqual(float(weather[0][quantity]), value, places=6)
                print(f"{sample.name:30} {rows:5} {taken:6} {refused:8}  {unit.group(1) if sample.units else 'packed':10} yes")

    def test_a_pipe_is_read_as_a_file_is(self):
        for sample in csv_formats.SAMPLES[:6]:
            with self.subTest(sample.name):
                self.compare(sample, self.imported(sample, from_pipe=True)[1])

    def test_logs_of_messages_are_read_with_their_times(self):
        def nmea(body):
            checksum = 0
            for letter in body.encode():
                checksum ^= letter
            return f"${body}*{checksum:02X}"

        def gill(body):
            checksum = 0
            for letter in body.encode():
                checksum ^= letter
            return f"\x02{body}\x03{checksum:02X}"

        begin = datetime.datetime(2023, 6, 25, 23, 59, 50, tzinfo=datetime.timezone.utc)
        moments = [begin + datetime.timedelta(seconds=i) for i in range(30)]
        winds = [(round(2.0 + i / 10, 1), (10 * i + 5) % 360) for i in range(30)]
        speeds = {"m/s": 1.0, "kn": csv_formats.KNOT}

        def log(lines, *options):
            self.source.write_text("\r\n".join(lines) + "\r\n", encoding="utf-8", newline="")
            return csv_formats.Sample("log", self.source.read_bytes().decode(), None, options)

        def expected(unit="m/s", times=moments):
            return [(ns_of(time), speed * speeds[unit], float(direction), None) for time, (speed, direction) in zip(times, winds)]

        own_clock, own_time_of_day = [], []
        for i, (time, (speed, direction)) in enumerate(zip(moments, winds)):
            clock = nmea(f"GPRMC,{time:%H%M%S}.00,A,5230.0,N,01325.0,E,0.0,0.0,{time:%d%m%y},,")
            time_of_day = nmea(f"GPGLL,5230.0,N,01325.0,E,{time:%H%M%S}.00,A")
            sentences = [nmea(f"WIMWV,{(direction + 90) % 360}.0,R,{speed},N,A"), nmea(f"WIMWD,{direction}.0,T,,M,{speed},N,,M")]
            own_clock += [clock, *sentences]
            own_time_of_day += [clock if i == 0 else time_of_day, *sentences]
        cases = {
            "RMC": (own_clock, (), "kn"),
            "GLL over midnight": (own_time_of_day, (), "kn"),
            "leading ISO": ([f"{t:%Y-%m-%d %H:%M:%S}, {nmea(f'WIMWV,{d}.0,R,{s},M,A')}" for t, (s, d) in zip(moments, winds)], (), "m/s"),
            "leading Unix ms": ([f"{int(t.timestamp() * 1000)};A;{nmea(f'WIMWV,{d}.0,R,{s},M,A')}" for t, (s, d) in zip(moments, winds)], (), "m/s"),
            "tag block": ([f"\\s:wind,c:{int(t.timestamp())}*00\\{nmea(f'WIMWV,{d}.0,R,{s},M,A')}" for t, (s, d) in zip(moments, winds)], (), "m/s"),
            "Gill": ([f"[{t:%d.%m.%Y %H:%M:%S}] {gill(f'Q,{d:03},{s:06.2f},M,00,')}" for t, (s, d) in zip(moments, winds)],
                     ("--time-format", "day-first"), "m/s"),
            "Gill without a time": ([gill(f"Q,{d:03},{s:06.2f},M,00,") for s, d in winds],
                                    ("--start", "2023-06-25T23:59:50Z", "--interval", "1"), "m/s"),
            "keys": ([f"{t:%Y-%m-%dT%H:%M:%SZ} speed={s} direction={d}" for t, (s, d) in zip(moments, winds)], (), "m/s"),
        }
        for name, (lines, options, unit) in cases.items():
            with self.subTest(name):
                sample = log(lines, *options)
                said, found, _ = self.imported(sample)
                self.assertEqual(len(found), 30, said)
                for one, other in zip(found, expected(unit)):
                    self.assertEqual((one[0], one[3]), (other[0], None), name)
                    self.assertTrue(math.isclose(one[1], other[1], rel_tol=1e-9) and one[2] == other[2], (name, one, other))
        self.assertIn("--start", self.refused("\n".join(nmea(f"WIMWV,{d}.0,R,{s},M,A") for s, d in winds)))

    def test_a_terminal_is_asked_before_anything_is_written(self):
        self.source.write_text("time,speed_ms\n2024-01-01 10:00,1\n2024-01-01 10:10,2\n", encoding="utf-8")
        for answer, options, is_written in (("n\n", (), False), ("\n", (), True), ("", ("--yes",), True)):
            with self.subTest(answer):
                self.recording.unlink(missing_ok=True)
                terminal, other = pty.openpty()
                program = subprocess.Popen([YURAGI, "import", self.source, "-o", self.recording, *options], stdin=other, stdout=other, stderr=other)
                os.close(other)
                shown = b""
                if answer:
                    while b"[Y/n]" not in shown:
                        shown += os.read(terminal, 1000)
                    self.assertFalse(self.recording.exists())
                    self.assertIn(b"mean 1.50 m/s", shown)
                    os.write(terminal, answer.encode())
                while program.poll() is None:
                    try:
                        shown += os.read(terminal, 1000)
                    except OSError:  # the program has ended
                        program.wait()
                os.close(terminal)
                self.assertEqual((program.returncode, self.recording.exists()), (0, is_written), shown)

    def refused(self, text, *options):
        self.recording.unlink(missing_ok=True)
        self.source.write_text(text, encoding="utf-8")
        done = yuragi("import", self.source, "-o", self.recording, *options)
        self.assertEqual(done.returncode, 65, done.stdout)
        self.assertFalse(self.recording.exists())
        return done.stderr

    def test_what_cannot_be_settled_is_asked_for(self):
        self.assertIn("--time-format day-first or month-first", self.refused("time,speed_ms\n3/4/2023 10:00,1\n3/4/2023 11:00,2\n"))
        self.assertIn("--unit", self.refused("time,speed\n" + "".join(f"{i},{20 + i % 7}\n" for i in range(50))))
        self.assertIn("--unit", self.refused("time,speed,temp (F)\n0,3,70\n1,4,71\n"))
        self.assertIn("--gust-unit", self.refused("time,speed (km/h),gust\n" + "".join(f"{i},{18 + i % 5},{7 + i % 3}\n" for i in range(20))))
        self.assertIn("--time COLUMN", self.refused("a,b\n1,2\n"))
        self.assertIn("--speed COLUMN", self.refused("time,b\n1,2\n"))
        self.assertIn("timedatectl", yuragi("import", self.source, "-o", self.recording, "--zone", "Mars/Olympus").stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
