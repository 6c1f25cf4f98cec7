#!/usr/bin/env python3
"""A daemon that is started again goes on with its motion ([animation] resume), as seen in the frames that it streams.

usage: resume_test.py FOLDER_OF_PROGRAMS
"""
import os
import signal
import sys
import tempfile
import unittest

import numpy

from programs import Program, free_port

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "config", "examples"))
import yuragi_client  # noqa: E402

PROGRAMS = os.path.abspath(sys.argv.pop(1))
YURAGI = os.path.join(PROGRAMS, "yuragi")
# Small ones: their joints are computed here.
SCENES = {
    "meadow": 'kind = "grass"\nblades_across = 12\nblades_deep = 8',
    "elm": 'kind = "tree"\nleaves = 16\ntwigs = 16',
    "flag": 'kind = "flag"\ncolumns = 16\nrows = 12',
    "pond": 'kind = "ripple"\ncolumns = 16\nrows = 16',
    "fire": 'kind = "flame"\ncolumns = 16\nrows = 16',
}
FRAMES = 75
# Frames that are lost between two runs: those that are on their way when the first one ends, and what the clients miss of the second.
MAX_FRAMES_BETWEEN = 4


class Run:
    """A daemon, and a client of its stream."""

    def __init__(self, test):
        self.program = test.enterContext(Program(YURAGI, "run", "--config", test.file, "--listen", "127.0.0.1:0",
                                                 env={**os.environ, "STATE_DIRECTORY": test.state}))
        self.connection = yuragi_client.Connection(self.program.address())
        test.addCleanup(self.connection.close)
        self.connection.send(yuragi_client.encode("Subscribe", protocol=yuragi_client.PROTOCOL, poses=True, client="resume_test.py"))
        self.messages = iter(self.connection)
        self.skeletons = []

    def control(self, scene, shown):
        self.connection.send(yuragi_client.encode("Control", scene=scene, shown=shown, over_s=0.0))

    def frames(self):
        """The frames until the daemon ends. They are decoded by poses_of() alone, later: who reads slowly misses the last ones."""
        try:
            for message in self.messages:
                if message.table_name == "Scenes":
                    self.skeletons = yuragi_client.read_scenes(message)
                if message.table_name == "Frame":
                    yield message
        except (EOFError, OSError):
            return

    def poses_of(self, frame):
        """The joints of each scene that the frame shows."""
        poses = zip(self.skeletons, (yuragi_client.read_pose(scene) for scene in frame.scenes))
        return {name: model.joints_m(pose) for (name, _, model), pose in poses if pose is not None}

    def first_poses(self):
        for frame in self.frames():
            return self.poses_of(frame)
        raise AssertionError("no frame has come:\n" + self.program.text())


def step_m(before, after):
    """How far the joints of each scene have moved, 99 of 100 of them at most: a flame's surface begins anew here and there."""
    return {name: float(numpy.percentile(numpy.linalg.norm(after[name] - before[name], axis=1), 99)) for name in before}


