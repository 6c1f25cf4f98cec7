#!/usr/bin/env python3
"""Files from other people's loggers, stations and programs (../shared/data/field, one folder a case), imported as their owner would:
how many readings, the first one, how many rows are left out, the exit code. Prints the table.

usage: field_files_test.py YURAGI [FOLDER]
"""
import csv
import io
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

YURAGI = sys.argv[1]
FOLDER = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else pathlib.Path(__file__).resolve().parents[2] / "../shared/data/field")
MPH = 0.44704

# case, file, options, readings, rows left out, first: UTC, m/s, degrees
CASES = [
    ("canboat-plain-lines", "ws320.raw", (), 23, 0, ("2018-02-14T15:55:07.944", 0.68, 235.0)),
    # Of 33 winds, a third each from the bow, over ground and through the water: one frame is taken, the others named.
    ("canboat-plain-lines", "bandg_tritonedge.raw", (), 11, 0, None),
    ("ecowitt-german-csv", "upload-data-04-03-21-14-03-21-145-records.CSV", (), 145, 0, ("2021-03-04T19:57:00", 0.0, 302.0)),
    ("mwd-without-knots", "mwd_noknots.nmea", ("--start", "2026-01-01T00:00:00Z", "--interval", "1"), 7, 0,
     ("2026-01-01T00:00:00", 4.5, 322.8)),
    ("n2k-bytes-imported-as-wind", "dirona_head.raw", (), None, 0, (None, 4.79, 0.59)),
    ("n2k-log-import", "merrimac-ydwg-2020.raw", ("--start", "2020-06-01"), 38, 0, ("2020-06-01T00:29:58.659", 4.09, 343.4)),  # of 56 in two frames
    ("nrel-midc-raw-hhmm", "midc_raw_head.txt", (), 200, 0, ("2018-10-18T07:00:00", 2.947, 328.6)),
    ("nrg-logger-preamble", "20240111_1339_000304_002995_onesecond.dat", (), 115, 0, ("2024-01-11T13:39:30", 1.822, 336.6391)),
    ("nrg-logger-preamble", "meas.txt", (), 20, 0, ("2022-03-17T11:10:00", 0.139, 345.0)),
    ("ok-jena-kaggle", "jena.csv", (), 12, 0, None),
    ("ok-jena-kaggle", "jena_9999.csv", (), 11, 1, None),
    ("ok-jena-kaggle", "t1.csv", (), 3, 0, None),
    ("ok-ndbc-realtime", "44013_head.txt", (), None, None, None),
    ("ok-nke-opencpn-vdr", "nke_opencpn.nmea", (), None, None, (None, 5.21, 156.88)),
    ("ok-push-9999-and-firmwares", "push.txt", (), None, None, None),
    ("ok-rtl433-acurite-ws80-bresser", "acurite5n1.jsonl", (), None, None, (None, 2.656 / 3.6, None)),
    ("ok-rtl433-acurite-ws80-bresser", "ws80_rtl433.jsonl", (), None, None, ("2022-07-06T21:00:31", 2.0, 313.0)),
    ("ok-rtl433-acurite-ws80-bresser", "bresser_rtl433.jsonl", (), None, None, ("2020-02-11T01:15:41", 2.9, 180.0)),
    ("ok-tempest-nulls", "tempest.jsonl", (), None, None, None),
    ("ok-wll-two-transmitters", "wll.jsonl", (), None, None, ("2021-05-22T12:24:04", 9.0 * MPH, 231.0)),
    ("sparkfun-shield-log", "sparkfun_shield.txt", ("--start", "2026-01-01T00:00:00Z", "--interval", "1"), 3, 1, (None, 0.0, 45.0)),
    ("tmy3-header", "723170TYA_head.csv", (), None, 0, ("1988-01-01T06:00:00", 6.2, 200.0)),
    ("tmy3-header", "703165TY_head.csv", (), None, 0, ("1997-01-01T10:00:00", 2.1, 320.0)),
    ("toa5-resaved-by-excel", "campbell_scientific_demo_data1.csv",
     ("--speed", "Spd80mN", "--direction", "Dir78mS", "--time-format", "day-first"), 188, 0, ("2016-01-09T15:30:00", 8.37, 114.2)),
    ("unit-row-unknown-word", "toa5_light.dat", (), None, 0, ("2020-01-01T00:00:00", 10.5 / 3.6, 200.0)),
    ("ws85-serial-key-value", "ws85_serial.txt", ("--start", "2026-01-01T00:00:00Z", "--interval", "2"), None, 0, (None, 0.5, 79.0)),
    ("wslink-push", "wslink.txt", ("--start", "2026-01-01T00:00:00Z", "--interval", "1"), 1, 0, (None, 3.4, 315.0)),
    ("wxt-log-import", "wxt_epoch.log", (), 4, 0, ("2014-12-24T08:00:15", 9.5, 66.0)),
]


def yuragi(*arguments):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)


@unittest.skipUnless(FOLDER.is_dir(), f"{FOLDER} is not there")
class FieldFiles(unittest.TestCase):
    def test_each_file_is_read_as_its_owner_expects(self):
        print(f"\n{'case':32} {'file':28} {'taken':>6} {'left out':>8}  code  first")
        with tempfile.TemporaryDirectory() as folder:
            recording = pathlib.Path(folder, "a.windlog")
            for case, name, options, taken, left_out, first in CASES:
                with self.subTest(f"{case} {name}"):
                    recording.unlink(missing_ok=True)
                    done = yuragi("import", FOLDER / case / name, "-o", recording, *options)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    rows = list(csv.DictReader(io.StringIO(yuragi("export", recording, "-o", "-").stdout)))
                    lost = int(re.search(r" rows?, (\d+) left out", done.stdout).group(1))
                    row = rows[0]
                    print(f"{case:32} {name[:28]:28} {len(rows):6} {lost:8}  {done.returncode:4}  "
                          f"{row['utc'][:23]} {float(row['speed_m_s']):.3f} {row['direction_deg']}")
                    if taken is not None:
                        self.assertEqual(len(rows), taken)
                    if left_out is not None:
                        self.assertEqual(lost, left_out)
                    if first is not None:
                        utc, speed, direction = first
                        if utc is not None:
                            self.assertTrue(row["utc"].startswith(utc), row)
                        if speed is not None:
                            self.assertAlmostEqual(float(row["speed_m_s"]), speed, places=2)
                        if direction is not None:
                            self.assertAlmostEqual(float(row["direction_deg"]), direction, places=1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
