#!/usr/bin/env python3
"""The wind for other programs: a daemon with [[osc]] and [osc_query], beside oscdump of liblo, another daemon,
an OSCQuery client of npm, and a receiver that goes away.

usage: feeds_test.py FOLDER_OF_PROGRAMS
"""
import json
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from programs import HANG_S, Program, free_port

YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "config" / "examples"))
import yuragi_client  # noqa: E402

GRASS = '[[scene]]\nname = "meadow"\nkind = "grass"\nblades_across = 8\nblades_deep = 8\n'
SENSOR = '[[sensor]]\nname = "a b/\u00fc"\ndriver = "synthetic"\nspeed = 6.0\nturbulence = 0.3\nrate = 20\n'
PLACE = '[[place]]\nname = "door"\nx = 3.0\nz = -1.5\n'


def padded(data):
    return data + b"\0" * (-len(data) % 4)


def osc_message(address, *numbers):
    tags = "," + "f" * len(numbers)
    return padded(address.encode() + b"\0") + padded(tags.encode() + b"\0") + struct.pack(f">{len(numbers)}f", *numbers)


def messages_of(datagram):
    """The messages of a bundle, or the one: address and arguments."""
    if datagram.startswith(b"#bundle\0"):
        offset, found = 16, []
        while offset < len(datagram):
            size = struct.unpack_from(">I", datagram, offset)[0]
            found += messages_of(datagram[offset + 4:offset + 4 + size])
            offset += 4 + size
        return found
    end = datagram.index(b"\0")
    tags_at = end + 4 - end % 4
    tags_end = datagram.index(b"\0", tags_at)
    at = tags_end + 4 - tags_end % 4
    tags = datagram[tags_at + 1:tags_end].decode()
    if tags == "s":
        return [(datagram[:end].decode(), (datagram[at:datagram.index(b"\0", at)].decode(),))]
    return [(datagram[:end].decode(), struct.unpack_from(f">{len(tags)}f", datagram, at))]


