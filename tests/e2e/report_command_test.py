#!/usr/bin/env python3
"""`yuragi report`: the page and its numbers, checked from outside: the numbers against numpy's of the same readings.

usage: report_command_test.py YURAGI
"""
import base64
import csv
import datetime
import hashlib
import html.parser
import json
import math
import os
import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import numpy as np

from programs import shared_data

YURAGI = os.path.abspath(sys.argv.pop(1))
EVIL = "<script>alert('x')</script>&\""
FAR = 2**63 // 2 - 1  # the largest time that a recording can hold, ns
START_S = 1532095200  # 2018-07-20T14:00:00Z
SVG_DATA = "data:image/svg+xml;base64,"
VOID = set("meta br link img hr input".split())


def yuragi(*arguments, zone="UTC"):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, env=dict(os.environ, TZ=zone))


def utc(time_s):
    return datetime.datetime.fromtimestamp(START_S + time_s, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")


class Page(html.parser.HTMLParser):
    """Reads a page strictly: every element ends where it must, and nothing refers to the outside."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.faults, self.words, self.styles, self.pictures = [], [], [], [], [], []
        self.feed(text)
        self.close()
        if self.open:
            self.faults.append(f"never ended: {self.open}")

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        for name, value in attributes:
            if name in ("href", "src", "xlink:href", "srcset", "data", "action") and not (value or "").startswith("#"):
                if tag == "image" and value.startswith(SVG_DATA):
                    self.pictures.append(base64.b64decode(value[len(SVG_DATA) :], validate=True).decode())
                else:
                    self.faults.append(f"{tag} {name}={value}")
            if name.startswith("on"):
                self.faults.append(f"{tag} {name}")
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> at {self.getpos()}")

    def handle_data(self, data):
        (self.styles if self.open and self.open[-1] == "style" else self.words).append(data)

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())


class ReportCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.shared = pathlib.Path(folder.name)
        cls.reports = {}

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def record(self, rows, name="wind"):
        """A recording of (time_s, sensor, speed, direction or None, gust or None, quality)."""
        table = self.folder / f"{name}.csv"
        with table.open("w", encoding="utf-8", newline="") as file:
            out = csv.writer(file)
            out.writerow("utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,quality".split(","))
            for time_s, sensor, speed, direction, gust, quality in sorted(rows, key=lambda row: row[0]):
                out.writerow([utc(time_s), f"{time_s:.9f}", sensor, repr(float(speed)),
                              "" if direction is None else repr(float(direction)),
                              "" if gust is None else repr(float(gust)), quality])
        return self.imported(table)

    def shared_recording(self, name, make):
        """A copy of the recording that `make` returns, which is imported once for all tests."""
        kept = self.shared / f"{name}.windlog"
        if not kept.exists():
            make().replace(kept)
        return pathlib.Path(shutil.copy(kept, self.folder))

    def faulty_recording(self):
        return self.shared_recording("wind", lambda: self.record(self.faulty()))

    def real_recording(self, table):
        return self.shared_recording(pathlib.Path(table).stem, lambda: self.imported(table))

    def imported(self, table):
        log = self.folder / (pathlib.Path(table).stem + ".windlog")
        run = yuragi("import", table, "-o", log, "--force")
        self.assertEqual(run.returncode, 0, run.stderr)
        return log

    def report(self, log, *arguments, zone="UTC"):
        page, numbers = self.folder / "report.html", self.folder / "report.json"
        run = yuragi("report", log, "-o", page, "--json", numbers, "--force", *arguments, zone=zone)
        self.assertEqual(run.returncode, 0, run.stderr)
        text = page.read_text(encoding="utf-8")
        left = sorted(file.name for file in self.folder.iterdir() if "part" in file.name or "gnuplot" in file.name)
        self.assertEqual(left, [], "scratch files were left")
        return text, json.loads(numbers.read_text(encoding="utf-8"))

    def report_once(self, log):
        """The report of a recording, made once for all tests of the same bytes."""
        name = hashlib.sha256(log.read_bytes()).digest()
        if name not in self.reports:
            self.reports[name] = self.report(log)
        return self.reports[name]

    def check_page(self, text):
        page = Page(text)
        self.assertEqual(page.faults, [])
        self.assertNotIn("script", page.tags)
        for style in page.styles:
            self.assertIsNone(re.search(r"url\(|@import|http", style))
        self.assertNotIn("http", text)
        figures = re.findall(r"<svg .*?</svg>", text, re.S)
        for figure in figures:
            xml.etree.ElementTree.fromstring(figure)
        for picture in page.pictures:
            for element in xml.etree.ElementTree.fromstring(picture).iter():
                self.assertNotIn("script", element.tag)
                for name, value in element.attrib.items():
                    self.assertFalse(name.endswith("href") and not value.startswith("#"), value)
        ids = re.findall(r"\bid=['\"]([^'\"]+)", text)
        self.assertEqual(len(ids), len(set(ids)), "ids are not unique")
        return page, figures

    # A gap, a frozen value, spikes, a direction that crosses north; a second sensor of an evil name, simulated.
    def faulty(self):
        random = np.random.default_rng(3)
        speed = 6 + np.convolve(random.standard_normal(3700), np.ones(10) / 10, "valid")[:3600]
        rows = []
        for i in range(3600):
            if 600 <= i < 900:
                continue
            value = speed[1800] if 1800 <= i < 2100 else 55.0 if i in (1200, 3000) else speed[i]
            direction = 10.0 if 1800 <= i < 2100 else (20 * math.sin(i / 50)) % 360
            rows.append((i, "mast", value, direction, None, "good"))
        rows += [(i + 0.5, EVIL, 3 + math.sin(i), None, 5.0, "simulated") for i in range(0, 1800, 14)]
        return rows

    def test_the_page_is_whole_and_names_nothing_outside(self):
        text, _ = self.report(self.faulty_recording())
        page, figures = self.check_page(text)
        self.assertEqual(len(figures), 6, "all four of one; of the other, slow and without direction, two")
        for words in ("How strong it was", "Where the wind came from", "Octave by octave", "Gaps", "frozen", "Simulated."):
            self.assertIn(words, page.text)
        self.assertIn("stale for 5 min 1 s, from 2018-07-20 14:09:59 UTC", page.text, "what the mouse is told")
        self.assertLess(len(text), 1_500_000)

    def test_a_hostile_name_is_only_a_name(self):
        log = self.faulty_recording()
        text, numbers = self.report(log)
        page, _ = self.check_page(text)
        self.assertNotIn("<script", text)
        self.assertIn("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&amp;&quot;", text)
        self.assertIn(EVIL, page.text)
        self.assertEqual([sensor["name"] for sensor in numbers["sensors"]], ["mast", EVIL])

        # No UTF-8, line ends, very long: as a file from outside can have it.
        with sqlite3.connect(log) as file:
            file.execute("UPDATE series SET name = CAST(X'61FF0A3C623E' AS TEXT) || ? WHERE name = 'mast'", ("y" * 5000,))
            file.execute("UPDATE sensor SET driver = '</style><b onclick=x>' WHERE series = 1")
        text, numbers = self.report(log)
        self.check_page(text)
        self.assertNotIn("y" * 300, text)
        self.assertIn("a\ufffd", numbers["sensors"][0]["name"])

    def test_gaps_and_states_are_found(self):
        _, numbers = self.report(self.faulty_recording())
        mast, other = numbers["sensors"]
        gaps = [event for event in mast["events"] if event["state"] == "stale"]
        self.assertEqual([(gap["from_s"], gap["to_s"]) for gap in gaps], [(599.0, 900.0)])
        self.assertEqual(gaps[0]["from_utc"], "2018-07-20T14:09:59.000Z")
        self.assertEqual(mast["spikes"], 2)
        self.assertEqual(mast["states"]["spike"]["count"], 2)
        frozen = [event for event in mast["events"] if event["state"] == "frozen"]
        self.assertEqual(len(frozen), 1)
        self.assertEqual(frozen[0]["to_s"], 2100.0)
        self.assertAlmostEqual(frozen[0]["from_s"], 1830.0, delta=2.0)
        self.assertLess(mast["max_m_s"], 12.0, "spikes are not believed")
        self.assertLess(min(mast["direction_deg"], 360 - mast["direction_deg"]), 3.0, "the mean is north, not south")
        # The second one ends half way.
        self.assertEqual([event["state"] for event in other["events"]], ["stale"])
        self.assertEqual(other["events"][0]["to_s"], numbers["end_s"])
        self.assertEqual(other["simulated"], other["readings"])
        self.assertEqual(other["told_gust_m_s"], 5.0)
        self.assertIsNone(other["direction_deg"])

    def check_against_numpy(self, log, rows):
        """What numpy makes of the same readings, 10 a second."""
        text, numbers = self.report_once(log)
        self.check_page(text)
        wind = numbers["sensors"][0]
        speed, u, v = rows
        rate = 10.0
        for key, value in (("mean_m_s", speed.mean()), ("deviation_m_s", speed.std()), ("min_m_s", speed.min()),
                           ("max_m_s", speed.max()),
                           ("gust_3s_m_s", np.convolve(speed, np.ones(30) / 30, "valid").max()),
                           ("steadiness", math.hypot(u.mean(), v.mean()) / speed.mean()),
                           ("direction_deg", math.degrees(math.atan2(-u.mean(), -v.mean())) % 360)):
            self.assertAlmostEqual(wind[key], value, delta=1e-6 * abs(value), msg=key)
        for percent in (10, 50, 90, 99):
            self.assertAlmostEqual(wind["distribution"][f"p{percent}_m_s"], np.percentile(speed, percent), delta=0.06)
        share = np.histogram(speed, np.arange(0, 0.5 * len(wind["distribution"]["share"]) + 0.6, 0.5))[0] / len(speed)
        np.testing.assert_allclose(wind["distribution"]["share"], share[: len(wind["distribution"]["share"])], atol=5e-4)

        blocks = speed[: len(speed) // 6000 * 6000].reshape(-1, 6000)
        self.assertEqual(wind["ten_minutes"]["blocks"], len(blocks))
        self.assertAlmostEqual(wind["ten_minutes"]["turbulence_intensity"], (blocks.std(1) / blocks.mean(1)).mean(), places=6)

        # Welch's spectrum, written anew.
        spectrum = wind["spectrum"]
        size = spectrum["segment_readings"]
        window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(size) / size)
        steps = np.arange(size)
        powers = []
        for begin in range(0, len(speed) - size + 1, size // 2):
            a, b = u[begin:begin + size], v[begin:begin + size]
            along = (a * a.mean() + b * b.mean()) / math.hypot(a.mean(), b.mean())
            along = along - np.polyval(np.polyfit(steps, along, 1), steps)
            powers.append(abs(np.fft.rfft(along * window)) ** 2 / (rate * (window**2).sum()))
        density = np.mean(powers, axis=0)
        density[1:-1] *= 2
        frequency = np.fft.rfftfreq(size, 1 / rate)
        self.assertEqual(spectrum["segments"], len(powers))
        np.testing.assert_allclose(spectrum["frequency_hz"], frequency, rtol=1e-9)
        np.testing.assert_allclose(spectrum["density_m2_s2_hz"], density, rtol=1e-5, atol=1e-12)
        law = spectrum["power_law"]
        lines = (frequency >= law["from_hz"] - 1e-9) & (frequency <= law["to_hz"] + 1e-9)
        slope = np.polyfit(np.log(frequency[lines]), np.log(density[lines]), 1)[0]
        self.assertAlmostEqual(law["beta"], -slope, delta=0.002)
        for octave in spectrum["octaves"]:
            inside = (frequency >= octave["from_hz"]) & (frequency < octave["to_hz"])
            self.assertAlmostEqual(octave["variance_m2_s2"], density[inside].sum() * frequency[1], places=6)

        # The autocorrelation of half an hour.
        part = speed[: min(len(speed), 18000)]
        modes = np.fft.rfft(part - part.mean(), 1 << 16)
        correlation = np.fft.irfft(abs(modes) ** 2)[: len(part)]
        end = np.argmax(correlation <= 0)
        self.assertAlmostEqual(wind["integral_time_s"], (correlation[:end].sum() / correlation[0] - 0.5) / rate, places=6)
        return wind

    def gusty_recording(self, count):
        """A made-up recording of 10 Hz, and its speed, u and v."""
        random = np.random.default_rng(11)
        steps = random.standard_normal((2, count + 200))
        kernel = np.exp(-np.arange(200) / 40)
        u, v = (np.convolve(row, kernel, "valid")[:count] * 0.2 for row in steps)
        u, v = u - 4.0, v + 5.0
        speed, direction = np.hypot(u, v), np.degrees(np.arctan2(-u, -v)) % 360
        return self.record([(0.1 * i, "mast", speed[i], direction[i], None, "good") for i in range(count)]), (speed, u, v)

    def test_numbers_are_numpys(self):
        self.check_against_numpy(*self.gusty_recording(9000))

    def test_known_figures_of_a_real_recording(self):
        table = shared_data("sonic", "finse_csat3_10hz_20180720T140000.csv")
        if table is None:
            self.skipTest("../shared/data is not there")
        lines = [line.split(",") for line in pathlib.Path(table).read_text(encoding="ascii").splitlines() if line[0] == "2"]
        u, v = (np.array([float(line[column]) for line in lines]) for column in (1, 2))
        wind = self.check_against_numpy(self.real_recording(table), (np.hypot(u, v), u, v))
        self.assertAlmostEqual(wind["mean_m_s"], 7.02, delta=0.005)
        self.assertAlmostEqual(wind["max_m_s"], 11.27, delta=0.005)
        self.assertAlmostEqual(wind["ten_minutes"]["turbulence_intensity"], 0.20, delta=0.005)
        self.assertAlmostEqual(wind["deviation_m_s"] / wind["mean_m_s"], 0.20, delta=0.005)
        self.assertAlmostEqual(wind["spectrum"]["power_law"]["beta"], 1.5, delta=0.05)
        self.assertAlmostEqual(wind["integral_time_s"], 10.0, delta=0.5)
        self.assertAlmostEqual(wind["gust_3s_m_s"] / wind["mean_m_s"], 1.44, delta=0.005)
        fit = wind["spectrum"]["von_karman"]
        self.assertAlmostEqual(fit["speed_m_s"], 6.95, delta=0.05)
        self.assertAlmostEqual(fit["turbulence_intensity"], 0.19, delta=0.02)
        self.assertTrue(15.0 < fit["length_m"] < 60.0, fit)

    def test_recordings_of_half_an_hour_make_a_page(self):
        """Two real ones where they are there, else one that is made up."""
        tables = [shared_data("sonic", f"finse_csat3_10hz_20180720T{name}.csv") for name in ("133000", "140000")]
        for log in [self.real_recording(table) for table in tables if table] or [self.gusty_recording(18000)[0]]:
            text, numbers = self.report_once(log)
            page, _ = self.check_page(text)
            self.assertEqual(numbers["readings"], 18000)
            self.assertIn("18000 in 1 session", page.text)
            # What it offers for a configuration is one.
            offered = re.search(r"<pre>(\[wind\].*?)</pre>", text, re.S)
            wall = self.folder / "wall.toml"
            wall.write_text(offered.group(1), encoding="ascii")
            self.assertEqual(yuragi("check-config", wall).returncode, 0)

    def test_a_month_is_a_small_page_with_hours_in_local_time(self):
        # A wind that blows from noon to six, UTC, once in ten minutes; one gust that a mean would lose.
        rows = [(600.0 * i, "roof", (7.0 if 12 <= (START_S / 3600 + i / 6) % 24 < 18 else 2.0) + 0.01 * (i % 9), 90, None, "good")
                for i in range(30 * 144)]
        rows[1443] = (*rows[1443][:2], 9.5, *rows[1443][3:])
        text, numbers = self.report(self.record(rows), zone="XYZ-3")  # three hours ahead of UTC
        page, figures = self.check_page(text)
        self.assertLess(len(text), 1_000_000)
        self.assertEqual(len(figures), 4, "no spectrum of so slow a sensor")
        self.assertIn("The day", page.text)
        self.assertIn("2018-07-20 17:00:00 XYZ", page.text)
        roof = numbers["sensors"][0]
        self.assertEqual(max(row["max_m_s"] for row in roof["series"]), 9.5)
        windy = [hour for hour in range(24) if roof["hours"][hour]["mean_m_s"] > 5]
        self.assertEqual(windy, [15, 16, 17, 18, 19, 20])
        self.assertEqual(roof["rose"]["calm_share"], 0.0)
        self.assertAlmostEqual(sum(roof["rose"]["share"]["E"]), 1.0)

    def test_one_reading_and_none(self):
        log = self.record([(0, "mast", 3.25, 350, None, "good")])
        text, numbers = self.report(log)
        page, _ = self.check_page(text)
        self.assertIn("sent one reading: 3.2 m/s", page.text)
        self.assertEqual(numbers["sensors"][0]["mean_m_s"], 3.25)
        self.assertIsNone(numbers["sensors"][0]["spectrum"])
        with sqlite3.connect(log) as file:
            file.execute("DELETE FROM reading_1")
        text, numbers = self.report(log)
        page, figures = self.check_page(text)
        self.assertIn("has no readings", page.text)
        self.assertEqual((figures, numbers["readings"], numbers["sensors"]), ([], 0, []))

    def test_a_calm_and_a_steady_wind_have_numbers(self):
        for speed, share in ((0.0, 1.0), (5.0, 0.0)):
            text, numbers = self.report(self.record([(i, "mast", speed, 0, None, "good") for i in range(20)]))
            self.check_page(text)
            self.assertNotRegex(text, r"\b(nan|inf)\b")
            self.assertEqual(numbers["sensors"][0]["rose"]["calm_share"], share)

    def test_a_part_and_a_sensor_are_chosen(self):
        log = self.faulty_recording()
        _, numbers = self.report(log, "--sensor", EVIL, "--from", "100", "--to", "2018-07-20T14:03:20Z")
        self.assertEqual([sensor["name"] for sensor in numbers["sensors"]], [EVIL])
        self.assertGreaterEqual(numbers["begin_s"], 100.0)
        self.assertLess(numbers["end_s"], 200.0)
        self.assertEqual(numbers["sensors"][0]["readings"], 7)
        # An option takes one name, not the file that follows.
        run = yuragi("report", "--sensor", "mast", log, "-o", self.folder / "mast.html")
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_says_what_is_wrong(self):
        log = self.faulty_recording()
        out = self.folder / "a.html"
        damaged = self.folder / "damaged.windlog"
        damaged.write_bytes(log.read_bytes()[:5000] + b"\0" * 4000)
        text = self.folder / "text.windlog"
        text.write_text("no recording", encoding="ascii")
        (self.folder / "there.html").write_text("precious", encoding="ascii")
        for arguments, code, words in (
            (["/no/such.windlog", "-o", out], 66, "/no/such.windlog"),
            ([damaged, "-o", out], 65, "damaged.windlog"),
            ([text, "-o", out], 65, "text.windlog"),
            ([log, "-o", out, "--sensor", "mats"], 65, '"mast"'),
            ([log, "-o", out, "--from", "soon"], 64, "--from"),
            ([log, "-o", "/no/such/folder/a.html"], 73, "/no/such/folder"),
            ([log, "-o", self.folder / "there.html"], 73, "--force"),
            ([log, "-o", out, "--json", out], 64, "--json"),
            ([log], 64, "--output"),
        ):
            run = yuragi("report", *arguments)
            self.assertEqual(run.returncode, code, (arguments, run.stderr))
            self.assertIn(words, run.stderr)
            self.assertFalse(out.exists())
        self.assertEqual((self.folder / "there.html").read_text(encoding="ascii"), "precious")

    def check_changed(self, log, changes):
        whole = log.read_bytes()
        for table, change in changes:
            log.write_bytes(whole)
            with sqlite3.connect(log) as file:
                file.execute(f"UPDATE {table} SET {change}")
            text, _ = self.report(log)
            self.check_page(text)
            self.assertNotRegex(text.split("<body>")[1], r"\b(nan|inf)\b", change)

    def test_any_times_and_numbers_make_a_page(self):
        numbers = ("speed_m_s = 1e-300", "speed_m_s = -1", "direction_deg = 359.9999999")
        changes = ("clock_ns = random() / 2", f"clock_ns = {FAR}", f"clock_ns = -{FAR}", "time_ns = -time_ns",
                   "time_ns = abs(random()) / 4", *numbers)
        # Every ninth reading: the gap, the frozen value and a page with all its figures remain.
        self.check_changed(self.record(self.faulty()[::9]), [("reading_1", change) for change in changes])

        older = self.folder / "format1.windlog"
        older.write_bytes((pathlib.Path(__file__).parents[1] / "drivers/windlog/format1.windlog").read_bytes())
        with sqlite3.connect(older) as file:  # of several sessions the times may add up to more than a recording can hold
            file.execute("DELETE FROM reading WHERE session = 2")
        changes = ("utc_ns = random() / 2", f"utc_ns = {FAR}", f"utc_ns = -{FAR}", "mono_ns = 5", "mono_ns = rowid",
                   "mono_ns = abs(random()) / 4", *numbers)
        self.check_changed(older, [("reading", change) for change in changes])

    def test_too_many_sensors_are_refused_with_advice(self):
        run = yuragi("report", self.record([(i, f"s{i}", 1, None, None, "good") for i in range(40)]), "-o", self.folder / "a.html")
        self.assertEqual(run.returncode, 65)
        self.assertIn("40 sensors are too many for one page", run.stderr)
        self.assertIn("--sensor", run.stderr)


if __name__ == "__main__":
    unittest.main()
