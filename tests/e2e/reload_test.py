#!/usr/bin/env python3
"""A configuration that is read again while the daemon runs: by SIGHUP, by `yuragi reload`, and by a calibration.

usage: reload_test.py FOLDER_OF_PROGRAMS FOLDER_OF_SCHEMA_MODULES SCENE_BOUNDS
"""
import os
import pty
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy

import pose_client
from programs import HANG_S, Program

BIN, SCHEMA_MODULES, SCENE_BOUNDS = (os.path.abspath(sys.argv.pop(1)) for _ in range(3))
YURAGI = os.path.join(BIN, "yuragi")
SIMULATOR = os.path.join(BIN, "yuragi-sim")
RENKE = "renke-rs-fsjt-rs-fxjt-n01"

GRASS = '[[scene]]\nkind = "grass"\nblades_across = 20\nblades_deep = 20\n'
SENSOR = '[[sensor]]\ndriver = "synthetic"\nname = "roof"\nspeed = 6\n'
PARTS_OF_THE_BOUND = 1.02  # poses are quantised


class Frames(threading.Thread):
    """A client that reads every frame, and keeps the lists of scenes, and the largest step from one tick to the next of a joint of
    the first scene and of any scene's opacity. Of several scenes of a name the most visible counts: one that gives way to another
    fades across to it."""

    def __init__(self, address):
        super().__init__(daemon=True)
        self.source = pose_client.SocketBytes(address, HANG_S)
        self.source.send(pose_client.subscribe_message(True, False, "reload_test.py", takes_new_scenes=True))
        self.count = 0
        self.wind_m_s = 0.0
        self.largest_step_m = 0.0
        self.lists = []
        self.largest_opacity_step = 0.0
        self.missed = 0  # frames that this client was too slow for
        self.is_wanted = True
        self.failure = None
        self.news = threading.Condition()
        self.start()

    def run(self):
        model = last_tick = last_sequence = last_m = None
        last_opacities = {}
        try:
            for message, _ in pose_client.messages(self.source):
                kind, table = pose_client.body_of(message)
                if kind == "Scenes":
                    scenes = pose_client.read_scenes(table)
                    names, model = [scene[0] for scene in scenes], scenes[0][2]
                if kind != "Frame":
                    continue
                assert table.ScenesLength() == len(names), "a frame of another list of scenes"
                opacities = {}
                for index, name in enumerate(names):
                    opacities[name] = max(opacities.get(name, 0.0), table.Scenes(index).Opacity())
                joints_m = numpy.asarray(model.joints_m(pose_client.read_pose(table.Scenes(0))))
                with self.news:
                    if not self.lists or self.lists[-1] != names:
                        self.lists.append(names)
                    if last_tick is not None:
                        self.missed += table.Sequence() - last_sequence - 1
                    if last_tick is not None and table.Tick() == last_tick + 1:
                        step_m = numpy.sqrt(((joints_m - last_m) ** 2).sum(axis=-1)).max()
                        self.largest_step_m = max(self.largest_step_m, float(step_m))
                        self.largest_opacity_step = max([self.largest_opacity_step, *(
                            abs(opacities.get(name, 0.0) - last_opacities.get(name, 0.0)) for name in {*opacities, *last_opacities})])
                    self.count += 1
                    self.wind_m_s = float(numpy.hypot(table.Wind().UMS(), table.Wind().VMS()))
                    self.news.notify_all()
                    if not self.is_wanted:
                        return
                last_tick, last_sequence, last_m, last_opacities = table.Tick(), table.Sequence(), joints_m, opacities
        except (OSError, EOFError, ConnectionError, AssertionError, StopIteration) as error:
            self.failure = error

    def more(self, frames):
        """Waits for so many more."""
        with self.news:
            wanted = self.count + frames
            assert self.news.wait_for(lambda: self.count >= wanted, HANG_S), self.failure

    def until(self, condition):
        with self.news:
            assert self.news.wait_for(lambda: condition(self), HANG_S), f"wind {self.wind_m_s}, {self.failure}"

    def end(self):
        self.is_wanted = False
        self.join(HANG_S)
        self.source.socket.close()


def reload(*arguments):
    return subprocess.run([YURAGI, "reload", *map(str, arguments)], capture_output=True, text=True, timeout=HANG_S, check=False)


