"""Daemons that lead and follow, as their streams show them: each frame's poses by the number of its tick."""
import hashlib
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy

from programs import HANG_S, Program

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "config", "examples"))
import yuragi_client  # noqa: E402

RATE_HZ = 30
SEED = 7
# Small ones: ten daemons fit on two processors, and their joints are computed here.
SCENES = {
    "meadow": 'kind = "grass"\nblades_across = 10\nblades_deep = 6',
    "elm": 'kind = "tree"\nleaves = 16\ntwigs = 16',
    "flag": 'kind = "flag"\ncolumns = 12\nrows = 8',
    "pond": 'kind = "ripple"\ncolumns = 12\nrows = 12',
    "fire": 'kind = "flame"\ncolumns = 12\nrows = 12',
}
FEW = ("meadow", "flag")
ROWS = []  # of the table that is printed at the end


def numbers_in(value):
    """The bytes of all numbers of a table of a message, in the order of its fields."""
    if isinstance(value, memoryview):
        return value.tobytes()
    if isinstance(value, yuragi_client.Table):
        return b"".join(numbers_in(getattr(value, name)) for name in yuragi_client.SCHEMA.tables[value.table_name])
    if isinstance(value, (list, tuple)):
        return b"".join(map(numbers_in, value))
    return b"" if value is None else struct.pack("<d", value)


class Frame:
    def __init__(self, message):
        self.tick, self.step, self.come_s = message.tick, round(message.time_s * RATE_HZ), time.monotonic()
        self.message = message
        self.hash = hashlib.blake2b(b"".join(numbers_in(scene.pose) + numbers_in(scene.opacity) for scene in message.scenes), digest_size=8).digest()


class Stream:
    """A client of a daemon's stream, until the daemon ends. `frames` grows."""

    def __init__(self, daemon):
        self.daemon, self.frames, self.skeletons, self.is_over, self.news = daemon, [], [], False, threading.Condition()
        self.connection = yuragi_client.Connection(daemon.address())
        daemon.test.addCleanup(self.connection.close)
        self.connection.send(yuragi_client.encode("Subscribe", protocol=yuragi_client.PROTOCOL, poses=True, client="tests/fleet"))
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        try:
            for message in self.connection:
                if message.table_name == "Scenes":
                    self.skeletons = yuragi_client.read_scenes(message)
                if message.table_name == "Frame":
                    frame = Frame(message)
                    with self.news:
                        self.frames.append(frame)
                        self.news.notify_all()
        except (EOFError, OSError, ValueError):
            pass
        with self.news:
            self.is_over = True
            self.news.notify_all()

    def wait_until(self, find, what, every=1):
        """Waits until find() returns something, and returns it; looks at every so many-th frame."""
        end_s, seen = time.monotonic() + HANG_S, 0
        while True:
            if found := find():
                return found
            with self.news:
                self.news.wait_for(lambda: len(self.frames) >= seen + every or self.is_over, HANG_S)
                seen = len(self.frames)
                if self.is_over or time.monotonic() > end_s:
                    self.daemon.test.fail(f"{self.daemon.name}: {what}: not within {HANG_S:g} s\n" + self.daemon.test.logs())

    def wait_for_frames(self, count):
        """So many from now on. Returns them."""
        begin = len(self.frames)
        self.wait_until(lambda: len(self.frames) >= begin + count, f"{count} frames")
        return self.frames[begin:]

    def since(self, moment_s):
        return [frame for frame in self.frames if frame.come_s >= moment_s]

    def joints_m(self, frame):
        poses = zip(self.skeletons, (yuragi_client.read_pose(scene) for scene in frame.message.scenes))
        return {name: model.joints_m(pose) for (name, _, model), pose in poses if pose is not None}

    def largest_steps_m(self, frames):
        """How far the joints of each scene move in one period at most; 99 of 100 of them: a flame's surface begins anew here and
        there."""
        largest, before = {}, None
        for frame in frames:
            joints = self.joints_m(frame)
            if before is not None:
                periods = max(1, frame.step - before[0])
                for name, joints_m in joints.items():
                    step_m = float(numpy.percentile(numpy.linalg.norm(joints_m - before[1][name], axis=1), 99)) / periods
                    largest[name] = max(largest.get(name, 0.0), step_m)
            before = (frame.step, joints)
        return largest

    def largest_relative_step(self, usual_m, frames):
        """Of all scenes, relative to the usual largest one."""
        return max(step_m / usual_m[name] for name, step_m in self.largest_steps_m(frames).items())

    @staticmethod
    def longest_halt(frames):
        """The most periods between two frames."""
        return max(after.step - before.step for before, after in zip(frames, frames[1:]))