class Resume(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        self.state = os.path.join(self.folder, "state")
        os.mkdir(self.state)
        self.file = os.path.join(self.folder, "wall.toml")
        self.snapshot = os.path.join(self.state, "motion.snapshot")
        port = free_port()
        self.station = self.enterContext(Program(os.path.join(PROGRAMS, "yuragi-sim"), "nmea", "--tcp", f"127.0.0.1:{port}",
                                                 "--rate", "10", "--speed", "9"))
        self.station.wait_for(r"127\.0\.0\.1")
        self.configuration = f"""
[[sensor]]
name = "roof"
driver = "nmea"
transport = "tcp"
host = "127.0.0.1"
port = {port}
""" + "".join(f'[[scene]]\nname = "{name}"\n{values}\nx = {5 * place}\n' for place, (name, values) in enumerate(SCENES.items()))
        self.configure("")

    def configure(self, more):
        with open(self.file, "w", encoding="utf-8") as file:
            file.write(more + self.configuration)

    def run_and_end(self, signal_number=signal.SIGTERM):
        """Runs it until its wind is live and the scenes have moved for a while, and ends it. Returns its last poses, and the
        largest step of each scene from a tick to the next."""
        run = Run(self)
        run.program.wait_for(r"sensor roof: live")
        frames = []
        for frame in run.frames():
            frames.append(frame)
            if len(frames) == FRAMES:
                run.program.process.send_signal(signal_number)
        self.assertGreaterEqual(len(frames), FRAMES)
        self.assertEqual(run.program.end(signal_number), 0 if signal_number == signal.SIGTERM else -signal_number)
        largest = dict.fromkeys(SCENES, 0.0)
        for before, after in list(zip(frames, frames[1:]))[::3]:
            if after.tick == before.tick + 1:
                steps = step_m(run.poses_of(before), run.poses_of(after))
                largest = {name: max(largest[name], step) for name, step in steps.items()}
        return run.poses_of(frames[-1]), largest

    def steps_to_the_next_run(self):
        """How many of the largest steps each scene makes from the last frame of a run to the first of the next."""
        last, largest = self.run_and_end()
        first = Run(self).first_poses()
        return {name: step / largest[name] for name, step in step_m(last, first).items()}

    def test_the_scenes_go_on_where_they_were(self):
        steps = self.steps_to_the_next_run()
        for name, step in steps.items():
            self.assertLess(step, MAX_FRAMES_BETWEEN, (name, steps))
        self.assertFalse(os.path.exists(self.snapshot), "a state is loaded once")

    def test_they_do_so_with_a_sensor_more(self):
        last, largest = self.run_and_end()
        self.configuration += '[[sensor]]\nname = "mast"\ndriver = "synthetic"\n'
        self.configure("")
        for name, step in step_m(last, Run(self).first_poses()).items():
            self.assertLess(step, MAX_FRAMES_BETWEEN * largest[name], name)

    def test_without_it_they_jump(self):
        self.configure("[animation]\nresume = false\n")
        steps = self.steps_to_the_next_run()
        for name in ("meadow", "elm", "flag"):
            self.assertGreater(steps[name], 1.5 * MAX_FRAMES_BETWEEN, (name, steps))

    def test_a_scene_that_is_hidden_stays_hidden(self):
        run = Run(self)
        run.control("elm", False)
        next(frame for frame in run.frames() if "elm" not in run.poses_of(frame))
        run.program.end()
        again = Run(self)
        first = again.first_poses()
        self.assertEqual(sorted(first), sorted(set(SCENES) - {"elm"}))
        again.control("elm", True)
        self.assertTrue(any("elm" in again.poses_of(frame) for frame in again.frames()))

    def test_a_state_that_does_not_fit_is_left_out_and_said(self):
        self.run_and_end()
        with open(self.snapshot, "rb") as file:
            good = file.read()
        damaged = bytearray(good)
        damaged[len(good) // 2] ^= 1
        for content, why in ((bytes(damaged), r"is damaged"), (b"", r"is not a snapshot"), (os.urandom(1000), r"is not a snapshot")):
            with open(self.snapshot, "wb") as file:
                file.write(content)
            run = Run(self)
            run.program.wait_for(r"resume: .*motion\.snapshot " + why + r".*: the scenes begin at rest")
            run.first_poses()
            run.program.process.kill()
        with open(self.snapshot, "wb") as file:
            file.write(good)
        self.configure("[wind]\ndefault_speed = 4.0\n")
        run = Run(self)
        run.program.wait_for(r"is of another configuration")
        run.program.process.kill()
        with open(self.snapshot, "wb") as file:
            file.write(good)
        os.utime(self.snapshot, (1.0, 1.0))
        self.configure("")
        run = Run(self)
        run.first_poses()
        self.assertNotIn("resume:", run.program.text())

    def test_a_daemon_that_is_killed_begins_at_rest(self):
        self.run_and_end(signal.SIGKILL)
        self.assertEqual(os.listdir(self.state), [])
        run = Run(self)
        run.first_poses()
        self.assertNotIn("resume:", run.program.text())


if __name__ == "__main__":
    unittest.main()