class RunningDaemon(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="yuragi-reload-")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.config = os.path.join(self.folder, "wall.toml")

    def write(self, text):
        """As an editor does: the file is never half written."""
        with open(self.config + ".new", "w", encoding="utf-8") as out:
            out.write(text)
        os.replace(self.config + ".new", self.config)

    def start(self, *command, **options):
        program = Program(*command, **options)
        self.addCleanup(program.__exit__)
        return program

    def start_daemon(self, text, *arguments):
        self.write(text)
        daemon = self.start(YURAGI, "run", "--config", self.config, "--listen", "127.0.0.1:0", *arguments)
        self.address = daemon.address()
        return daemon

    def frames(self):
        frames = Frames(self.address)
        self.addCleanup(frames.end)
        frames.more(1)
        return frames

    def bound_m(self):
        done = subprocess.run([SCENE_BOUNDS, self.config], capture_output=True, text=True, timeout=HANG_S, check=True)
        return float(done.stdout.split()[1])


class Reload(RunningDaemon):
    def test_shaping_changes_by_command_and_by_signal_and_no_joint_jumps(self):
        daemon = self.start_daemon(SENSOR + GRASS)
        frames = self.frames()
        frames.more(60)
        for floor, gusts in ((9.5, 2.0), (0.0, 0.2), (8.0, 3.0)):
            self.write(f"[shaping]\nfloor = {floor}\nover = 10\ngusts = {gusts}\nceiling = 12\n" + SENSOR + GRASS)
            done = reload("--connect", self.address)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("applied: [shaping] floor: ", done.stdout)
            frames.more(60)
        self.write('[shaping]\nclosed = 0.0\nhours = "00:00-00:01"\nzone = "Etc/GMT' + ("+6" if time.gmtime().tm_hour < 12 else "-6") +
                   '"\nfade = 1\n' + SENSOR + GRASS)
        daemon.process.send_signal(signal.SIGHUP)
        daemon.wait_for(r"reload: .*wall.toml: applied \d+ changes: .*\[shaping\] hours")
        frames.until(lambda seen: seen.wind_m_s < 0.01)
        self.assertGreater(frames.largest_step_m, 0.0)
        self.assertLessEqual(frames.largest_step_m, PARTS_OF_THE_BOUND * self.bound_m())
        print(f"largest step of a joint {1e3 * frames.largest_step_m:.2f} mm, allowed {1e3 * self.bound_m():.2f} mm")
        self.assertEqual(daemon.end(), 0)

    def test_scenes_are_exchanged_by_cross_fades_and_the_one_that_stays_does_not_jump(self):
        def with_scenes(*others):
            return SENSOR + GRASS + "".join('[[scene]]\n' + other + "\n" for other in others)

        flag, moved = 'kind = "flag"\nx = 3', 'kind = "flag"\nx = 5'
        daemon = self.start_daemon(with_scenes(flag))
        frames = self.frames()
        old = pose_client.SocketBytes(self.address, HANG_S)
        self.addCleanup(old.socket.close)
        old.send(pose_client.subscribe_message(True, False, "an old client"))
        for scenes, told, lists in (
                ([moved], "scene flag: x: 3.0 -> 5.0", [["grass", "flag", "flag"], ["grass", "flag"]]),
                (['kind = "tree"'], "scene tree: is new", [["grass", "tree", "flag"], ["grass", "tree"]]),
                (['kind = "tree"', flag], "scene flag: is new", [["grass", "tree", "flag"]]),
                ([], "", [["grass", "tree", "flag"], ["grass"]])):
            self.write(with_scenes(*scenes))
            before = len(frames.lists)
            done = reload("--connect", self.address)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn(told, done.stdout)
            frames.until(lambda seen, wanted=lists[-1], since=before: seen.lists[since:] and seen.lists[-1] == wanted)
            self.assertEqual(frames.lists[before:] if lists[0] != frames.lists[before - 1] else
                             frames.lists[before - 1:], lists)
            frames.more(20)
        self.assertLess(frames.missed, frames.count / 2, "most frames are compared with the one before")
        self.assertGreater(frames.largest_step_m, 0.0)
        self.write(SENSOR + GRASS)
        self.assertLessEqual(frames.largest_step_m, PARTS_OF_THE_BOUND * self.bound_m())
        # 2 s at 60 Hz; in the middle of a smooth fade half as fast again.
        self.assertGreater(frames.largest_opacity_step, 0.0)
        self.assertLessEqual(frames.largest_opacity_step, 1.6 / (2.0 * 60.0))
        print(f"largest step of a joint {1e3 * frames.largest_step_m:.2f} mm, allowed {1e3 * self.bound_m():.2f} mm; "
              f"of an opacity {frames.largest_opacity_step:.4f}")

        refused = []
        with self.assertRaises(EOFError):
            for message, _ in pose_client.messages(old):
                kind, table = pose_client.body_of(message)
                if kind == "Hello" and table.Refused():
                    refused.append(table.Refused().decode())
        self.assertEqual(len(refused), 1)
        self.assertIn("scenes have changed", refused[0])
        self.assertEqual(daemon.end(), 0)

    def test_a_calibration_changes_a_hundred_times_under_a_client_and_nothing_shouts(self):
        simulator = self.start(SIMULATOR, "modbus", "--tcp", "127.0.0.1:0", "--profile", RENKE, "--speed", 8, "--direction", 250)
        host, port = simulator.address().rsplit(":", 1)
        roof = f'[[sensor]]\ndriver = "modbus"\nname = "roof"\nprofile = "{RENKE}"\nhost = "{host}"\nport = {port}\n'

        def with_gain(gain):
            return f"{roof}[sensor.calibration]\ngain = {gain}\n{GRASS}"

        daemon = self.start_daemon(with_gain(1))
        daemon.wait_for("sensor roof: live")
        frames = self.frames()
        for turn in range(100):
            self.write(with_gain((1, 2.4, 0.3)[turn % 3]))
            done = reload("--connect", self.address)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("[sensor.calibration] gain", done.stdout + "[sensor.calibration] gain" * (turn == 0))
            frames.more(5)
        self.assertLessEqual(frames.largest_step_m, PARTS_OF_THE_BOUND * self.bound_m())
        self.assertEqual(daemon.end(), 0)
        self.assertNotIn("warning sensor", daemon.text())
        self.assertRegex(daemon.text(), r"sensor roof: \d+ readings from \d+ frames, 0 reconnects; refused: nothing")

    def test_a_mistake_changes_nothing_and_is_told_with_its_place(self):
        daemon = self.start_daemon(SENSOR + GRASS)
        frames = self.frames()
        for text, place in (("[shaping]\nfloor = 3\ngusts = -1\n", ":3:9: shaping.gusts: "), ("[shaping\n", ":1:9: TOML: "),
                            ('[[sensor]]\ndriver = "windlog"\nfile = "/nonexistent.windlog"\n', ":1:1: sensor: "),
                            ("".join(f'[[sensor]]\ndriver = "hid"\nname = "{name}"\n' for name in ("roof", "mast")),
                             ':4:1: sensors "roof" and "mast" both read USB weather station: ')):
            self.write(text)
            done = reload("--connect", self.address)
            self.assertEqual(done.returncode, 78, done.stdout)
            self.assertIn("wall.toml" + place, done.stderr)
            self.assertIn("nothing was changed", done.stderr)
            daemon.process.send_signal(signal.SIGHUP)
            frames.more(10)
        self.write(SENSOR + GRASS)
        self.assertEqual(reload("--connect", self.address).stdout, "nothing has changed\n")
        self.assertEqual(daemon.end(), 0)
        self.assertGreaterEqual(daemon.text().count("error reload: "), 9)

    def test_no_file_that_anybody_puts_there_stops_it(self):
        daemon = self.start_daemon(SENSOR + GRASS)
        frames = self.frames()
        kinds = {"gone": lambda: None, "a folder": lambda: os.mkdir(self.config), "a pipe": lambda: os.mkfifo(self.config),
                 "a device": lambda: os.symlink("/dev/zero", self.config), "a link to itself": lambda: os.symlink(self.config, self.config),
                 "a gigabyte": lambda: os.truncate(os.open(self.config, os.O_CREAT | os.O_WRONLY), 10**9)}
        for kind, make in kinds.items():
            os.rename(self.config, self.config + ".aside") if not os.path.isdir(self.config) else os.rmdir(self.config)
            make()
            done = reload("--connect", self.address)
            self.assertEqual(done.returncode, 78, kind)
            self.assertRegex(done.stderr, "wall.toml:1:1: file: (cannot be read|does not exist|is not a regular file|is too large)", kind)
            frames.more(2)
            if kind == "gone":
                self.write("")  # to be put aside
        self.assertEqual(daemon.end(), 0)

    def test_what_takes_a_restart_is_named_until_there_was_one(self):
        daemon = self.start_daemon(SENSOR + GRASS)
        self.write("seed = 2\n[animation]\nrate = 30\n[wind]\nhandover = 5\n" + SENSOR + "[sensor.blend]\nx = 2\n" + GRASS)
        for _ in range(2):
            done = reload("--connect", self.address)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.splitlines(), [
                "needs a restart: seed: 1 -> 2", "needs a restart: [animation] rate: 60.0 -> 30.0",
                "needs a restart: [wind] handover: 3.0 -> 5.0", "needs a restart: sensor roof: [sensor.blend] x: left out -> 2.0"])
        self.assertEqual(daemon.end(), 0)
        self.assertEqual(daemon.text().count("warning reload: these changes need a restart: seed: 1 -> 2; "), 2)

    def test_without_a_file_it_says_so_and_a_file_of_another_is_not_meant(self):
        daemon = self.start(YURAGI, "run", "--listen", "127.0.0.1:0")
        address = daemon.address()
        done = reload("--connect", address)
        self.assertEqual(done.returncode, 64)
        self.assertIn("started without --config", done.stderr)
        daemon.process.send_signal(signal.SIGHUP)
        daemon.wait_for("asked by SIGHUP[^\n]*\n[^\n]*there is no file to read again")
        self.assertEqual(daemon.end(), 0)

        daemon = self.start_daemon(SENSOR + GRASS)
        other = os.path.join(self.folder, "other.toml")
        with open(other, "w", encoding="utf-8") as out:
            out.write(f'[stream]\nlisten = "{self.address}"\n')
        done = reload("--config", other)
        self.assertEqual(done.returncode, 64)
        self.assertIn(f"runs with {self.config}, not with {other}", done.stderr)
        os.chdir(self.folder)
        self.assertEqual(reload("--config", "./wall.toml", "--connect", self.address).returncode, 0)
        self.assertEqual(reload("--connect", "127.0.0.1:1").returncode, 69)
        self.assertEqual(daemon.end(), 0)

    def test_who_may_ask_is_configured_and_can_be_changed_itself(self):
        daemon = self.start_daemon(SENSOR + GRASS)
        self.write('[stream]\ncontrol = "nobody"\n' + SENSOR + GRASS)
        self.assertEqual(reload("--connect", self.address).returncode, 0)
        done = reload("--connect", self.address)
        self.assertEqual(done.returncode, 77)
        self.assertIn('control = "nobody"', done.stderr)
        self.write(SENSOR + GRASS)
        daemon.process.send_signal(signal.SIGHUP)
        daemon.wait_for('control: "nobody" -> "loopback"')
        self.assertEqual(reload("--connect", self.address).returncode, 0)
        self.assertEqual(daemon.end(), 0)

    def test_the_log_becomes_louder_and_quieter_unless_it_is_verbose(self):
        daemon = self.start_daemon('[log]\nlevel = "info"\n' + SENSOR + GRASS)
        self.write('[log]\nlevel = "error"\n' + SENSOR + GRASS)
        self.assertEqual(reload("--connect", self.address).returncode, 0)
        self.assertEqual(reload("--connect", self.address).returncode, 0)
        self.write('[log]\nlevel = "loud"\n')
        self.assertEqual(reload("--connect", self.address).returncode, 78)
        self.assertEqual(daemon.end(), 0)
        self.assertNotIn("nothing to apply", daemon.text())
        self.assertIn("error reload: ", daemon.text())
        self.assertNotIn("ending", daemon.text())

        daemon = self.start_daemon('[log]\nlevel = "error"\n' + SENSOR + GRASS, "--verbose")
        daemon.wait_for("debug sensor roof")
        self.assertEqual(daemon.end(), 0)

    def test_a_recording_has_a_session_for_each_configuration_and_every_reading(self):
        log = os.path.join(self.folder, "wall.windlog")
        daemon = self.start_daemon(SENSOR + GRASS, "--record", log)
        for floor in (1, 2, 3):
            daemon.wait_for("sensor roof: simulated")
            with self.subTest(floor=floor):
                self.frames().more(60)  # some readings
                self.write(f"[shaping]\nfloor = {floor}\n" + SENSOR + GRASS)
                self.assertEqual(reload("--connect", self.address).returncode, 0)
        self.frames().more(60)
        self.assertEqual(daemon.end(), 0)
        said = daemon.wait_for(r"recorded (\d+) readings, lost 0")
        with sqlite3.connect(log) as database:
            floors = [text.split("[shaping]")[1].split("floor = ")[1].split()[0]
                      for (text,) in database.execute("SELECT configuration FROM session ORDER BY begin_ns")]
        self.assertEqual(floors, ["0.0", "1.0", "2.0", "3.0"])
        table = os.path.join(self.folder, "wall.csv")
        subprocess.run([YURAGI, "export", log, "-o", table], capture_output=True, timeout=HANG_S, check=True)
        with open(table, encoding="ascii") as lines:
            self.assertEqual(len(lines.readlines()) - 1, int(said.group(1)))

    def test_a_calibration_is_applied_by_the_daemon_that_runs(self):
        simulator = self.start(SIMULATOR, "modbus", "--tcp", "127.0.0.1:0", "--profile", RENKE, "--speed", 8, "--direction", 350)
        host, port = simulator.address().rsplit(":", 1)
        daemon = self.start_daemon(f'[[sensor]]\ndriver = "modbus"\nname = "roof"\nprofile = "{RENKE}"\nhost = "{host}"\nport = {port}\n'
                                   + GRASS)
        daemon.wait_for("sensor roof: live")
        done = subprocess.run([YURAGI, "calibrate", "north", "--config", self.config, "--connect", self.address, "--bearing", "10",
                               "--for", "3", "--yes"], capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"daemon at \S+ has read it again:\napplied: sensor roof: \[sensor.calibration\] north_offset: 0.0 -> ")
        daemon.wait_for(r"reload: .* applied 1 change: sensor roof: \[sensor.calibration\] north_offset: 0.0 -> ")
        self.assertEqual(daemon.end(), 0)

        done = subprocess.run([YURAGI, "calibrate", "north", "--config", self.config, "--connect", "127.0.0.1:1", "--bearing", "20",
                               "--for", "3", "--yes"], capture_output=True, text=True, timeout=120, check=False)
        self.assertIn("Restart a running daemon to apply it: ", done.stdout)

    def test_a_recording_that_plays_gets_another_rate_and_goes_on_where_it_is(self):
        log = os.path.join(self.folder, "storm.windlog")
        subprocess.run([SIMULATOR, "recording", "-o", log, "--interval", "0.25", "--duration", "600"], check=True, capture_output=True,
                       timeout=HANG_S)

        def playing_at(rate, more=""):
            return f'[[sensor]]\ndriver = "windlog"\nname = "tape"\nfile = "{log}"\nrate = {rate}\n{more}{GRASS}'

        daemon = self.start_daemon(playing_at(10))
        frames = self.frames()
        frames.more(60)
        self.write(playing_at(4, "loop = true\n"))
        done = reload("--connect", self.address)
        self.assertEqual(done.stdout, "applied: sensor tape: rate: 10.0 -> 4.0\nneeds a restart: sensor tape: loop: false -> true\n")
        frames.more(20)  # the order is carried out by the sensor's next poll
        done = subprocess.run([YURAGI, "player", "status", "--connect", self.address], capture_output=True, text=True, timeout=HANG_S,
                              check=True)
        self.assertRegex(done.stdout, r"^tape: playing at 0:00:\d\d\.\d of 0:09:\d\d\.\d, rate 4, recorded ")
        seconds = float(done.stdout.split(" at ")[1].split(":")[2].split(" ")[0])
        self.assertGreater(seconds, 5.0, "it did not begin again")
        self.assertEqual(daemon.end(), 0)

    def test_hangups_by_the_hundred_and_during_the_set_up_neither_end_nor_occupy_it(self):
        pipe = os.path.join(self.folder, "site.json")
        os.mkfifo(pipe)
        self.write(f'[shaping]\nsite_file = "{pipe}"\n' + SENSOR + GRASS)
        daemon = self.start(YURAGI, "run", "--config", self.config, "--listen", "127.0.0.1:0")
        with open(pipe, "wb"):  # opened when the daemon reads from it, which waits for what is written
            daemon.process.send_signal(signal.SIGHUP)
            self.write(f'[shaping]\nfloor = 3\nsite_file = "{pipe}"\n' + SENSOR + GRASS)
        daemon.wait_for(r"applied 1 change: \[shaping\] floor: 0.0 -> 3.0")
        self.address = daemon.address()
        frames = self.frames()
        for _ in range(300):
            daemon.process.send_signal(signal.SIGHUP)
        frames.more(60)
        daemon.process.send_signal(signal.SIGHUP)
        self.assertEqual(daemon.end(), 0, "in the middle of a reload, perhaps")

    def test_a_terminal_that_is_closed_ends_it_as_ever(self):
        controller, terminal = pty.openpty()
        self.write(SENSOR + GRASS)
        daemon = subprocess.Popen([YURAGI, "run", "--config", self.config, "--listen", "127.0.0.1:0"], stdin=terminal,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
        self.addCleanup(daemon.stdout.close)
        self.addCleanup(daemon.kill)
        os.close(terminal)
        next(line for line in daemon.stdout if "listening on" in line)
        daemon.send_signal(signal.SIGHUP)
        next(line for line in daemon.stdout if "nothing to apply" in line)
        os.close(controller)
        daemon.send_signal(signal.SIGHUP)
        self.assertIn("ending: its terminal was closed", daemon.stdout.read())
        self.assertEqual(daemon.wait(HANG_S), 0)


if __name__ == "__main__":
    pose_client.load_schema(SCHEMA_MODULES)
    unittest.main()
