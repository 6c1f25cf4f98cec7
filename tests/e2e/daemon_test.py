#!/usr/bin/env python3
"""The daemon as its users meet it: real processes, real sockets, real signals.

usage: daemon_test.py FOLDER_OF_PROGRAMS FOLDER_OF_SCHEMA_MODULES
"""
import fcntl
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import flatbuffers
import numpy

import pose_client
from programs import HANG_S, Program, resident_kib, shared_data

BIN, SCHEMA_MODULES = (os.path.abspath(word) for word in (sys.argv.pop(1), sys.argv.pop(1)))
YURAGI = os.path.join(BIN, "yuragi")
SIMULATOR = os.path.join(BIN, "yuragi-sim")
RENKE = "renke-rs-fsjt-rs-fxjt-n01"

# For tests of the wind, which need no whole meadow to move.
SMALL_MEADOW = "[[scene]]\nkind = \"grass\"\nblades_across = 20\nblades_deep = 20\n"

LIVE, STALE = 1, 2  # enum SensorHealth
STATE_LIVE, STATE_FROZEN = 1, 3  # enum SensorState


class Stream:
    """A subscribed client."""

    def __init__(self, address, poses=True, sensors=True, raw_sensor=None):
        self.source = pose_client.SocketBytes(address, HANG_S)
        self.source.send(pose_client.subscribe_message(poses, sensors, "daemon_test.py", raw_sensor))
        self.messages = pose_client.messages(self.source)
        self.scenes = None

    def next(self, wanted, timeout_s=HANG_S):
        """The next message of a kind."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            message, _ = next(self.messages)
            kind, table = pose_client.body_of(message)
            if kind == "Scenes":
                self.scenes = pose_client.read_scenes(table)
            if kind == wanted:
                return table
        raise AssertionError(f"no {wanted} within {timeout_s} s")

    def wait_for_sensor(self, condition, timeout_s=HANG_S):
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            sensor = self.next("Sensors").Sensors(0)
            if condition(sensor):
                return sensor
        raise AssertionError(f"the sensor did not get there within {timeout_s} s")

    def close(self):
        self.source.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class FrameWatcher(threading.Thread):
    """Reads every frame on a thread of its own, and keeps the largest step of the wind and of any blade's bend."""

    def __init__(self, address):
        super().__init__(daemon=True)
        self.stream = Stream(address, sensors=False)
        self.ticks = 0  # from the first frame to the last
        self.largest_wind_step_m_s = 0.0
        self.largest_bend_step_rad = 0.0
        self.all_finite = True
        self.is_wanted = True
        self.start()

    def run(self):
        last = first_tick = None
        while self.is_wanted:
            frame = self.stream.next("Frame")
            wind = numpy.array([frame.Wind().UMS(), frame.Wind().VMS()])
            bends = pose_client.read_pose(frame.Scenes(0))
            bend = numpy.array([bends.east_rad, bends.south_rad])
            first_tick = frame.Tick() if last is None else first_tick
            self.ticks = frame.Tick() - first_tick
            self.all_finite = self.all_finite and bool(numpy.isfinite(wind).all() and numpy.isfinite(bend).all())
            if last is not None and frame.Tick() == last[0] + 1:
                self.largest_wind_step_m_s = max(self.largest_wind_step_m_s, float(numpy.hypot(*(wind - last[1]))))
                self.largest_bend_step_rad = max(self.largest_bend_step_rad, float(numpy.hypot(*(bend - last[2])).max()))
            last = (frame.Tick(), wind, bend)

    def end(self):
        self.is_wanted = False
        self.join(HANG_S)
        self.stream.close()


def run(*arguments, timeout_s=60):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, timeout=timeout_s, check=False)


class NewerDaemon(threading.Thread):
    """Greets each client as a daemon of a newer protocol would, and closes the connection."""

    def __init__(self):
        super().__init__(daemon=True)
        from yuragi.stream import Body, Hello, Message  # made by flatc

        builder = flatbuffers.Builder(256)
        software = builder.CreateString("yuragi 9")
        Hello.Start(builder)
        Hello.AddProtocol(builder, pose_client.PROTOCOL + 1)
        Hello.AddSoftware(builder, software)
        Hello.AddTickRateHz(builder, 60.0)
        hello = Hello.End(builder)
        Message.Start(builder)
        Message.AddBodyType(builder, Body.Body.Hello)
        Message.AddBody(builder, hello)
        builder.FinishSizePrefixed(Message.End(builder), b"YURA")
        self.greeting = bytes(builder.Output())
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.listener.getsockname()[1]
        self.start()

    def run(self):
        while True:
            try:
                client, _ = self.listener.accept()
            except OSError:
                return  # closed
            with client:
                client.sendall(self.greeting)
                client.shutdown(socket.SHUT_WR)
                while client.recv(4096):
                    pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()


class DaemonTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, text=None):
        path = os.path.join(self.folder, name)
        if text is not None:
            with open(path, "w", encoding="utf-8") as out:
                out.write(text)
        return path

    def start(self, *command):
        program = Program(*command)
        self.addCleanup(program.__exit__)
        return program

    def empty_folder_but(self, name):
        for other in set(os.listdir(self.folder)) - {name}:
            os.remove(os.path.join(self.folder, other))

    def start_daemon(self, *arguments):
        return self.start(YURAGI, "run", "--listen", "127.0.0.1:0", *arguments)

    def simulated_recording(self, duration_s, *options):
        log = self.file("storm.windlog")
        subprocess.run([SIMULATOR, "recording", "-o", log, "--interval", "0.25", "--duration", str(duration_s), *options],
                       check=True, capture_output=True, timeout=HANG_S)
        return log

    # ---- run ----

    def test_it_needs_nothing_and_shows_a_late_joiner_the_picture_of_the_moment(self):
        daemon = self.start_daemon()
        address = daemon.address()
        with Stream(address, sensors=False) as early:
            while early.next("Frame").Sequence() <= 10:
                pass
            shown = early.next("Frame").Sequence()
            with Stream(address, sensors=False) as late:
                first = late.next("Frame")
                self.assertGreaterEqual(first.Sequence(), shown, "the picture of the moment")
                self.assertEqual(late.scenes[0][2].count * late.scenes[0][2].links, 100_000)

    def test_no_reader_of_its_log_and_no_signal_of_another_meaning_ends_it(self):
        log = self.file("wall.windlog")
        daemon = subprocess.Popen([YURAGI, "run", "--listen", "127.0.0.1:0", "--record", log], stderr=subprocess.PIPE, text=True)
        self.addCleanup(daemon.kill)
        listening = next(line for line in daemon.stderr if "listening on" in line)
        daemon.stderr.close()
        for number in (signal.SIGUSR1, signal.SIGUSR2, signal.SIGXFSZ, signal.SIGPIPE):
            daemon.send_signal(number)
            with Stream(listening.split()[-1]) as stream:  # each connection is logged
                stream.next("Frame")
        daemon.terminate()
        self.assertEqual(daemon.wait(HANG_S), 0)
        self.assertEqual(os.listdir(self.folder), ["wall.windlog"], "closed in order")

    def test_a_log_that_nobody_reads_delays_nobody(self):
        daemon = subprocess.Popen([YURAGI, "run", "--listen", "127.0.0.1:0", "--verbose"], stderr=subprocess.PIPE, bufsize=0)
        self.addCleanup(daemon.stderr.close)
        self.addCleanup(daemon.kill)
        fcntl.fcntl(daemon.stderr, fcntl.F_SETPIPE_SZ, 4096)
        listening = next(line for line in daemon.stderr if b"listening on" in line)  # and it is not read on
        address = listening.split()[-1].decode()
        with Stream(address, sensors=False) as stream:
            first = stream.next("Frame")
            for _ in range(100):  # some 20 kB of log
                Stream(address, poses=False).close()
            self.assertGreater(stream.next("Frame").Sequence(), first.Sequence())
        daemon.terminate()
        self.assertEqual(daemon.wait(HANG_S), 0)

    def test_it_ends_on_any_signal_to_end(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            daemon = self.start_daemon()
            with Stream(daemon.address()) as stream:
                stream.next("Frame")
                self.assertEqual(daemon.end(number), 0, daemon.text())

    def test_a_duration_ends_it(self):
        done = run("run", "--listen", "127.0.0.1:0", "--duration", "0.5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("ticks", done.stderr)

    def test_a_duration_has_a_unit_or_is_refused_in_one_line(self):
        done = run("run", "--listen", "127.0.0.1:0", "--duration", "0.01min")
        self.assertEqual(done.returncode, 0, done.stderr)
        for arguments in (("run", "--duration", "5 moons"), ("scene", "show", "meadow", "--fade", "soon"),
                          ("calibrate", "zero", "--config", "x.toml", "--for", "1 year")):
            refused = run(*arguments)
            self.assertEqual(refused.returncode, 64, refused.stderr)
            self.assertIn("is not a duration; allowed: seconds (90)", refused.stderr)
            self.assertEqual(refused.stderr.count("\n"), 2, "one line, and where the help is: " + refused.stderr)
        done = subprocess.run([SIMULATOR, "nmea", "--pty", "--duration", "200ms"], capture_output=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_mistyped_command_or_option_is_told_with_what_was_perhaps_meant(self):
        for arguments, told in ((("runn",), 'unexpected argument: "runn"; did you mean "run"?'),
                                (("sensors", "wach"), 'unexpected argument: "wach"; did you mean "watch"?'),
                                (("run", "--durtion=5"), 'did you mean "--duration"?'),
                                (("export", "a", "b", "c", "d"), 'unexpected arguments: "b", "c", "d"\n')):
            done = run(*arguments)
            self.assertEqual(done.returncode, 64, done.stderr)
            self.assertIn(told, done.stderr)
        done = subprocess.run([SIMULATOR, "modbas"], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 64)
        self.assertIn('did you mean "modbus"?', done.stderr)

    def test_every_client_names_a_newer_protocol(self):
        newer = f"speaks protocol {pose_client.PROTOCOL + 1}, this "
        with NewerDaemon() as daemon:
            for arguments in (("scene", "list"), ("player", "status"), ("sensors", "watch", "--once")):
                done = run(*arguments, "--connect", daemon.address)
                self.assertEqual(done.returncode, 69, done.stderr)
                self.assertIn(f"the daemon at {daemon.address} {newer}", done.stderr)
                self.assertIn("update this program", done.stderr)
            done = subprocess.run([sys.executable, pose_client.__file__, "--connect", daemon.address, "--schema", SCHEMA_MODULES,
                                   "--frames", "1", "--check"], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("the daemon " + newer, done.stdout + done.stderr)

    def test_it_says_that_it_records_only_when_it_does(self):
        refused = run("record", self.file("none", None) + "/a.windlog", "--listen", "127.0.0.1:0", "--duration", "1")
        self.assertEqual(refused.returncode, 73)
        self.assertNotIn("recording to", refused.stderr)
        log = self.file("a.windlog")
        done = run("record", log, "--listen", "127.0.0.1:0", "--duration", "1")
        self.assertIn("recording to " + log, done.stderr)

    def test_a_recording_that_cannot_be_opened_at_the_start_is_a_state(self):
        folder = self.file("disk")
        daemon = self.start_daemon("--record", folder + "/wall.windlog")
        daemon.wait_for(r"recording: interrupted, trying again: .*wall\.windlog")
        address = daemon.address()
        status = run("status", "--connect", address)
        self.assertEqual(status.returncode, 1, status.stdout + status.stderr)
        self.assertRegex(status.stdout, r"the recorder cannot write, and tries again: .*\(since 2\d{3}-\S+Z\)")
        os.mkdir(folder)
        daemon.wait_for(r"recording: resumed; 0 readings lost")
        hangs = time.monotonic() + HANG_S
        while "the recorder cannot" in run("status", "--connect", address).stdout:
            self.assertLess(time.monotonic(), hangs, "the status is not renewed")

    def test_an_address_that_is_taken_is_told_and_ends_it_with_69(self):
        daemon = self.start_daemon()
        done = run("run", "--listen", daemon.address())
        self.assertEqual(done.returncode, 69)
        self.assertIn(daemon.address(), done.stderr)

    def test_what_ends_it_during_its_set_up_ends_it_at_once_and_nothing_has_been_recorded(self):
        path = self.file("wall.toml", "")
        for number in (signal.SIGINT, signal.SIGTERM):
            code = 0
            while code == 0:  # on a busy machine the set-up may be over before the signal comes
                self.empty_folder_but("wall.toml")
                daemon = self.start_daemon("--config", path, "--record", self.file("wall.windlog"))
                code = daemon.end(number)
            self.assertEqual(code, -number, daemon.text())
            self.assertEqual(os.listdir(self.folder), ["wall.toml"])

    def test_the_example_client_finds_nothing_wrong(self):
        daemon = self.start_daemon()
        done = subprocess.run([sys.executable, pose_client.__file__, "--connect", daemon.address(), "--schema", SCHEMA_MODULES,
                               "--frames", "120", "--check"], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    # ---- configuration ----

    def test_a_wrong_configuration_is_told_with_its_place_and_ends_with_78(self):
        path = self.file("wall.toml", "[animation]\nrate = 0\n")
        for command in (["check-config", path], ["run", "--config", path]):
            done = run(*command)
            self.assertEqual(done.returncode, 78)
            self.assertRegex(done.stderr, re.escape(path) + r":2:8: animation\.rate: is 0; allowed: number from 1 to 240 Hz")

    def test_a_right_configuration_is_told_so_and_its_full_form_is_right_too(self):
        path = self.file("wall.toml", '[[sensor]]\ndriver = "synthetic"\nspeed = 9\n')
        self.assertEqual(run("check-config", path).returncode, 0)
        full = self.file("full.toml", run("check-config", "--full", path).stdout)
        self.assertEqual(run("check-config", full).returncode, 0)

    def two_baud_rates(self):
        """A configuration whose sensors are right one by one, and cannot be opened together."""
        sensor = '[[sensor]]\nname = "%s"\ndriver = "modbus"\ntransport = "rtu"\ndevice = "/dev/yuragi-none"\nbaud = %d\n'
        return self.file("wall.toml", sensor % ("roof", 4800) + sensor % ("mast", 9600))

    def test_what_check_config_passes_runs(self):
        def expect_refused(path, why):
            for command in (["check-config", path], ["run", "--listen", "127.0.0.1:0", "--config", path]):
                done = run(*command)
                self.assertEqual(done.returncode, 78, done.stdout + done.stderr)
                self.assertIn(why, done.stderr)

        path = self.two_baud_rates()
        expect_refused(path, path + ":7:1: sensor: /dev/yuragi-none is used with 4800 8N1 by another sensor")
        twice = "".join(f'[[sensor]]\nname = "{name}"\ndriver = "modbus"\n' for name in ("roof", "mast"))
        expect_refused(self.file("twice.toml", twice), ':4:1: sensors "roof" and "mast" both read Modbus line 127.0.0.1:502 ')
        scenes = [f'[[scene]]\nkind = "ripple"\nname = "{name}"\ncolumns = 1000\nrows = 1000\n' for name in "abcde"]
        expect_refused(self.file("large.toml", "".join(scenes)), "the scenes are larger than the stream allows")

    def test_a_start_that_fails_leaves_a_recording_as_it_was_and_begins_none(self):
        path = self.two_baud_rates()
        log = self.file("storm.windlog")
        self.assertEqual(run("record", log, "--listen", "127.0.0.1:0", "--duration", "1").returncode, 0)
        with open(log, "rb") as recording:
            before = recording.read()
        for file in (log, self.file("new.windlog")):
            self.assertEqual(run("record", file, "--listen", "127.0.0.1:0", "--config", path).returncode, 78)
        self.assertEqual(sorted(os.listdir(self.folder)), ["storm.windlog", "wall.toml"])
        with open(log, "rb") as recording:
            self.assertEqual(recording.read(), before)

    def test_where_a_sensor_stands_is_told_and_stays_untold_where_it_was_not(self):
        sensor = '[[sensor]]\nname = "%s"\ndriver = "synthetic"\n'
        path = self.file("wall.toml", sensor % "roof" + "[sensor.blend]\nx = -12\nlead = 5\n" + sensor % "mast")
        said = run("check-config", path).stdout
        self.assertIn("sensor roof (synthetic), 12 m west of the middle of the scenes, taken 5 m upwind of there, ", said)
        self.assertIn("sensor mast (synthetic), at the windward edge of the scenes, ", said)
        full = self.file("full.toml", run("check-config", "--full", path).stdout)
        self.assertEqual(run("check-config", full).stdout.splitlines()[1:], said.splitlines()[1:])
        self.assertIn("left out: its gusts enter at the windward edge of the scenes", run("describe").stdout)

    def test_a_profile_that_is_not_there_is_a_mistake_of_the_configuration(self):
        path = self.file("wall.toml", '[[sensor]]\ndriver = "modbus"\nprofile = "no-such-device"\n')
        done = run("check-config", path)
        self.assertEqual(done.returncode, 78)
        self.assertIn("wall.toml:1:1: sensor:", done.stderr)
        self.assertIn(RENKE, done.stderr)

    # ---- a Modbus anemometer ----

    def modbus_config(self, address):
        host, port = address.rsplit(":", 1)
        return self.file("roof.toml", f"""
[wind]
default_speed = 2.0
default_turbulence = 0.0
[[sensor]]
name = "roof"
driver = "modbus"
profile = "{RENKE}"
host = "{host}"
port = {port}
""")

    def start_simulator(self, address="127.0.0.1:0"):
        return self.start(SIMULATOR, "modbus", "--tcp", address, "--profile", RENKE, "--speed", "8", "--direction", "90")

    def test_a_simulator_that_is_killed_and_restarted_moves_the_grass_without_a_jump_and_is_read_again(self):
        simulator = self.start_simulator()
        sensor_address = simulator.address()
        daemon = self.start_daemon("--config", self.modbus_config(sensor_address))
        with Stream(daemon.address(), poses=False) as status:
            live = status.wait_for_sensor(lambda sensor: sensor.Health() == LIVE and sensor.Readings() > 20)
            self.assertEqual(live.DirectionDeg() % 1.0, 0.0, "the vane tells whole degrees")
            self.assertAlmostEqual(live.DirectionDeg(), 90.0, delta=60.0)
            watcher = FrameWatcher(daemon.address())

            simulator.end(signal.SIGKILL)
            lost = status.wait_for_sensor(lambda sensor: sensor.Health() == STALE)
            self.assertIsNotNone(lost.SpeedMS(), "the last value is kept, apart from the state")
            for _ in range(8):  # four seconds: the hand-over to the default wind
                status.next("Sensors")
            self.start_simulator(sensor_address)
            returned = status.wait_for_sensor(
                lambda sensor: sensor.Health() == LIVE and sensor.Readings() > lost.Readings() + 3 and sensor.AgeS() < 2.0)
            self.assertGreaterEqual(returned.Reconnects(), lost.Reconnects() + 1)
            self.assertGreater(returned.Frames(), lost.Frames())
            watcher.end()

        # A follower moves at most 0.37 w e a second: w at most 25 rad/s, and readings that differ by up to 8 m/s (turbulence,
        # and a vane that turns) give 1.2 m/s a tick.
        self.assertGreater(watcher.ticks, 120)
        self.assertTrue(watcher.all_finite)
        self.assertLess(watcher.largest_wind_step_m_s, 1.2)
        self.assertLess(watcher.largest_bend_step_rad, 0.35)

    def test_a_frozen_sensor_is_told_in_stream_watch_and_log_and_is_believed_again_when_it_moves(self):
        simulator = self.start(SIMULATOR, "modbus", "--tcp", "127.0.0.1:0", "--profile", RENKE, "--speed", "8",
                               "--fault", "freeze@8+12")
        config = self.modbus_config(simulator.address())
        with open(config, "a", encoding="utf-8") as out:
            out.write("poll_interval = 0.1\n[sensor.judge]\nfrozen = 2\n")
        daemon = self.start_daemon("--config", config)
        with Stream(daemon.address(), poses=False) as status:
            live = status.wait_for_sensor(lambda sensor: sensor.State() == STATE_LIVE)
            self.assertIn(b"reading", live.StateReason())
            frozen = status.wait_for_sensor(lambda sensor: sensor.State() == STATE_FROZEN)
            self.assertEqual(frozen.Health(), LIVE, "it speaks")
            self.assertRegex(frozen.StateReason().decode(), r"the same reading, \d+\.\d\d m/s, \d+ times in ")
            shown = run("sensors", "watch", "--once", "--connect", daemon.address())
            self.assertRegex(shown.stdout, r"roof +modbus +FROZEN")
            self.assertIn("frozen: the same", shown.stdout)
            status.wait_for_sensor(lambda sensor: sensor.State() == STATE_LIVE)
        self.assertEqual(daemon.end(signal.SIGINT), 0)
        told = [line for line in daemon.text().splitlines() if "sensor roof: frozen: the same" in line]
        self.assertEqual(len(told), 1, daemon.text())
        self.assertIn("warning", told[0])

    def test_a_probe_finds_the_simulator_and_what_it_prints_is_a_right_configuration(self):
        simulator = self.start(SIMULATOR, "modbus", "--tcp", "127.0.0.1:0", "--device", "thies-clima-sensor-us@3", "--device", "calypso-ulp@5")
        done = run("sensors", "probe", "modbus", simulator.address(), "--id", "1-5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("slave 3 at", done.stdout)
        self.assertIn("fits thies-clima-sensor-us", done.stdout)
        # All of it is one configuration: what is not a table is a comment.
        checked = run("check-config", self.file("found.toml", done.stdout))
        self.assertEqual(checked.returncode, 0, checked.stderr + done.stdout)
        self.assertEqual(re.findall(r'^name = "(.*)"$', done.stdout, re.MULTILINE), ["wind-3", "wind-5"])
        # The block has the best profile; a comment below it names each other one that fits.
        for device in done.stdout.split("# slave ")[1:]:
            fits = re.findall(r"^#   fits (\S+)", device, re.MULTILINE)
            self.assertEqual(re.findall(r'^profile = "(.*)"$', device, re.MULTILINE), fits[:1])
            self.assertEqual(re.findall(r'^# profile = "(.*)"$', device, re.MULTILINE), fits[1:])

        nobody = run("sensors", "probe", "modbus", simulator.address(), "--id", "4")
        self.assertEqual(nobody.returncode, 69)
        self.assertIn("no device replies", nobody.stderr)
        self.assertEqual(run("sensors", "probe", "modbus", simulator.address(), "--id", "0-3").returncode, 64)

    def test_a_probe_of_a_serial_line_can_be_interrupted(self):
        link = os.path.join(self.folder, "bus")
        self.start(SIMULATOR, "modbus", "--rtu", "--link", link).wait_for("serving ")
        probe = self.start(YURAGI, "sensors", "probe", "modbus", link, "--baud", "4800", "--id", "1-247")
        probe.wait_for("fits renke-rs-fsjt-rs-fxjt-n01")
        self.assertEqual(probe.end(signal.SIGINT), 0)
        self.assertIn("interrupted", probe.text())

    # ---- recording ----

    def test_kill_9_loses_at_most_the_last_second_of_a_recording(self):
        log = self.file("storm.windlog")
        config = self.file("fast.toml", '[[sensor]]\ndriver = "synthetic"\nrate = 50\n')
        daemon = self.start_daemon("--config", config, "--record", log)
        with Stream(daemon.address(), poses=False) as stream:
            told = stream.next("Sensors")
            while told.Sensors(0).Readings() <= 150:
                told = stream.next("Sensors")
        daemon.end(signal.SIGKILL)
        csv = run("export", log, "-o", "-")
        self.assertEqual(csv.returncode, 0, csv.stderr)
        rows = len(csv.stdout.splitlines()) - 1
        self.assertGreaterEqual(rows, told.Recorder().Written(), "what it said is written is there")
        # A commit begins once a second, and takes a while by itself where others use the disk: tests/abuse measures it.
        self.assertGreaterEqual(rows, told.Sensors(0).Readings() - 100)

    def test_a_clean_end_leaves_one_file_with_every_reading_and_the_configuration(self):
        log = self.file("storm.windlog")
        daemon = self.start(YURAGI, "record", log, "--listen", "127.0.0.1:0")
        with Stream(daemon.address(), poses=False) as stream:
            told = stream.wait_for_sensor(lambda sensor: sensor.Readings() >= 7).Readings()
        self.assertEqual(daemon.end(), 0, daemon.text())
        self.assertEqual(os.listdir(self.folder), ["storm.windlog"])
        self.assertIn("lost 0", daemon.text())
        csv = run("export", log, "-o", "-").stdout.splitlines()
        self.assertGreaterEqual(len(csv) - 1, told)

    def test_a_replay_gives_the_same_poses_bit_for_bit_on_every_run(self):
        log = self.simulated_recording(duration_s=3)
        runs = [run("replay", log, "--rate", "max") for _ in range(2)]
        self.assertEqual(runs[0].returncode, 0, runs[0].stderr)
        self.assertRegex(runs[0].stdout, r"pose hash  [0-9a-f]{16}")
        self.assertEqual(runs[0].stdout, runs[1].stdout)

    def test_a_replay_explains_the_difference_that_the_ceiling_makes(self):
        log = self.simulated_recording(10, "--speed", "30")
        def replay(shaping):
            config = self.file("patch.toml", f"[shaping]\n{shaping}\n" + SMALL_MEADOW)
            return run("replay", log, "--rate", "max", "--config", config).stdout
        held = replay("ceiling = 12\nceiling_most = 20")
        free = replay("ceiling = 0")
        summary = re.search(r"ceiling +held the wind back for (\S+) % of the time .*the mean is (\S+) m/s, the max (\S+) m/s", held)
        self.assertIsNotNone(summary, held)
        self.assertGreater(float(summary.group(1)), 50)
        self.assertNotIn("ceiling", free)
        mean, largest = re.search(r"replayed +mean (\S+) m/s, max (\S+) m/s", free).groups()
        self.assertAlmostEqual(float(summary.group(2)), float(mean), delta=0.02)
        self.assertAlmostEqual(float(summary.group(3)), float(largest), delta=0.02)

    def test_what_a_command_waits_for_is_announced(self):
        # It accepts, and never replies.
        with socket.create_server(("127.0.0.1", 0)) as mute:
            address = f"127.0.0.1:{mute.getsockname()[1]}"
            done = run("status", "--connect", address)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(f"waiting for the daemon at {address}", done.stderr)
            self.assertNotIn("waiting for", run("status", "--quiet", "--connect", address).stderr)
            self.assertIn("examining the daemon that runs", run("doctor", "--connect", address).stderr)

    def test_a_real_recorded_wind_is_replayed_as_it_blew(self):
        csv = shared_data("sonic", "finse_csat3_10hz_20180720T140000.csv")
        if csv is None:
            self.skipTest("../shared/data is not there")
        log = self.file("finse.windlog")
        self.assertEqual(run("import", csv, "-o", log).returncode, 0)
        table = run("replay", log, "--rate", "max", "--config", self.file("patch.toml", SMALL_MEADOW), timeout_s=200).stdout
        recorded = re.search(r"recorded   mean (\S+) m/s, max (\S+) m/s", table)
        replayed = re.search(r"replayed   mean (\S+) m/s, max (\S+) m/s", table)
        self.assertEqual(recorded.groups(), ("7.02", "11.27"))
        self.assertAlmostEqual(float(replayed.group(1)), 7.02, delta=0.05)
        # Gusts of less than two metres, of which readings of 10 Hz do not tell, are made up on top of theirs.
        self.assertAlmostEqual(float(replayed.group(2)), 11.27, delta=0.8)

    def test_a_replay_at_a_pace_ends_with_its_recording(self):
        log = self.simulated_recording(duration_s=60)
        done = run("replay", log, "--rate", "20", "--listen", "127.0.0.1:0")
        self.assertEqual(done.returncode, 0, done.stderr)
        ticks = int(re.search(r"(\d+) ticks", done.stderr).group(1))
        self.assertLess(ticks, 60 * 60 / 4, "a minute at 20 times its pace takes 3 s; a busy machine may take 15")
        self.assertIn("the recording has ended", done.stderr)

    def test_a_day_is_replayed_with_the_configuration_and_all_sensors_of_the_recording(self):
        log = self.file("day.windlog")
        config = self.file("wall.toml", SMALL_MEADOW + "".join(
            f'[[sensor]]\nname = "{name}"\ndriver = "synthetic"\nspeed = {speed}\n[sensor.blend]\npriority = 1\n'
            for name, speed in (("roof", 4), ("yard", 5))))
        done = run("record", log, "--config", config, "--duration", 3, "--listen", "127.0.0.1:0")
        self.assertEqual(done.returncode, 0, done.stderr)
        runs = [run("replay", log, "--as-recorded", "--rate", "max") for _ in range(2)]
        self.assertEqual(runs[0].returncode, 0, runs[0].stderr)
        self.assertRegex(runs[0].stdout, r"pose hash  [0-9a-f]{16}")
        self.assertEqual(runs[0].stdout, runs[1].stdout)
        _, address = self.start_replay(log, "--as-recorded", "--paused")
        with Stream(address, poses=False) as stream:
            sensors = stream.next("Sensors")
            self.assertEqual([sensors.Sensors(i).Name() for i in range(sensors.SensorsLength())], [b"roof", b"yard"])
        done = run("replay", log, "--as-recorded", "--rate", 4, "--listen", "127.0.0.1:0")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("the recording has ended", done.stderr)
        for option in (("--config", config), ("--loop",), ("--sensor", "roof"), ("--same-time-of-day",)):
            self.assertEqual(run("replay", log, "--as-recorded", *option).returncode, 64, option)

    # ---- playing a recording ----

    def recording(self, speeds, interval_s=0.1, name="told.windlog", sensor=None):
        """A recording of these speeds, one every so often, from 2024-06-01T12:00:00Z on, from west."""
        rows = ["time,speed,direction"]
        rows += [f"2024-06-01T12:{int(i * interval_s) // 60:02}:{i * interval_s % 60:06.3f}Z,{speed},270"
                 for i, speed in enumerate(speeds)]
        log = self.file(name)
        done = run("import", self.file(name + ".csv", "\n".join(rows) + "\n"), "-o", log)
        self.assertEqual(done.returncode, 0, done.stderr)
        return log

    def test_the_first_frame_of_a_replay_is_of_scenes_that_have_lived_in_its_wind(self):
        gale = self.file("gale.windlog")
        simulated = subprocess.run([SIMULATOR, "recording", "-o", gale, "--speed", "16", "--direction", "270", "--duration", "600", "--seed", "5"],
                                   capture_output=True, text=True, timeout=HANG_S, check=False)
        self.assertEqual(simulated.returncode, 0, simulated.stderr)
        config = self.file("mast.toml", '[[scene]]\nkind = "flag"\n')
        for options, begins_s in (((), 0), (("--start", "20"), 20), (("--start", "20", "--rate", "4"), None), (("--same-time-of-day",), None)):
            daemon, address = self.start_replay(gale, "--config", config, *options)
            with Stream(address) as stream:
                frame = stream.next("Frame")
                (_, _, flag), = stream.scenes
                joints_m = flag.joints_m(pose_client.read_pose(frame.Scenes(0))).reshape(flag.rows, -1, 3)
                way_m = joints_m[-1] - joints_m[0]  # from the hoist to the fly
                self.assertGreater(float(way_m[:, 0].mean()), 2 * abs(float(way_m[:, 1].mean())), f"{options}: it hangs")
                self.assertGreater(stream.next("Frame").Wind().UMS(), 8.0, f"{options}: not the recording's wind")
                if begins_s is not None:
                    place_s = self.place_s(address)
                    self.assertTrue(begins_s <= place_s < begins_s + HANG_S, f"{options}: at {place_s} s")
            daemon.end()

    def place_s(self, address):
        hours, minutes, seconds = re.search(r"at (\d+):(\d\d):([\d.]+) of", self.player(address, "status")).groups()
        return 3600 * int(hours) + 60 * int(minutes) + float(seconds)

    def start_replay(self, log, *arguments):
        daemon = self.start(YURAGI, "replay", log, "--listen", "127.0.0.1:0", *arguments)
        return daemon, daemon.address()

    def player(self, address, *words, code=0):
        done = run("player", words[0], "--connect", address, *words[1:])
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout if code == 0 else done.stderr

    def test_a_replay_is_paused_stepped_and_moved_while_it_runs(self):
        # Each reading says which one it is.
        log = self.recording([0.01 * i for i in range(1200)])
        daemon, address = self.start_replay(log, "--seam", 0, "--loop")
        with Stream(address, poses=False) as stream:
            stream.wait_for_sensor(lambda sensor: sensor.Health() == LIVE)
            self.assertRegex(self.player(address, "status"), r"told: playing at 0:00:\d\d\.\d of 0:01:59\.9, rate 1, looping")

            paused = self.player(address, "pause")
            self.assertIn("paused at", paused)
            held = stream.wait_for_sensor(lambda sensor: b"paused" in sensor.Detail())
            for _ in range(6):  # three seconds, which would make any other sensor at 10 Hz stale
                later = stream.next("Sensors").Sensors(0)
            self.assertEqual(later.Health(), LIVE)
            self.assertLess(later.AgeS(), 2.5, "it does not grow old")
            self.assertEqual(later.SpeedMS(), held.SpeedMS())
            self.assertEqual(later.Readings(), held.Readings())
            self.assertEqual(self.player(address, "status"), paused)

            self.assertIn("paused at 0:01:00.0", self.player(address, "seek", "60"))
            self.assertIn("paused at 0:01:00.5", self.player(address, "step", "5"))
            stepped = stream.wait_for_sensor(lambda sensor: abs(sensor.SpeedMS() - 6.05) < 1e-9)
            self.assertTrue(stepped.Replayed(), "nobody may take it for live")
            self.assertIn("paused at 0:00:30.5", self.player(address, "seek", "-30"))
            self.assertIn("recorded 2024-06-01T12:01:40Z", self.player(address, "seek", "2024-06-01T12:01:40Z"))
            self.assertIn("rate 10", self.player(address, "rate", "10"))
            self.assertIn("playing", self.player(address, "resume"))
            stream.wait_for_sensor(lambda sensor: sensor.SpeedMS() > 9.9)  # what was sent before may still come
            stream.wait_for_sensor(lambda sensor: sensor.SpeedMS() < 9.0)
            self.assertRegex(self.player(address, "status"), r"looping: round [2-9]")

        self.assertIn("119.9", self.player(address, "seek", "500", code=64))
        self.assertIn("give seconds", self.player(address, "seek", "soon", code=64))
        self.assertIn("there are: told", self.player(address, "pause", "--sensor", "roof", code=64))
        self.player(address, "rate", "0", code=64)
        self.player(address, "step", "0", code=64)
        self.assertIn("told was asked to pause", daemon.text())

    def test_a_seek_and_the_seam_of_a_loop_move_the_wind_without_a_jump(self):
        # Half a calm, half a storm: 14 m/s apart.
        log = self.recording([1.0] * 150 + [15.0] * 150)
        quiet = self.file("quiet.toml", "[wind]\ndefault_turbulence = 0\n" + SMALL_MEADOW)
        _, address = self.start_replay(log, "--loop", "--seam", 6, "--config", quiet)
        speeds = []

        def heard(sensor):
            if sensor.SpeedMS() is not None:
                speeds.append(sensor.SpeedMS())
            return bool(speeds)

        with Stream(address, poses=False) as status:
            status.wait_for_sensor(heard)
            watcher = FrameWatcher(address)
            self.player(address, "seek", "20")
            status.wait_for_sensor(lambda sensor: heard(sensor) and speeds[-1] > 14.9)
            self.player(address, "rate", "2")  # to the end, and over it
            status.wait_for_sensor(lambda sensor: heard(sensor) and speeds[-1] < 1.1)
            watcher.end()
        # It is told twice a second. 14 m/s over 5 s (a fade is no more than a third of the recording), 1.5 times as fast in the middle:
        # 2.1 m/s each time; a hard seam would be 14.
        self.assertLess(max(abs(after - before) for before, after in zip(speeds, speeds[1:])), 6.0, speeds)
        self.assertGreater(watcher.ticks, 120)
        self.assertTrue(watcher.all_finite)
        self.assertLess(watcher.largest_wind_step_m_s, 0.6)

    def test_players_obey_those_who_may_and_a_daemon_without_recordings_says_so(self):
        log = self.recording([5.0] * 100)
        nobody = self.file("nobody.toml", '[stream]\ncontrol = "nobody"\n')
        _, address = self.start_replay(log, "--loop", "--config", nobody)
        self.assertIn("control", self.player(address, "pause", code=77))
        self.assertIn("playing", self.player(address, "status"))
        self.assertIn("no sensor of this daemon plays a recording", self.player(self.start_daemon().address(), "status", code=64))
        self.player(self.free_address(), "status", code=69)

    def test_a_replay_begins_paused_or_at_the_time_of_day_where_it_is_told_to(self):
        log = self.recording([0.01 * i for i in range(600)], interval_s=1.0)
        _, address = self.start_replay(log, "--paused", "--start", "90")
        with Stream(address, poses=False) as stream:
            stream.wait_for_sensor(lambda sensor: sensor.Readings() == 1)
        self.assertIn("paused at 0:01:30.0", self.player(address, "status"))

        # Recorded from 12:00 to 12:10 UTC. The offset that makes the middle of that this machine's time of day.
        here_h = (time.time() + time.localtime().tm_gmtoff) / 3600.0
        hours_ahead = (here_h - 12.0 - 300.0 / 3600.0) % 24.0
        hours_ahead = hours_ahead - 24.0 if hours_ahead > 12.0 else hours_ahead
        _, address = self.start_replay(log, "--same-time-of-day", "--utc-offset", f"{hours_ahead:.6f}")
        with Stream(address, poses=False) as stream:
            stream.wait_for_sensor(lambda sensor: sensor.Readings() > 0)
        self.assertRegex(self.player(address, "status"), r"playing at 0:0(4:5|5:[0-3])\d")
        refused = run("replay", log, "--same-time-of-day", "--rate", "max")
        self.assertEqual(refused.returncode, 64)
        self.assertIn("--same-time-of-day", refused.stderr)

    # ---- the fall-back ----

    def test_a_recording_is_played_when_the_only_sensor_dies_and_ends_when_it_is_back(self):
        log = self.recording([3.0] * 600, name="calm.windlog")
        simulator = self.start_simulator()
        sensor_address = simulator.address()
        host, port = sensor_address.rsplit(":", 1)
        config = self.file("wall.toml", f"""
[wind]
default_speed = 2.0
default_turbulence = 0.0
fallback_recording = "{log}"
fallback_after = 2
[[sensor]]
name = "roof"
driver = "modbus"
profile = "{RENKE}"
host = "{host}"
port = {port}
""")
        self.assertEqual(run("check-config", config).returncode, 0)
        kept = self.file("kept.windlog")
        daemon = self.start_daemon("--config", config, "--record", kept)
        address = daemon.address()
        with Stream(address, poses=False) as status:
            status.wait_for_sensor(lambda sensor: sensor.Health() == LIVE and sensor.Readings() > 10)
            watcher = FrameWatcher(address)
            simulator.end(signal.SIGKILL)

            def wait_for(condition, timeout_s=HANG_S):
                deadline = time.monotonic() + timeout_s
                while time.monotonic() < deadline:
                    sensors = status.next("Sensors")
                    if condition(sensors):
                        return sensors
                raise AssertionError("the fall-back did not get there\n" + daemon.text())

            plays = wait_for(lambda sensors: sensors.SensorsLength() == 2 and sensors.Sensors(1).Health() == LIVE)
            fallback = plays.Sensors(1)
            self.assertEqual(fallback.Name(), b"fall-back")
            self.assertTrue(fallback.Replayed())
            self.assertIn(b"all sensors are silent", fallback.Detail())
            self.assertAlmostEqual(fallback.SpeedMS(), 3.0, 6)
            table = run("sensors", "watch", "--connect", address, "--once").stdout
            self.assertIn("REPLAY", table)

            self.start_simulator(sensor_address)
            wait_for(lambda sensors: sensors.SensorsLength() == 1 and sensors.Sensors(0).Health() == LIVE)
            watcher.end()
        self.assertIn("all sensors are silent: playing " + log, daemon.text())
        self.assertIn("a sensor is live again", daemon.text())
        self.assertLess(watcher.largest_wind_step_m_s, 1.2)
        self.assertTrue(watcher.all_finite)
        self.assertEqual(daemon.end(), 0)
        rows = run("export", kept, "-o", "-").stdout.splitlines()[1:]
        self.assertTrue(rows)
        self.assertFalse([row for row in rows if "fall-back" in row])

    def test_a_fall_back_that_cannot_be_played_is_a_mistake_of_the_configuration(self):
        path = self.file("wall.toml", '[wind]\nfallback_recording = "/no/such.windlog"\n')
        for command in (["check-config", path], ["run", "--listen", "127.0.0.1:0", "--config", path]):
            done = run(*command)
            self.assertEqual(done.returncode, 78, done.stderr)
            self.assertIn(path + ":2:22: wind.fallback_recording: /no/such.windlog: the recording does not exist", done.stderr)

    def test_a_recording_that_is_not_there_ends_with_66(self):
        self.assertEqual(run("replay", self.file("none.windlog")).returncode, 66)

    def test_what_is_no_recording_ends_a_replay_with_65_and_is_told_what_it_is(self):
        csv = self.file("mast.csv", "time,speed\n2024-01-01T00:00:00Z,3\n")
        text = self.file("notes.txt", "remember the mast\n")
        for arguments in ((), ("--rate", "max")):
            done = run("replay", csv, *arguments)
            self.assertEqual(done.returncode, 65, done.stderr)
            self.assertIn(f"{csv}: is a CSV file, not a recording: import it with `yuragi import {csv} -o ", done.stderr)
            self.assertEqual(run("replay", text, *arguments).returncode, 65)
        self.assertIn("is a text file, not a Yuragi recording", run("replay", text).stderr)
        self.assertEqual(run("wind", csv, "-o", "-").returncode, 65)

    # ---- sensors watch ----

    def test_watch_asks_the_running_daemon(self):
        daemon = self.start_daemon()
        with Stream(daemon.address(), poses=False) as stream:
            stream.wait_for_sensor(lambda sensor: sensor.Health() == LIVE)
        done = run("sensors", "watch", "--connect", daemon.address(), "--once")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("daemon at " + daemon.address(), done.stdout)
        self.assertIn("simulated", done.stdout)

    def test_watch_connects_by_its_old_option_too_and_says_that_it_is_old(self):
        daemon = self.start_daemon()
        done = run("sensors", "watch", "--listen", daemon.address(), "--once")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("daemon at " + daemon.address(), done.stdout)
        self.assertIn("note: --listen is deprecated here: use --connect", done.stderr)
        self.assertEqual(run("sensors", "watch", "--listen", "127.0.0.1:1", "--connect", "127.0.0.1:1").returncode, 64)

    def test_watch_says_how_the_wind_is_shaped_for_the_scenes(self):
        config = self.file("wall.toml", """
[shaping]
floor = 4
over = 10
ceiling = 0
[wind]
default_speed = 1
default_turbulence = 0
[[sensor]]
driver = "synthetic"
speed = 1
turbulence = 0
""")
        daemon = self.start_daemon("--config", config)
        with Stream(daemon.address()) as stream:
            deadline = time.monotonic() + HANG_S
            shaping = stream.next("Sensors").Shaping()
            while shaping.ShapedMeanMS() < 3.9 and time.monotonic() < deadline:
                shaping = stream.next("Sensors").Shaping()
            self.assertAlmostEqual(shaping.ShapedMeanMS(), 4.0, delta=0.3)
            self.assertAlmostEqual(shaping.MeanMS(), 1.0, delta=0.3)
            wind = stream.next("Sensors").Wind()
            self.assertLess(numpy.hypot(wind.UMS(), wind.VMS()), 1.5, "the sensors' wind stays the real one")
            wind = stream.next("Frame").Wind()
            self.assertGreater(numpy.hypot(wind.UMS(), wind.VMS()), 2.0, "the scenes' is raised")
        table = run("sensors", "watch", "--connect", daemon.address(), "--once").stdout
        self.assertRegex(table, r"shaped: floor: raised (0\.9|1\.[01]) to 4\.0 m/s")
        self.assertRegex(daemon.end(signal.SIGINT) == 0 and daemon.text(), "raised toward the floor of 4.0 m/s")

    def test_watch_opens_the_devices_itself_where_no_daemon_runs(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            address = "127.0.0.1:%d" % free.getsockname()[1]
        done = run("sensors", "watch", "--connect", address, "--once")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no daemon", done.stdout)
        self.assertIn("simulated: synthetic values, not measured", done.stdout)

    def free_address(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            return "127.0.0.1:%d" % free.getsockname()[1]

    def raw_lines(self, watch, pattern, least):
        """The lines of this form that `sensors watch --raw` shows, until there are so many; then it is ended."""
        lines = watch.wait_until(lambda text: (found := re.findall(f"(?m)^{pattern}\n", text)) and len(found) >= least and found)
        self.assertTrue(lines, watch.text())
        watch.end(signal.SIGINT)
        return [line.rstrip("\n") for line in lines]

    def test_raw_messages_are_shown_as_they_come(self):
        config = self.modbus_config(self.start_simulator().address())
        daemon = self.start_daemon("--config", config)
        watch = self.start(YURAGI, "sensors", "watch", "--raw", "roof", "--connect", daemon.address())
        lines = self.raw_lines(watch, r"\d\d:\d\d:\d\d\.\d{3} roof .*", 8)
        self.assertIn("daemon at " + daemon.address(), watch.text())
        # Transaction, protocol 0, length 6, slave 1, function 3, register 0, one of them; and its answer.
        asked = [line for line in lines if re.match(r"\d\d:\d\d:\d\d\.\d{3} roof +-> .. .. 00 00 00 06 01 03 00 00 00 01 ", line)]
        answered = [line for line in lines if re.match(r"\d\d:\d\d:\d\d\.\d{3} roof +<- .. .. 00 00 00 05 01 03 02 ", line)]
        self.assertTrue(asked and answered, lines)

        unknown = run("sensors", "watch", "--raw", "mast", "--connect", daemon.address(), "--duration", "5")
        self.assertEqual(unknown.returncode, 64)
        self.assertIn("there are: roof", unknown.stderr)

    def test_raw_messages_are_read_by_a_client_that_knows_the_schema_alone(self):
        daemon = self.start_daemon("--config", self.modbus_config(self.start_simulator().address()))
        with Stream(daemon.address(), poses=False, raw_sensor="roof") as stream:
            traces = [stream.next("RawTrace") for _ in range(8)]
        for before, trace in zip(traces, traces[1:]):
            self.assertEqual(trace.Sensor(), b"roof")
            self.assertGreaterEqual(trace.MonoNs(), before.MonoNs())
            self.assertLess(abs(trace.UtcNs() - time.time_ns()), 60e9)
            self.assertEqual(trace.Length(), trace.BytesLength())
            self.assertEqual(trace.Lost(), 0)
            if trace.Received() and not before.Received():  # an answer has its request's transaction
                self.assertEqual(trace.BytesAsNumpy()[:2].tolist(), before.BytesAsNumpy()[:2].tolist())
        self.assertEqual({trace.Received() for trace in traces}, {False, True})

    def test_raw_messages_are_what_decode_reads(self):
        config = self.modbus_config(self.start_simulator().address())
        for listen in (self.start_daemon("--config", config).address(), self.free_address()):
            watch = self.start(YURAGI, "sensors", "watch", "--raw", "roof", "--hex", "--connect", listen, "--config", config)
            lines = self.raw_lines(watch, "[0-9a-f |]+", 24)
            path = self.file("roof.hex", "\n".join(lines) + "\n")
            decoded = run("decode", "modbus:" + RENKE, path, "--hex", "--refused")
            self.assertEqual(decoded.returncode, 0, decoded.stderr)
            readings = [json.loads(line) for line in decoded.stdout.splitlines()]
            self.assertGreater(len(readings), 4, watch.text())
            # It may begin between a request and its answer, which then says nothing.
            self.assertEqual([reading for reading in readings[1:] if "refused" in reading], [])
            readings = [reading for reading in readings if "refused" not in reading]
            speeds = [reading["speed_m_s"] for reading in readings if reading["speed_m_s"] is not None]
            directions = [reading["direction_deg"] for reading in readings if reading["direction_deg"] is not None]
            self.assertTrue(speeds and directions)
            self.assertTrue(all(0.0 <= speed < 30.0 for speed in speeds), speeds)
            self.assertTrue(all(direction % 1.0 == 0.0 for direction in directions), directions)

    def test_a_log_at_the_end_accounts_for_every_sensor(self):
        config = self.modbus_config(self.start_simulator().address())
        daemon = self.start_daemon("--config", config)
        with Stream(daemon.address(), poses=False) as stream:
            stream.wait_for_sensor(lambda sensor: sensor.Readings() >= 5)
        self.assertEqual(daemon.end(), 0, daemon.text())
        told = re.search(r"sensor roof: (\d+) readings from (\d+) frames, 0 reconnects; refused: nothing", daemon.text())
        self.assertTrue(told, daemon.text())
        self.assertGreaterEqual(int(told.group(1)), 5)
        self.assertGreaterEqual(int(told.group(2)), 2 * int(told.group(1)) - 1, "a speed and a direction make a reading")

    # What USB devices are decoded with, and what the driver calls them: (simulator, device, format, options).
    USB_DEVICES = (
        ("hid", "wmr100", "wmr100", ["--reports"]),
        ("hid", "wmr300", "wmr300", []),
        ("hid", "fineoffset", "fineoffset", ["--reports"]),
        ("hid", "acurite", "acurite", []),
        ("hid", "te923", "te923", ["--reports"]),
        ("usb", "mcc1208", "mcc1208", ["--slope", "0.1", "--interval", "0.1", "--vane-reference", "5"]),
        ("usb", "labjack-u3", "labjack", ["--slope", "0.1", "--interval", "0.1", "--input", "high-voltage",
                                          "--vane-reference", "5"]),
    )

    def test_raw_messages_of_every_usb_device_are_what_decode_reads(self):
        watched = []
        for driver, device, kind, options in self.USB_DEVICES:
            key = "station" if driver == "hid" else "device"
            pace = ["--pace", "20"] if driver == "hid" else []
            config = self.file(device + ".toml", f'[[sensor]]\nname = "roof"\ndriver = "{driver}"\n{key} = "{device}"\n'
                               + ("pace = 20\n" if pace else ""))
            watch = self.start(SIMULATOR, driver, "--device", device, *pace, "--speed", "6", "--umockdev", "--", YURAGI,
                               "sensors", "watch", "--raw", "roof", "--hex", "--config", config,
                               "--connect", self.free_address())
            watched.append((device, kind, options, watch))
        for device, kind, options, watch in watched:
            with self.subTest(device=device):
                def decoded_so_far(text):
                    lines = re.findall(r"(?m)^([0-9a-f |]+)\n", text)
                    decoded = run("decode", kind, self.file(device + ".hex", "\n".join(lines) + "\n"), "--hex", *options)
                    readings = [json.loads(line) for line in decoded.stdout.splitlines()] if lines else []
                    speeds = [reading["speed_m_s"] for reading in readings if reading["speed_m_s"] is not None]
                    directions = [reading["direction_deg"] for reading in readings if reading["direction_deg"] is not None]
                    return speeds and directions and (decoded, speeds, directions)

                found = watch.wait_until(decoded_so_far)
                self.assertTrue(found, watch.text())
                decoded, speeds, directions = found
                self.assertEqual(decoded.returncode, 0, decoded.stderr)
                watch.end(signal.SIGINT)
                self.assertTrue(all(0.0 < speed < 20.0 for speed in speeds), speeds)
                self.assertTrue(all(200.0 < direction < 280.0 for direction in directions), directions)

    # ---- sensors list, sensors describe ----

    def test_list_finds_what_is_plugged_in_and_prints_a_configuration_of_it(self):
        for driver, devices in (("hid", ("wmr100", "te923")), ("usb", ("mcc1208", "labjack-u3"))):
            simulated = [word for device in devices for word in ("--device", device)]
            done = subprocess.run([SIMULATOR, driver, *simulated, "--umockdev", "--", YURAGI, "sensors", "list"],
                                  capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            toml = "\n".join(line[4:] for line in done.stdout.splitlines() if line.startswith("    "))
            for device in devices:
                self.assertIn(f'"{device}"', toml, done.stdout)
            found = run("check-config", self.file(driver + ".toml", toml))
            self.assertEqual(found.returncode, 0, found.stderr + toml)
            self.assertIn(f"sensor {driver}-2 ({driver})", found.stdout)

    def test_list_looks_and_tells(self):
        done = run("sensors", "list")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"No device found|\[\[sensor\]\]")
        self.assertIn("Not searched for: ", done.stdout)

    def test_describe_lists_the_drivers_and_tells_the_keys_of_one(self):
        names = [line.split()[0] for line in run("sensors", "describe").stdout.splitlines() if line and line[0].isalpha()]
        self.assertIn("synthetic", names)
        page = run("sensors", "describe", "--all").stdout
        for name in names:
            described = run("sensors", "describe", name)
            self.assertEqual(described.returncode, 0)
            self.assertIn(f'driver = "{name}"', described.stdout)
            self.assertIn(f"\n## {name}\n", page)
        unknown = run("sensors", "describe", "barometer")
        self.assertEqual(unknown.returncode, 64)
        self.assertIn("synthetic", unknown.stderr)

    # ---- scenes ----

    TWO_SCENES = """
[stream]
control = "{control}"
[[scene]]
kind = "grass"
name = "meadow"
blades_across = 20
blades_deep = 20
[[scene]]
kind = "grass"
name = "bank"
blades_across = 10
blades_deep = 10
x = 12
shown = false
"""

    def start_two_scenes(self, control="loopback"):
        daemon = self.start_daemon("--config", self.file("two.toml", self.TWO_SCENES.format(control=control)))
        return daemon.address()

    def test_a_switch_cross_fades_two_scenes_without_a_jump(self):
        address = self.start_two_scenes()
        over_s = 1.0
        with Stream(address, sensors=False) as stream:
            frame = stream.next("Frame")
            self.assertEqual([frame.Scenes(i).Opacity() for i in range(2)], [1.0, 0.0])
            self.assertIsNone(pose_client.read_pose(frame.Scenes(1)), "what is hidden is not sent")
            self.assertLess(abs(float(stream.scenes[1][2].root_m[:, 0].mean()) - 12.0), 0.2)

            done = run("scene", "switch", "bank", "--fade", over_s, "--connect", address)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("bank is shown", done.stdout)

            seen, last, hidden_tick = [], None, frame.Tick()
            deadline = time.monotonic() + HANG_S
            while time.monotonic() < deadline:
                frame = stream.next("Frame")
                meadow, bank = (frame.Scenes(i).Opacity() for i in range(2))
                self.assertAlmostEqual(meadow + bank, 1.0, 5)
                if last is not None:
                    ticks = frame.Tick() - last[0]
                    self.assertLessEqual(abs(bank - last[1]), 1.5 * ticks / (60.0 * over_s) + 1e-6)
                if 0.0 < bank < 1.0:
                    seen.append(bank)
                elif bank == 0.0:
                    hidden_tick = frame.Tick()
                last = (frame.Tick(), bank)
                if bank == 1.0:
                    break
            self.assertEqual(last[1], 1.0)
            self.assertTrue(seen)
            self.assertGreater(last[0] - hidden_tick, 30, "it takes its second")
            self.assertEqual(seen, sorted(seen))
            self.assertIsNone(pose_client.read_pose(frame.Scenes(0)))

        listed = run("scene", "list", "--connect", address).stdout
        self.assertRegex(listed, r"meadow\s+grass\s+hidden")
        self.assertRegex(listed, r"bank\s+grass\s+shown")

    def test_a_scene_is_hidden_and_shown_and_mistakes_are_told(self):
        address = self.start_two_scenes()
        self.assertEqual(run("scene", "show", "bank", "--fade", 0, "--connect", address).returncode, 0)
        self.assertEqual(run("scene", "hide", "meadow", "--fade", 0, "--connect", address).returncode, 0)
        with Stream(address, sensors=False) as stream:
            opacities = None
            for _ in range(60):
                frame = stream.next("Frame")
                opacities = [frame.Scenes(i).Opacity() for i in range(2)]
                if opacities == [0.0, 1.0]:
                    break
            self.assertEqual(opacities, [0.0, 1.0])

        unknown = run("scene", "show", "forest", "--connect", address)
        self.assertEqual(unknown.returncode, 64)
        self.assertIn("meadow, bank", unknown.stderr)
        self.assertEqual(run("scene", "show", "bank", "--fade", -1, "--connect", address).returncode, 64)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            nobody = run("scene", "list", "--connect", f"127.0.0.1:{free.getsockname()[1]}")
        self.assertEqual(nobody.returncode, 69)

    def test_where_nobody_may_switch_scenes_it_is_refused_with_77(self):
        address = self.start_two_scenes(control="nobody")
        refused = run("scene", "hide", "meadow", "--connect", address)
        self.assertEqual(refused.returncode, 77)
        self.assertIn("control", refused.stderr)
        self.assertRegex(run("scene", "list", "--connect", address).stdout, r"meadow\s+grass\s+shown")

    def test_every_example_installation_is_right(self):
        project = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
        examples = [os.path.join(folder, name) for folder in (os.path.join(project, "config"), os.path.join(project, "config/rehearsals"))
                    for name in sorted(os.listdir(folder))]
        examples = [path for path in examples if path.endswith(".toml") and not path.endswith(".scenario.toml")]
        self.assertTrue(examples)
        for path in examples:
            done = run("check-config", path)
            self.assertEqual(done.returncode, 0, done.stderr)

    # ---- clients ----

    def address_as_of_another_machine(self, daemon):
        """The address of a daemon that listens on 0.0.0.0, by which its own clients are not on the loopback interface."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as route:
            try:
                route.connect(("192.0.2.1", 9))  # sends nothing
            except OSError:
                self.skipTest("this machine has no address but the loopback's")
            own = route.getsockname()[0]
        if own.startswith("127."):
            self.skipTest("this machine has no address but the loopback's")
        return own + ":" + daemon.address().split(":")[-1]

    def test_another_machine_is_told_the_names_of_files_only(self):
        log = self.recording([5.0] * 100)
        daemon = self.start(YURAGI, "replay", log, "--loop", "--listen", "0.0.0.0:0")
        remote = self.address_as_of_another_machine(daemon)
        local = "127.0.0.1:" + remote.split(":")[-1]
        for address, detail in ((remote, "playing " + os.path.basename(log)), (local, "playing " + log)):
            with Stream(address, poses=False) as stream:
                sensor = stream.wait_for_sensor(lambda sensor: sensor.Detail().startswith(b"playing"))
                self.assertEqual(sensor.Detail().decode(), detail)

    def test_idle_clients_of_another_machine_take_no_place_of_this_one(self):
        daemon = self.start(YURAGI, "run", "--listen", "0.0.0.0:0")
        remote = self.address_as_of_another_machine(daemon)
        local = "127.0.0.1:" + remote.split(":")[-1]
        refused = 0
        clients = []
        for _ in range(40):
            clients.append(pose_client.SocketBytes(remote, HANG_S))
            clients[-1].send(pose_client.subscribe_message(poses=False, sensors=False, client="idle"))
            _, hello = pose_client.body_of(next(pose_client.messages(clients[-1]))[0])
            refused += hello.Refused() is not None
        self.assertEqual(refused, 32)
        table = run("sensors", "watch", "--connect", local, "--once")
        self.assertEqual(table.returncode, 0, table.stderr)
        self.assertRegex(table.stdout, r"since the start: clients refused \d+, stuck 0, idle 0; "
                         r"late in the last 10 min \(p50, p99, most\): I/O .* ms; ticks .* ms\n")
        for client in clients:
            client.socket.close()

    def test_status_has_an_answer_however_many_clients_there_are(self):
        address = self.start_daemon().address()
        clients = []
        for _ in range(32):
            clients.append(pose_client.SocketBytes(address, HANG_S))
            clients[-1].send(pose_client.subscribe_message(poses=False, sensors=True, client="many"))
            self.assertIsNone(pose_client.body_of(next(pose_client.messages(clients[-1]))[0])[1].Refused())
        running_s = 0
        while running_s == 0:  # the first status is of the time before the first tick
            status = json.loads(run("status", "--connect", address, "--json").stdout)
            self.assertIn(status["verdict"], ("well", "attention"))
            running_s = status["animation"]["running_s"]
        self.assertGreater(status["animation"]["scenes"][0]["tick_s"], 0)
        self.assertGreater(status["animation"]["tick_s"], status["animation"]["scenes"][0]["tick_s"])
        for client in clients:
            client.socket.close()

    def test_raw_messages_are_for_those_who_may_control(self):
        address = self.start_two_scenes(control="nobody")
        refused = run("sensors", "watch", "--raw", "--connect", address)
        self.assertEqual(refused.returncode, 69)
        self.assertIn("raw messages cannot be watched: the configuration has [stream] control", refused.stderr)
        self.assertEqual(run("sensors", "watch", "--once", "--connect", address).returncode, 0)

    def test_a_client_that_stands_still_holds_up_nobody_and_is_let_go(self):
        daemon = self.start_daemon()
        address = daemon.address()
        with Program(sys.executable, pose_client.__file__, "--connect", address, "--schema", SCHEMA_MODULES) as stuck:
            stuck.wait_for(r"\d+ frames, ")
            stuck.process.send_signal(signal.SIGSTOP)
            try:
                with Stream(address, sensors=False) as healthy:
                    first = healthy.next("Frame")
                    memory_kib = resident_kib(daemon)
                    last = first
                    largest_gap = 0
                    while last.Sequence() < first.Sequence() + 60 * 12:
                        before = last.Sequence()
                        last = healthy.next("Frame")
                        largest_gap = max(largest_gap, last.Sequence() - before)
                    self.assertLess(largest_gap, 60 * 3, "the other client gets its frames, and is never held up for long")
                    self.assertLess(resident_kib(daemon) - memory_kib, 8 * 1024)
                daemon.wait_for(r"(?i)(dropped|let go|stuck|stopped reading)")
            finally:
                stuck.process.send_signal(signal.SIGCONT)


if __name__ == "__main__":
    pose_client.load_schema(SCHEMA_MODULES)
    unittest.main(verbosity=2)
