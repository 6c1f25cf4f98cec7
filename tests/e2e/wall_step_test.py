#!/usr/bin/env python3
"""Two viewers of one wall behind networks that delay each stream in its own way: with [[output]] delay both show the same tick.

usage: wall_step_test.py DIRECTORY-OF-THE-PROGRAMS
"""
import bisect
import csv
import os
import pathlib
import random
import statistics
import sys
import tempfile
import threading
import unittest

from programs import HANG_S, Program
from slow_network import SlowNetwork

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "config" / "examples"))
from yuragi_client import Client  # noqa: E402

PROGRAMS = os.path.abspath(sys.argv.pop(1))
YURAGI, VIEWER = (os.path.join(PROGRAMS, name) for name in ("yuragi", "yuragi-viewer"))
DELAY_S = 0.3  # with room for a machine that is busy
SLOWEST_S = 0.08  # of the network
TICK_S = 1 / 60
CONFIG = f"""
[look]
quality = "low"
[[scene]]
name = "meadow"
kind = "grass"
blades_across = 10
blades_deep = 10
[[output]]
name = "left"
size = "128x36"
delay = {DELAY_S}
[[output.window]]
crop = "0 0 0.5 1"
[[output]]
name = "right"
size = "128x36"
delay = {DELAY_S}
[[output.window]]
crop = "0.5 0 0.5 1"
"""


class Screen(Program):
    """A display without a monitor's refresh."""

    def __init__(self):
        read, write = os.pipe()
        super().__init__("Xvfb", "-displayfd", write, "-screen", 0, "64x36x24", "-nolisten", "tcp", pass_fds=[write])
        os.close(write)
        with os.fdopen(read) as number:
            self.display = ":" + number.readline().strip()


class Ticks:
    """The UTC of each tick, s, as the daemon's frames have it."""

    def __init__(self, address):
        self.utc_s = {}
        threading.Thread(target=self.listen, args=(address,), daemon=True).start()

    def listen(self, address):
        for message in Client(address, wind=True):
            if message.table_name == "Frame":
                self.utc_s[message.tick] = 1e-9 * message.utc_ns

    def zero_s(self):
        """The UTC of tick 0. A late tick is stamped late; the earliest are right."""
        return min(utc_s - TICK_S * tick for tick, utc_s in self.utc_s.copy().items())


class WallStep(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())

    def view(self, name, address, seed):
        """A viewer of this output; answers its file of swaps."""
        chance = random.Random(seed)
        network = SlowNetwork(address, lambda: chance.uniform(0, SLOWEST_S))
        self.addCleanup(network.listener.close)
        swaps = os.path.join(self.folder, name + ".csv")
        viewer = self.enterContext(Program(VIEWER, "--config", self.config, "--output", name, "--connect", network.address, "--swaps", swaps,
                                           "--samples", 1, "--age", env={**os.environ, "DISPLAY": self.screen.display}))
        return viewer, swaps

    @staticmethod
    def rows(swaps):
        """The pictures that were chosen by the fixed delay, at least 2 s after a frame was late."""
        with open(swaps, encoding="ascii", newline="") as text:
            rows = [{key: int(value) for key, value in row.items()} for row in csv.DictReader(text.read().splitlines(True)[:-1])]
        kept, late, late_ns = [], 0, 0
        for row in rows:
            if row["late_frames"] != late or not row["in_step"]:
                late, late_ns = row["late_frames"], row["chosen_utc_ns"]
            if row["chosen_utc_ns"] - late_ns > 2e9:
                kept.append(row)
        return kept

    @staticmethod
    def pairs(left, right):
        """Each picture of the left with the last one of the right before it, and by how many ticks' time they are apart; without those
        beside a pause of the other."""
        pairs, at = [], 0
        for row in left:
            while at + 1 < len(right) and right[at + 1]["chosen_utc_ns"] <= row["chosen_utc_ns"]:
                at += 1
            if right and 0 <= (apart := (row["chosen_utc_ns"] - right[at]["chosen_utc_ns"]) * 1e-9 / TICK_S) < 1.5:
                pairs.append((row, right[at], apart))
        return pairs

    def wait_for_pairs(self, viewers, count):
        """Waits until the viewers have shown so many pictures in step at the same time."""
        enough = threading.Event()
        for _ in range(int(10 * HANG_S)):
            if all(os.path.exists(swaps) for _, swaps in viewers) and len(self.pairs(*(self.rows(swaps) for _, swaps in viewers))) >= count:
                return
            self.assertTrue(all(viewer.process.poll() is None for viewer, _ in viewers), [viewer.text() for viewer, _ in viewers])
            enough.wait(0.5)  # the files are read again
        self.fail([viewer.text() for viewer, _ in viewers])

    def compare(self, pictures):
        self.config = os.path.join(self.folder, "wall.toml")
        with open(self.config, "w", encoding="utf-8") as out:
            out.write(CONFIG)
        address = self.enterContext(Program(YURAGI, "run", "--config", self.config, "--listen", "127.0.0.1:0")).address()
        ticks = Ticks(address)
        self.screen = self.enterContext(Screen())
        viewers = [self.view("left", address, 1), self.view("right", address, 2)]
        self.wait_for_pairs(viewers, pictures)
        for viewer, _ in viewers:
            self.assertEqual(viewer.end(), 0, viewer.text())
            self.assertRegex(viewer.text(), r"delay 300 ms (not )?kept; \d+ of \d+ frames late; given up \d+ times; clock")
        left, right = (self.rows(swaps) for _, swaps in viewers)

        # The daemon may have skipped ticks: these are in no frame, and do not count.
        known = sorted({row["tick"] for row in left + right} | set(ticks.utc_s.copy()))
        place = {tick: i for i, tick in enumerate(known)}
        zero_s = ticks.zero_s()

        def place_of_due(utc_s):
            """Of the last tick whose UTC is at least the delay ago."""
            return bisect.bisect(known, (utc_s - DELAY_S - zero_s) / TICK_S) - 1

        # Each picture is of the tick that is due, and is handed over after it was chosen.
        for row in left + right:
            self.assertLessEqual(abs(place[row["tick"]] - place_of_due(1e-9 * row["chosen_utc_ns"])), 1, row)
            self.assertGreaterEqual(row["utc_ns"], row["chosen_utc_ns"])

        # At equal UTC the two differ by one tick at most.
        pairs = self.pairs(left, right)
        for one, other, apart in pairs:
            self.assertLessEqual(abs(place[one["tick"]] - place[other["tick"]] - round(apart)), 1, (one, other))
        to_swap_ms = statistics.median(1e-6 * (row["utc_ns"] - row["chosen_utc_ns"]) for row in left + right)
        late = [rows[-1]["late_frames"] for rows in (left, right)]
        print(f"{len(left)} and {len(right)} pictures, {len(pairs)} compared; late frames: {late}; {to_swap_ms:.1f} ms to the swap")

    def test_both_screens_show_the_same_tick_behind_uneven_networks(self):
        self.compare(150)

    def test_both_screens_show_the_same_tick_for_a_thousand_pictures(self):
        self.compare(1000)


if __name__ == "__main__":
    unittest.main()
