#!/usr/bin/env python3
"""Lamps, fans and LED walls: a daemon with [[dmx]] beside a receiver of E1.31 and of Art-Net, which ends in all the ways there are.

usage: dmx_test.py FOLDER_OF_PROGRAMS
"""
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from programs import HANG_S, Program

YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")

WIND = '[[sensor]]\ndriver = "synthetic"\nspeed = 6.0\nturbulence = 0.3\nrate = 20\n'
FAN = '[[dmx.channel]]\nchannel = 2\nvalue = "speed"\nfrom = "0 12"\nrest = 17\n'


class Packet:
    """An E1.31 data packet: what a receiver reads of it (ANSI E1.31-2018, table 4-1)."""

    def __init__(self, data):
        self.cid = data[22:38]
        self.source = data[44:108].rstrip(b"\0").decode()
        self.priority, self.sequence = data[108], data[111]
        self.is_terminated = bool(data[112] & 0x40)
        self.universe = int.from_bytes(data[113:115], "big")
        self.levels = data[126:]
        assert data[4:13] == b"ASC-E1.17" and len(self.levels) == 512


class Lamp:
    """Does with each packet what E1.31 6.7 asks of a receiver."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(HANG_S)
        self.port = self.socket.getsockname()[1]
        self.sequence = None
        self.discarded = 0

    def close(self):
        self.socket.close()

    def data(self):
        return self.socket.recv(65536)

    def packet(self):
        """The next that is not discarded."""
        while True:
            packet = Packet(self.data())
            if self.sequence is not None and -20 < (packet.sequence - self.sequence + 128) % 256 - 128 <= 0:
                self.discarded += 1
                continue
            self.sequence = None if packet.is_terminated else packet.sequence
            return packet

    def until_terminated(self):
        packets = [self.packet()]
        while not packets[-1].is_terminated:
            packets.append(self.packet())
        return packets


class Dmx(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="yuragi-dmx-")
        self.addCleanup(self.folder.cleanup)
        self.config = pathlib.Path(self.folder.name) / "wall.toml"
        self.lamp = Lamp()
        self.addCleanup(self.lamp.close)

    def start(self, text):
        self.config.write_text('[stream]\nlisten = "127.0.0.1:0"\n' + text, encoding="utf-8")
        program = Program(YURAGI, "run", "--config", self.config)
        self.addCleanup(program.__exit__)
        return program

    def fan(self, more=""):
        return f'[[dmx]]\nname = "fan"\nto = "127.0.0.1:{self.lamp.port}"\n{more}' + FAN

    def rest(self):
        return subprocess.run([YURAGI, "feeds", "rest", "--config", self.config], capture_output=True, text=True,
                              timeout=HANG_S, check=False)

    def test_a_fan_follows_the_wind_and_rests_when_the_daemon_ends(self):
        daemon = self.start(WIND + self.fan("universe = 300\npriority = 120\n"))
        levels = set()
        while len(levels) < 10:
            packet = self.lamp.packet()
            levels.add(packet.levels[1])
        self.assertEqual((packet.source, packet.priority, packet.universe), ("Yuragi fan", 120, 300))
        self.assertEqual(sum(packet.levels), packet.levels[1])
        self.assertEqual(daemon.end(), 0)
        packets = self.lamp.until_terminated()
        self.assertEqual([one.levels[1] for one in packets[-4:]], [17] * 4)

    def test_a_fan_rests_after_a_crash_by_the_subcommand(self):
        daemon = self.start(WIND + self.fan())
        before = self.lamp.packet()
        daemon.process.send_signal(signal.SIGKILL)
        daemon.process.wait(HANG_S)
        self.lamp.socket.setblocking(False)
        try:
            while True:
                before = self.lamp.packet()
        except BlockingIOError:
            self.assertNotEqual(before.levels[1], 17, "it holds the last level")
        self.lamp.socket.settimeout(HANG_S)
        done = self.rest()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout, f"fan: at rest (127.0.0.1:{self.lamp.port})\n")
        after = self.lamp.until_terminated()
        self.assertEqual({one.levels[1] for one in after}, {17})
        self.assertEqual({one.cid for one in after}, {before.cid}, "for receivers it is the same source")

    def test_a_receiver_that_just_got_the_same_sequence_numbers_rests(self):
        self.config.write_text(self.fan(), encoding="utf-8")
        self.lamp.sequence = 20  # the worst that can be
        self.assertEqual(self.rest().returncode, 0)
        self.assertEqual(self.lamp.packet().levels[1], 17)
        self.assertEqual(self.lamp.discarded, 19 + 1)

    def test_what_cannot_be_reached_is_reported(self):
        self.config.write_text(self.fan(), encoding="utf-8")
        self.lamp.close()
        done = self.rest()
        self.assertEqual(done.returncode, 69)
        self.assertIn(f"yuragi: fan: nothing listens at 127.0.0.1:{self.lamp.port}", done.stderr)
        self.config.write_text("", encoding="utf-8")
        self.assertEqual(self.rest().returncode, 0)

    def test_a_reload_of_the_feed_ends_it_and_begins_it_anew(self):
        daemon = self.start(WIND + self.fan())
        self.lamp.packet()
        self.config.write_text(self.config.read_text(encoding="utf-8").replace("rest = 17", "rest = 18"), encoding="utf-8")
        daemon.process.send_signal(signal.SIGHUP)
        self.assertEqual(self.lamp.until_terminated()[-1].levels[1], 17)
        while self.lamp.packet().is_terminated:
            pass
        self.assertEqual(daemon.end(), 0)
        self.assertEqual(self.lamp.until_terminated()[-1].levels[1], 18)

    def test_a_wall_of_pixels_shows_the_gusts_in_several_universes(self):
        self.start(WIND + f'[[dmx]]\nto = "127.0.0.1:{self.lamp.port}"\n'
                   '[[dmx.grid]]\ncolumns = 32\nrows = 8\nspacing = 5\nto = "#000000 #00ff00"\nfrom = "0 12"\n')
        end = time.monotonic() + HANG_S
        seen = {}
        while time.monotonic() < end:
            packet = Packet(self.lamp.data())
            seen[packet.universe] = packet.levels
            if set(seen) == {1, 2} and all(len(set(levels[1::3])) > 5 for levels in seen.values()):
                break
        self.assertEqual(set(seen), {1, 2})
        self.assertEqual(sum(seen[1][0:510:3]) + sum(seen[1][2:510:3]), 0, "green alone")
        self.assertGreater(len(set(seen[1][1:510:3])), 5, "the wind is not the same everywhere")
        self.assertEqual(sum(seen[2][(256 - 170) * 3:]), 0, "no pixels beyond the last")

    def test_art_net(self):
        daemon = self.start(WIND + self.fan('protocol = "artnet"\nuniverse = 258\n'))
        data = self.lamp.data()
        self.assertEqual((data[:12], data[14:18], len(data)), (b"Art-Net\0\0\x50\0\x0e", b"\x02\x01\x02\x00", 530))
        self.assertEqual(daemon.end(), 0)
        self.lamp.socket.setblocking(False)
        try:
            while True:
                data = self.lamp.data()
        except BlockingIOError:
            self.assertEqual(data[19], 17)


if __name__ == "__main__":
    unittest.main()