class Daemon(Program):
    """`lead`, `follow`: addresses of servers, separated by commas; empty: not. `wind`: further lines of [wind]. `scenes`: as SCENES has them.
    Its `stream` is read from the start, if it is watched: each frame is hashed here, which costs more than the daemon itself. `program`: the
    words of another build of it."""

    def __init__(self, test, name, lead="", follow="", wind="", scenes=FEW, seed=SEED, speed_m_s=5.0, is_watched=True, program=None):
        self.test, self.name = test, name
        if not isinstance(scenes, dict):
            scenes = {scene: SCENES[scene] for scene in scenes}
        folder = os.path.join(test.folder, name)
        os.makedirs(folder, exist_ok=True)
        self.file = os.path.join(folder, "wall.toml")
        with open(self.file, "w", encoding="utf-8") as file:
            file.write(f"seed = {seed}\n[animation]\nrate = {RATE_HZ}\nresume = false\n"
                       f"[wind]\ndefault_speed = {speed_m_s}\n")
            for part, servers in (("lead", lead), ("follow", follow)):
                file.write(f'{part} = "{servers}"\n' if servers else "")
            file.write(wind + "\n")
            for place, (scene, values) in enumerate(scenes.items()):
                file.write(f'[[scene]]\nname = "{scene}"\n{values}\nx = {5 * place}\n')
        super().__init__(*(program or [os.path.join(test.programs, "yuragi")]), "run", "--config", self.file, "--listen", "127.0.0.1:0",
                         env={**os.environ, "STATE_DIRECTORY": folder})
        test.daemons.append(self)
        test.enterContext(self)
        self.stream = Stream(self) if is_watched else None

    def run(self, *words):
        """A command of the program, when it has ended."""
        return subprocess.run([os.path.join(self.test.programs, "yuragi"), *words], timeout=HANG_S, capture_output=True, text=True, check=False)

    def feed(self):
        """What its status has of NATS: {"sends", "trouble", ...}."""
        status = json.loads(self.run("status", "--connect", self.address(), "--json").stdout)
        return next(feed for feed in status["feeds"] if feed["kind"] == "nats")

    def doctor(self):
        """What `yuragi doctor` finds for its configuration."""
        return self.run("doctor", "--config", self.file, "--connect", self.address()).stdout

    def nodes(self):
        """The list of its leader; empty if no leader replies."""
        return json.loads(self.run("fleet", "--config", self.file, "--json").stdout or '{"nodes": []}')["nodes"]

    def wait_for_feed(self, key, pattern):
        """Waits until this part of its status matches."""
        end_s = time.monotonic() + HANG_S
        while not (found := re.search(pattern, str(self.feed()[key]))):
            if time.monotonic() > end_s:
                self.test.fail(f"{self.name}: {pattern!r} in its status: not within {HANG_S:g} s\n" + self.test.logs())
            time.sleep(0.3)
        return found

    def counts(self):
        """(ticks, repaired, without a tick, states) of a follower."""
        sends = self.feed()["sends"]
        found = re.search(r"(\d+) ticks, (\d+) lost and had again, (\d+) without a tick, (\d+) states", sends)
        self.test.assertTrue(found, sends)
        return tuple(map(int, found.groups()))


def hashes(frames):
    """By tick. Of one that was shown twice, before and after a state was loaded, the last."""
    return {frame.tick: frame.hash for frame in frames}


class FleetTest(unittest.TestCase):
    programs = ""

    def setUp(self):
        self.daemons, self.servers = [], []
        self.folder = self.enterContext(tempfile.TemporaryDirectory(prefix="yuragi-fleet-"))

    def logs(self):
        texts = []
        for daemon in self.daemons:
            text = daemon.text()
            if daemon.process.poll() is None and not (daemon.stream and daemon.stream.is_over):
                try:
                    text += f"{daemon.feed()}\n"
                except (ValueError, StopIteration, subprocess.SubprocessError) as error:
                    text += f"{error!r}\n"
            if daemon.stream and daemon.stream.frames:
                text += f"frames: {len(daemon.stream.frames)}, the last tick: {daemon.stream.frames[-1].tick}\n"
            texts.append(f"---- {daemon.name}\n{text}")
        texts += [f"---- {server.name}\n{server.program.text()}" for server in self.servers]
        return "".join(texts)

    def wait_until_equal(self, leader, follower, since_s=0.0, ticks=RATE_HZ, what="poses as the leader's"):
        """Waits until the last `ticks` ticks that both have shown, since that moment, have equal poses. Returns how long after it the
        first of the unbroken row of equal ones came, s."""
        def find():
            own, others = follower.stream.since(since_s), hashes(leader.stream.since(since_s))
            last = {frame.tick: frame for frame in own}
            common = sorted(set(last) & set(others))
            row = 0
            while row < len(common) and last[common[-1 - row]].hash == others[common[-1 - row]]:
                row += 1
            return (last[common[-row]].come_s,) if row >= ticks else None
        return follower.stream.wait_until(find, what, every=RATE_HZ // 5)[0] - since_s

    def share_equal(self, leader, follower, since_s):
        own, others = hashes(follower.stream.since(since_s)), hashes(leader.stream.since(since_s))
        common = set(own) & set(others)
        return len(common), sum(own[tick] == others[tick] for tick in common)


def add_row(case, lost="", repaired="", step="", equal="", seconds=""):
    ROWS.append((case, lost, repaired, step, equal, seconds))


def print_table():
    head = ("case", "ticks lost", "repaired", "largest step", "equal hashes", "s to be equal")
    rows = [head] + [tuple(f"{cell:.2f}" if isinstance(cell, float) else str(cell) for cell in row) for row in ROWS]
    widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
    for row in rows:
        print("| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |")
