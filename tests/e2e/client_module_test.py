#!/usr/bin/env python3
"""The module that other programs copy, config/examples/yuragi_client.py, and its bridge to OSC, beside a running daemon.

usage: client_module_test.py FOLDER_OF_PROGRAMS
"""
import itertools
import os
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

from programs import HANG_S, Program, free_port

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "config" / "examples"
sys.path.append(str(EXAMPLES))
from yuragi_client import Client, Connection, Refused, encode, from_deg, speed_m_s  # noqa: E402

BIN = os.path.abspath(sys.argv.pop(1))
YURAGI = os.path.join(BIN, "yuragi")
SENSOR = '[[sensor]]\ndriver = "synthetic"\nname = "roof"\nspeed = 6\n'
GRASS = '[[scene]]\nkind = "grass"\nname = "grass"\nblades_across = 20\nblades_deep = 20\n'
FLAG = '[[scene]]\nkind = "flag"\nname = "elm"\nx = 3\ncolumns = 16\nrows = 24\n'


class ClientModule(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="yuragi-client-")
        self.addCleanup(folder.cleanup)
        self.config = os.path.join(folder.name, "wall.toml")

    def write(self, text):
        with open(self.config, "w", encoding="utf-8") as out:
            out.write(text)

    def start(self, *command):
        program = Program(*command)
        self.addCleanup(program.__exit__)
        return program

    def start_daemon(self, text, listen="127.0.0.1:0"):
        self.write(text)
        daemon = self.start(YURAGI, "run", "--config", self.config, "--listen", listen)
        self.address = daemon.address()
        return daemon

    def messages(self, count, **wish):
        """The first messages, and the client."""
        client = Client(self.address, **wish)
        messages = iter(client)
        self.addCleanup(messages.close)
        return list(itertools.islice(messages, count)), client

    def subscribed(self, **wish):
        """A connection that has subscribed."""
        connection = Connection(self.address, HANG_S)
        self.addCleanup(connection.close)
        connection.send(encode("Subscribe", protocol=1, takes_new_scenes=True, **wish))
        return connection

    def test_the_wind_alone_comes_with_each_frame_and_no_scenes(self):
        daemon = self.start_daemon(SENSOR + GRASS)
        messages, client = self.messages(60, wind=True, name="a lamp")
        self.assertEqual([message.table_name for message in messages], ["Hello"] + 59 * ["Frame"])
        self.assertEqual(messages[0].tick_rate_hz, 60.0)
        frames = messages[1:]
        for before, frame in zip(frames, frames[1:]):
            self.assertGreater(frame.sequence, before.sequence)
            self.assertGreater(frame.time_s, before.time_s)
            self.assertEqual(frame.scenes, [])
            self.assertLess(speed_m_s(frame.wind), 40.0)
            self.assertLessEqual(len(frame.data) + 4, 144)
        self.assertEqual(client.scenes, [])
        daemon.wait_for(r"\(a lamp\) subscribes to wind\n")
        self.assertEqual(daemon.end(), 0)

    def test_scenes_sensors_and_joints_are_read_of_what_is_asked_for(self):
        daemon = self.start_daemon(SENSOR + GRASS + FLAG)
        messages, client = self.messages(60, poses=True, sensors=True, scenes=["elm"], every=2, rate_hz=30.0)
        self.assertEqual([message.table_name for message in messages[:2]], ["Hello", "Scenes"])
        self.assertEqual([(name, kind) for name, kind, _ in client.scenes], [("elm", "flag")])
        status = next(message for message in messages if message.table_name == "Sensors")
        self.assertEqual([(sensor.name, sensor.driver) for sensor in status.sensors], [("roof", "synthetic")])
        frame = [message for message in messages if message.table_name == "Frame"][-1]
        (name, opacity, joints_m), = client.joints(frame)
        self.assertEqual((name, opacity), ("elm", 1.0))
        cloth = client.scenes[0][2]
        self.assertEqual(joints_m.shape, (cloth.columns * cloth.rows, 3))
        self.assertEqual((cloth.columns, cloth.rows), (9, 13))  # every second of 16 and 24, and the last
        self.assertLess(abs(joints_m[:, 0] - 3.0).max(), 10.0)  # the flag stands at x = 3
        self.assertEqual(daemon.end(), 0)

    def test_a_scene_that_does_not_exist_is_refused_with_those_that_exist(self):
        daemon = self.start_daemon(SENSOR + GRASS + FLAG)
        for name in ("gras", "-"):
            with self.assertRaises(Refused) as refused:
                self.messages(2, poses=True, scenes=["elm", name])
            self.assertEqual(str(refused.exception), f'there is no scene "{name}"; the scenes are: "grass", "elm"')
        program = subprocess.run([YURAGI, "scene", "list", "--connect", self.address], capture_output=True, text=True, timeout=HANG_S,
                                 check=False)
        self.assertEqual(program.returncode, 0, "others are served as before")
        self.assertEqual(daemon.end(), 0)

    def test_a_client_whose_scene_vanishes_is_let_go_with_the_reason_and_the_wind_goes_on(self):
        daemon = self.start_daemon(SENSOR + GRASS + FLAG)
        lamp = iter(self.subscribed(wind=True, poses=False))
        flag = iter(self.subscribed(scenes=["elm"], rate_hz=10.0))
        grass = iter(self.subscribed(scenes=["grass"], rate_hz=10.0))
        for stream in (lamp, flag, grass):
            next(message for message in stream if message.table_name == "Frame")
        self.write(SENSOR + GRASS)
        done = subprocess.run([YURAGI, "reload", "--connect", self.address], capture_output=True, text=True, timeout=HANG_S, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

        with self.assertRaises(Refused) as refused:
            for _ in flag:
                pass
        self.assertEqual(str(refused.exception), 'there is no scene "elm"; the scenes are: "grass"')
        last = next(lamp)
        for frame in itertools.islice(lamp, 300):
            self.assertEqual(frame.table_name, "Frame")
            last = frame
        self.assertEqual(last.scenes, [])
        next(message for message in grass if message.table_name == "Scenes")
        next(message for message in grass if message.table_name == "Frame")
        self.assertEqual(daemon.end(), 0)

    def test_it_connects_again_when_the_daemon_is_started_again(self):
        address = f"127.0.0.1:{free_port()}"
        client = Client(address, wind=True)
        messages = iter(client)
        self.addCleanup(messages.close)
        for _ in range(2):
            daemon = self.start_daemon(SENSOR + GRASS, address)
            hello = next(message for message in messages if message.table_name == "Hello")
            self.assertRegex(hello.software, "^yuragi ")
            next(message for message in messages if message.table_name == "Frame")
            self.assertEqual(daemon.end(), 0)

    def test_as_a_program_it_prints_the_wind_and_the_scenes(self):
        self.start_daemon(SENSOR + GRASS)
        printed = self.start(sys.executable, EXAMPLES / "yuragi_client.py", "--poses", self.address)
        printed.wait_for(r"scene grass \(grass\): 400 strands of \d+ links\n")
        printed.wait_for(r"wind \d+\.\d\d m/s from \d+ deg, (Live|Handover|Default)\n  grass: \d+ joints, the first at \[")
        daemon_less = self.start(sys.executable, EXAMPLES / "yuragi_client.py", f"127.0.0.1:{free_port()}")
        daemon_less.wait_for("Connection refused; trying again\n")

    def test_the_bridge_sends_the_wind_of_each_frame_by_osc(self):
        daemon = self.start_daemon(SENSOR + GRASS)
        frames = (message for message in self.subscribed(wind=True, poses=False) if message.table_name == "Frame")
        receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(receiver.close)
        receiver.bind(("127.0.0.1", 0))
        receiver.setblocking(False)
        self.start(sys.executable, EXAMPLES / "wind_to_osc.py", f"127.0.0.1:{receiver.getsockname()[1]}", self.address)
        sent, received = set(), set()
        for frame in frames:
            sent.add(struct.pack(">ff", speed_m_s(frame.wind), from_deg(frame.wind)))
            try:
                while True:
                    datagram = receiver.recv(100)
                    self.assertEqual((datagram[:12], len(datagram)), (b"/wind\0\0\0,ff\0", 20))
                    received.add(datagram[12:])
            except BlockingIOError:
                pass
            if len(sent & received) >= 60:
                break
        speeds, directions = zip(*(struct.unpack(">ff", wind) for wind in received))
        self.assertTrue(all(0.0 < speed < 40.0 for speed in speeds) and all(0.0 <= one < 360.0 for one in directions))
        self.assertEqual(daemon.end(), 0)

    def test_another_daemon_takes_the_bridge_for_a_sensor(self):
        self.start_daemon(SENSOR + GRASS)
        source, port = self.address, free_port(socket.SOCK_DGRAM)
        other = self.start_daemon(f'[[sensor]]\ndriver = "osc"\nname = "far"\nport = {port}\n' + GRASS)
        self.start(sys.executable, EXAMPLES / "wind_to_osc.py", f"127.0.0.1:{port}", source)
        other.wait_for("sensor far: live")
        self.assertEqual(other.end(), 0)


if __name__ == "__main__":
    unittest.main()
