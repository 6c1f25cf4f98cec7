#!/usr/bin/env python3
"""One recording has one writer: two daemons on one series, and `yuragi verify` of what they leave.

usage: one_writer_test.py FOLDER_OF_PROGRAMS
"""
import csv
import io
import json
import os
import re
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

from programs import HANG_S, Program

PROGRAMS = os.path.abspath(sys.argv.pop(1))
YURAGI = os.path.join(PROGRAMS, "yuragi")
SIMULATOR = os.path.join(PROGRAMS, "yuragi-sim")
# A file is completed after each second: any is larger than this.
CONFIG = """\
[recording]
file = "{}/wall.windlog"
max_file_size = 0.001
min_free = 0

[[sensor]]
name = "roof"
driver = "synthetic"
rate = 50
"""


def run(*arguments):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, timeout=HANG_S, check=False)


class OneWriter(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-one-writer-")
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.wall = os.path.join(self.folder, "wall.windlog")
        self.config = os.path.join(self.folder, "site.toml")
        with open(self.config, "w", encoding="utf-8") as out:
            out.write(CONFIG.format(self.folder))

    def start(self):
        daemon = Program(YURAGI, "run", "--config", self.config, "--listen", "127.0.0.1:0")
        self.addCleanup(daemon.__exit__)
        daemon.address()
        return daemon

    def recorder(self, daemon):
        return json.loads(run("status", "--connect", daemon.address(), "--json").stdout)["recorder"]

    def wait_for_recorder(self, daemon, is_so):
        until = time.monotonic() + HANG_S
        while not is_so(recorder := self.recorder(daemon)):
            self.assertLess(time.monotonic(), until, f"{recorder}\n{daemon.text()}")
        return recorder

    def files(self):
        return sorted(name for name in os.listdir(self.folder) if name.endswith(".windlog"))

    def end(self, daemon):
        """Ends it and answers how many readings it recorded and lost."""
        self.assertEqual(daemon.end(), 0, daemon.text())
        return tuple(map(int, re.search(r"recorded (\d+) readings?, lost (\d+)", daemon.text()).groups()))

    def exported(self):
        done = run("export", self.wall, "-o", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("damaged"), 0, done.stderr)
        return len(list(csv.reader(io.StringIO(done.stdout)))) - 1

    def assert_each_moment_is_recorded_once(self):
        """The sensor makes 50 readings a second, of each daemon: no second has those of both."""
        lines = csv.DictReader(io.StringIO(run("export", self.wall, "-o", "-").stdout))
        seconds = [line["utc"][:19] for line in lines]
        self.assertLessEqual(max(map(seconds.count, set(seconds))), 75)

    def assert_sound(self):
        for name in self.files():
            with sqlite3.connect(os.path.join(self.folder, name)) as database:
                self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)], name)
        done = run("verify", self.wall)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_what_two_daemons_record_is_exported_completely_after_rotations(self):
        first = self.start()
        second = self.start()
        self.wait_for_recorder(first, lambda recorder: recorder["written"] > 200 and len(self.files()) > 4)
        counts = [self.end(second), self.end(first)]
        self.assertEqual(self.exported(), sum(recorded for recorded, _ in counts), (counts, self.files()))
        self.assertEqual([lost for _, lost in counts], [0, 0])
        self.assertEqual(counts[0][0], 0, "recorded by the second")
        self.assertRegex(second.text(), r"\d+ readings recorded by another process")
        self.assert_sound()
        self.assertIn(f"another program (process {first.process.pid}) records to {self.wall}", second.text())
        self.assertEqual(sorted(os.listdir(self.folder)), sorted([*self.files(), "site.toml"]), "no lock is left")

    def test_the_second_shows_why_it_does_not_record_and_takes_over_when_the_first_was_killed(self):
        first = self.start()
        self.wait_for_recorder(first, lambda recorder: recorder["written"] > 0)
        second = self.start()
        reason = f"another program (process {first.process.pid}) records to {self.wall}: end it, or choose another file"
        shown = self.wait_for_recorder(second, lambda recorder: recorder["waiting"] > 0)
        self.assertEqual((shown["state"], shown["written"]), ("retrying", 0))
        self.assertRegex(shown["error"], "^" + re.escape(reason) + r" \(since 2\S+Z\)$")
        status = run("status", "--connect", second.address())
        self.assertEqual(status.returncode, 1)
        self.assertIn(reason, status.stdout)
        noise = os.path.join(self.folder, "noise.windlog")
        subprocess.run([SIMULATOR, "recording", "-o", noise, "--duration", "60"], check=True, timeout=HANG_S)
        onto_it = ["-o", self.wall, "--force"]
        for command in (["clean-secrets", self.wall], ["import", self.config, *onto_it], ["export", noise, *onto_it],
                        ["wind", noise, *onto_it], ["report", noise, *onto_it], ["support-bundle", *onto_it],
                        ["field", "--speed", "5", "--size", "8", *onto_it]):
            with self.subTest(command[0]):
                refused = run(*command)
                self.assertEqual((refused.returncode, reason in refused.stderr), (69, True), refused.stderr)
        refused = subprocess.run([SIMULATOR, "recording", *onto_it], capture_output=True, text=True, timeout=HANG_S)
        self.assertEqual((refused.returncode, reason in refused.stderr), (69, True), refused.stderr)
        os.remove(noise)

        # On a busy disk the first may be far behind: it has to have committed a reading that the second has, too.
        now = self.recorder(first)
        self.wait_for_recorder(first, lambda recorder: recorder["written"] > now["written"] + now["waiting"])
        first.end(signal.SIGKILL)
        shown = self.wait_for_recorder(second, lambda recorder: recorder["state"] == "writing" and recorder["written"] > 100)
        self.assertGreater(shown["recorded_elsewhere"], 0)
        recorded, lost = self.end(second)
        self.assertEqual(lost, 0)
        self.assertGreaterEqual(self.exported(), recorded)
        self.assert_each_moment_is_recorded_once()
        self.assert_sound()
        self.assertEqual(run("clean-secrets", self.wall).returncode, 0)

    def test_verify_ends_with_1_for_a_recording_that_is_damaged_and_66_for_none(self):
        self.assertEqual(run("verify", self.wall).returncode, 66)
        daemon = self.start()
        self.wait_for_recorder(daemon, lambda recorder: recorder["written"] > 100 and len(self.files()) > 2)
        live = run("verify", self.wall)
        self.assertEqual(live.returncode, 0, live.stdout + live.stderr)
        recorded, _ = self.end(daemon)
        sound = run("verify", self.wall, "--json")
        self.assertEqual(sound.returncode, 0, sound.stdout)
        self.assertEqual(sum(file["readings"] for file in json.loads(sound.stdout)["files"]), recorded)

        os.remove(os.path.join(self.folder, self.files()[1]))
        damaged = run("verify", self.wall)
        self.assertEqual(damaged.returncode, 1, damaged.stdout)
        self.assertIn(": missing\n", damaged.stdout)


if __name__ == "__main__":
    unittest.main()