class Receiver:
    """A program that listens at a port of this machine."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(HANG_S)
        self.port = self.socket.getsockname()[1]

    def messages(self):
        """One after the other, for ever."""
        while True:
            yield from messages_of(self.socket.recv(65536))

    def close(self):
        self.socket.close()


class FeedsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix="yuragi-feeds-")
        self.addCleanup(self.folder.cleanup)

    def start(self, *command):
        program = Program(*command)
        self.addCleanup(program.__exit__)
        return program

    def start_daemon(self, text, name="wall.toml"):
        self.config = pathlib.Path(self.folder.name) / name
        self.config.write_text('[stream]\nlisten = "127.0.0.1:0"\n' + text, encoding="utf-8")
        return self.start(YURAGI, "run", "--config", self.config)

    def receiver(self):
        receiver = Receiver()
        self.addCleanup(receiver.close)
        return receiver

    def status(self, daemon):
        done = subprocess.run([YURAGI, "status", "--json", "--connect", daemon.address()], capture_output=True,
                              timeout=HANG_S, check=False)
        return json.loads(done.stdout)

    def wait_for_status(self, daemon, is_found):
        end = time.monotonic() + HANG_S
        while time.monotonic() < end:
            status = self.status(daemon)
            if is_found(status):
                return status
            time.sleep(0.2)
        self.fail(f"not found in {status}")

    def test_oscdump_prints_every_value_by_its_address(self):
        port = free_port(socket.SOCK_DGRAM)
        dump = self.start("stdbuf", "-oL", "oscdump", port)
        daemon = self.start_daemon(SENSOR + GRASS + PLACE + f'[[osc]]\nto = "127.0.0.1:{port}"\n')
        for address in ["/wind ff", "/wind/gust_norm f", "/wind/state s", "/sensor/a_b__/speed f",
                        '/sensor/a_b__/state s "simulated"', "/place/door ff", "/place/door/peak f",
                        "/scene/meadow/opacity f 1.0"]:
            dump.wait_for(r"[0-9a-f]+\.[0-9a-f]+ " + re.escape(address))
        self.assertEqual(daemon.end(), 0)

    def test_each_tick_is_sent_and_u_and_v_are_the_direction(self):
        receiver = self.receiver()
        daemon = self.start_daemon(SENSOR + GRASS + f'[[osc]]\nto = "127.0.0.1:{receiver.port}"\nsend = "wind"\n')
        winds, parts = 0, {}
        for address, numbers in receiver.messages():
            if address == "/wind":
                if {"/wind/u", "/wind/v"} <= parts.keys():
                    u, v = parts["/wind/u"], parts["/wind/v"]
                    self.assertAlmostEqual(parts["/wind/speed"], math.hypot(u, v), places=3)
                    difference_deg = math.degrees(math.atan2(-u, -v)) - parts["/wind/direction"]
                    self.assertAlmostEqual((difference_deg + 180.0) % 360.0, 180.0, places=2)
                    winds += 1
                parts = {}
            elif address != "/wind/state":
                parts[address] = numbers[0]
            if winds == 120:
                break
        self.assertEqual(daemon.end(), 0)

    def test_another_daemon_blows_the_same_wind(self):
        port = free_port(socket.SOCK_DGRAM)
        source = self.start_daemon(
            SENSOR + GRASS + PLACE + f'[[osc]]\nto = "127.0.0.1:{port}"\nwind = "real"\n', "source.toml")
        other = self.start_daemon(
            f'[[sensor]]\nname = "far"\ndriver = "osc"\nport = {port}\n' + GRASS, "other.toml")
        other.wait_for("sensor far: live")
        # Until the other has handed over from its own wind.
        self.wait_for_status(other, lambda status: status["wind"]["source"] == "live")
        self.assertGreater(best_correlation(*self.winds_of([source, other], 900)), 0.98)
        far = self.status(other)["sensors"][0]
        self.assertEqual(far["refused"], {}, "what a daemon sends beside its wind is no mistake")

    def winds_of(self, daemons, count):
        """[(time, u, v)] of frames of each daemon, over the same time."""
        winds = [[] for _ in daemons]

        def take(daemon, taken):
            for message in yuragi_client.Client(daemon.address(), wind=True):
                if message.table_name == "Frame":
                    taken.append((message.utc_ns, message.wind.u_m_s, message.wind.v_m_s))
                if min(len(one) for one in winds) >= count:
                    return

        threads = [threading.Thread(target=take, args=pair, daemon=True) for pair in zip(daemons, winds)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(HANG_S)
        return winds

    def test_the_wind_goes_on_when_the_sensor_is_silent(self):
        receiver = self.receiver()
        port = free_port(socket.SOCK_DGRAM)
        daemon = self.start_daemon(
            f'[[sensor]]\nname = "roof"\ndriver = "osc"\nport = {port}\nsilence = 0.5\n[wind]\nhandover = 1.0\n' + GRASS +
            f'[[osc]]\nto = "127.0.0.1:{receiver.port}"\n[[osc.cue]]\nwhen = "sensor_silent"\nsensor = "roof"\n'
            'after = 2\nagain_after = 1\naddress = "/cue/silent"\n')
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(sender.close)
        was_live, is_told, speeds_after, live = False, False, [], 0.0
        for address, numbers in receiver.messages():
            if address == "/wind" and not was_live:
                sender.sendto(osc_message("/wind", 7.0, 90.0), ("127.0.0.1", port))
            if address == "/wind/live":
                live = numbers[0]
                was_live = was_live or live > 0.8
            if was_live and address == "/cue/silent":
                is_told = True
            if was_live and address == "/wind":
                self.assertTrue(all(math.isfinite(number) for number in numbers))
                speeds_after.append(numbers[0])
            if was_live and is_told and live < 0.5:
                break
        self.assertGreater(len(set(speeds_after)), 30, "it moves")
        self.assertEqual(daemon.end(), 0)

    def test_an_oscquery_client_finds_every_address_and_listens(self):
        tools = pathlib.Path(__file__).resolve().parents[2] / "build" / "browser"
        if not (tools / "node_modules" / "oscquery").is_dir() or not shutil.which("node"):
            self.skipTest("npm's oscquery is not there; config/setup.sh --test installs it")
        receiver, port = self.receiver(), free_port()
        daemon = self.start_daemon(SENSOR + GRASS + PLACE + f'[[osc]]\nto = "127.0.0.1:{receiver.port}"\n'
                                   f'[osc_query]\nlisten = "127.0.0.1:{port}"\nname = "hall"\n')
        self.wait_for_status(daemon, lambda status: any(feed["kind"] == "osc_query" and not feed["trouble"]
                                                        for feed in status["feeds"]))
        client = subprocess.Popen(["node", str(pathlib.Path(__file__).with_name("osc_query_client.mjs")), str(tools), str(port),
                                   "120", "/wind/speed"], stdout=subprocess.PIPE)
        sent = {}
        for address, arguments in receiver.messages():
            sent.setdefault(address, []).append(arguments)
            if client.poll() is not None:
                break
        found = json.loads(client.communicate(timeout=HANG_S)[0])
        self.assertEqual(client.returncode, 0)
        self.assertEqual(found["host"]["name"], "hall")
        methods = {method["path"]: method for method in found["methods"]}
        self.assertEqual(set(sent) - set(methods), set(), "what [[osc]] sends is found")
        for path, method in methods.items():
            self.assertTrue(method["description"], path)
            self.assertEqual(method["access"], 1, path)
            for argument in method["arguments"]:
                self.assertTrue("vals" in argument["range"] or argument["range"]["min"] < argument["range"]["max"], path)
        # As often as by UDP: the values of one span of time, few of them left out.
        heard = [message for data in found["messages"] for message in messages_of(bytes.fromhex(data))]
        self.assertEqual({address for address, _ in heard}, {"/wind/speed"})
        speeds = [arguments for _, arguments in heard]
        by_udp = sent["/wind/speed"]
        span = by_udp[by_udp.index(speeds[0]):by_udp.index(speeds[-1]) + 1]
        self.assertGreaterEqual(len(speeds), len(span) / 2)
        self.assertEqual([speed for speed in span if speed in set(speeds)], speeds, "in their order")
        self.assertEqual(daemon.end(), 0)

    def test_a_receiver_that_is_gone_is_one_line_of_the_log(self):
        port = free_port(socket.SOCK_DGRAM)
        daemon = self.start_daemon(SENSOR + GRASS + f'[[osc]]\nname = "lights"\nto = "127.0.0.1:{port}"\n')
        trouble = f"nothing listens at 127.0.0.1:{port}"
        status = self.wait_for_status(daemon, lambda status: status["feeds"] and status["feeds"][0]["trouble"])
        self.assertIn(trouble, status["feeds"][0]["trouble"])
        self.assertNotIn(str(port), str(status["attention"]), "a program that is not running is no fault of the daemon")
        receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(receiver.close)
        receiver.bind(("127.0.0.1", port))
        daemon.wait_for(f"feed lights: sends to 127.0.0.1:{port} again")
        self.assertEqual(daemon.text().count(trouble), 1)
        self.wait_for_status(daemon, lambda status: status["feeds"][0]["trouble"] == "")
        shown = subprocess.run([YURAGI, "status", "--connect", daemon.address()], capture_output=True, text=True,
                               timeout=HANG_S, check=False).stdout
        self.assertRegex(shown, rf"feed lights \(osc\) to 127\.0\.0\.1:{port}: wind sensors places scenes; \d+ messages")

    def test_a_reload_adds_and_ends_feeds(self):
        receiver = self.receiver()
        daemon = self.start_daemon(SENSOR + GRASS)
        self.assertEqual(self.status(daemon)["feeds"], [])
        before = self.config.read_text(encoding="utf-8")
        self.config.write_text(before + f'[[osc]]\nto = "127.0.0.1:{receiver.port}"\n', encoding="utf-8")
        daemon.process.send_signal(signal.SIGHUP)
        daemon.wait_for("osc osc: is new")
        self.assertEqual(next(receiver.messages())[0], "/wind")
        self.config.write_text(before, encoding="utf-8")
        daemon.process.send_signal(signal.SIGHUP)
        daemon.wait_for("osc osc: is gone")
        self.wait_for_status(daemon, lambda status: status["feeds"] == [])
        self.assertEqual(daemon.end(), 0)


def best_correlation(one, other):
    """Of u and v of both over their common time, at the delay up to 0.2 s at which it is largest."""
    best = -1.0
    for delay_ns in range(0, 200_000_001, 5_000_000):
        pairs, at = [], 0
        for time_ns, u, v in one:
            while at + 1 < len(other) and other[at + 1][0] <= time_ns + delay_ns:
                at += 1
            if abs(other[at][0] - time_ns - delay_ns) < 20_000_000:
                pairs += [(u, other[at][1]), (v, other[at][2])]
        if len(pairs) > len(one) / 2:
            best = max(best, correlation(pairs))
    return best


def correlation(pairs):
    xs, ys = zip(*pairs)
    mean_x, mean_y = sum(xs) / len(xs), sum(ys) / len(ys)
    products = sum((x - mean_x) * (y - mean_y) for x, y in pairs)
    return products / math.sqrt(sum((x - mean_x) ** 2 for x in xs) * sum((y - mean_y) ** 2 for y in ys))


if __name__ == "__main__":
    unittest.main()
