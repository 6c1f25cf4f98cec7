#!/usr/bin/env python3
"""Texts and files that are no wind: `yuragi import` refuses each with a reason and writes nothing. Prints the table.

usage: no_wind_test.py YURAGI
"""
import datetime
import gzip
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

YURAGI = sys.argv.pop(1)
BEGIN = datetime.datetime(2024, 5, 1, tzinfo=datetime.timezone.utc)
DRAW = random.Random(1)


def rows(header, row, count=300):
    lines = [header] if header else []
    lines += [row(i, BEGIN + datetime.timedelta(seconds=i)) for i in range(count)]
    return ("\n".join(lines) + "\n").encode()


def can_bytes(i, time):
    data = ",".join(f"{DRAW.randrange(256):02x}" for _ in range(8))
    return f"{time:%Y-%m-%dT%H:%M:%S}.{i % 1000:03}Z,{DRAW.randrange(8)},127488,{DRAW.randrange(256)},255,8,{data}"


def stock(i, time):
    price = 30 + DRAW.random() * 5
    return f"{time:%Y-%m-%d},{price:.2f},{price + 1:.2f},{price - 1:.2f},{price + .3:.2f},{DRAW.randrange(10**6)}"


TEXTS = {
    "source code": pathlib.Path(__file__).read_bytes(),
    "C++": b'#include <cstdio>\nint main() {\n  double speed = 4.2;  // m/s\n  std::printf("direction: %f", speed);\n}\n',
    "bytes of a CAN bus": rows("", can_bytes),
    "stock prices": rows("Date,Open,High,Low,Close,Volume", stock),
    "a photo": b"\xff\xd8\xff\xe0\x00\x10JFIF" + DRAW.randbytes(20000),
    "a web page": b"<!DOCTYPE html>\n<html><head><title>Wind speed, direction, time</title></head><body>4.2 m/s</body></html>\n",
    "a track (CSV)": rows("time,lat,lon,ele,speed,course", lambda i, t: f"{t:%Y-%m-%dT%H:%M:%SZ},52.{i:05},13.{i:05},40.1,{i % 7}.2,{i % 360}"),
    "a track (NMEA)": rows("", lambda i, t: f"$GPRMC,{t:%H%M%S},A,5230.0,N,01325.0,E,{i % 9}.0,{i % 360}.0,{t:%d%m%y},,"),
    "a track (GPX)": b'<?xml version="1.0"?>\n<gpx><trk><trkpt lat="52" lon="13"><time>2024-05-01T00:00:00Z</time></trkpt></trk></gpx>\n',
    "a log of a web server": rows("", lambda i, t: f'10.0.0.{i % 255} - - [{t:%d/%b/%Y:%H:%M:%S} +0000] "GET /wind?speed=high HTTP/1.1" 200 {i}'),
    "a system's log": rows("", lambda i, t: f"{t:%b %d %H:%M:%S} roof kernel: fan1: speed={i * 13 % 5000} rpm, temp: 41 C"),
    "temperatures": rows("time,temperature (C),humidity (%)", lambda i, t: f"{t:%Y-%m-%dT%H:%M:%SZ},{15 + i % 7},{60 + i % 20}"),
    "prose": b"The wind was strong. At noon its speed: about ten; direction: west.\nLater it was calm.\n" * 50,
    "gzip": gzip.compress(rows("time,speed", lambda i, t: f"{i},{i % 7}")),
    "random bytes": DRAW.randbytes(50000),
    "nothing": b"",
}


class NoWind(unittest.TestCase):
    def test_what_is_no_wind_is_refused(self):
        print(f"\n{'text':24} code  reason")
        with tempfile.TemporaryDirectory() as folder:
            source, recording = pathlib.Path(folder, "source"), pathlib.Path(folder, "a.windlog")
            for name, content in TEXTS.items():
                with self.subTest(name):
                    source.write_bytes(content)
                    done = subprocess.run([YURAGI, "import", source, "-o", recording], capture_output=True, check=False, stdin=subprocess.DEVNULL)
                    reason = done.stderr.decode(errors="replace").strip().splitlines()
                    print(f"{name:24} {done.returncode:4}  {reason[-1].replace(str(source), 'FILE')[:150] if reason else ''}")
                    self.assertEqual(done.returncode, 65, done.stdout)
                    self.assertFalse(recording.exists())


if __name__ == "__main__":
    unittest.main(verbosity=2)
