#!/usr/bin/env python3
"""What the feeds of one daemon send, how long a step at the sensor takes to each of them, and what all of them cost.

usage: feeds_bench.py FOLDER_OF_PROGRAMS [--steps N] [--seconds N]

The sensor is a program that sends OSC. Its wind steps between 3 and 9 m/s; of each step the delay to a feed is the time until the
feed's speed has passed the middle. For the costs the daemon runs with all feeds and without any, twice in turn.
"""
import argparse
import base64
import json
import os
import pathlib
import re
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "tests" / "e2e"), str(ROOT / "config" / "examples")]
from programs import Program, free_port  # noqa: E402
import yuragi_client  # noqa: E402

LOW_M_S, HIGH_M_S, STEP_S, SENSOR_HZ = 3.0, 9.0, 2.0, 60.0
MIDDLE_M_S = (LOW_M_S + HIGH_M_S) / 2
DMX_MAX_M_S = 12.0
PING, PONG = 9, 10  # of a WebSocket's frames


def osc(address, *numbers):
    def padded(data):
        return data + b"\0" * (4 - len(data) % 4)
    return padded(address.encode()) + padded(b"," + b"f" * len(numbers)) + struct.pack(f">{len(numbers)}f", *numbers)


def datagrams(port):
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.bind(("127.0.0.1", port))
    while True:
        yield receiver.recv(65536)


def exactly(connection, count):
    data = b""
    while len(data) < count:
        block = connection.recv(count - len(data))
        if not block:
            raise ConnectionError("closed")
        data += block
    return data


def web_socket(port, path, wish):
    """The payloads of a WebSocket's frames, for ever."""
    connection = socket.create_connection(("127.0.0.1", port))
    key = base64.b64encode(os.urandom(16)).decode()
    connection.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                       f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n".encode())
    head = b""
    while not head.endswith(b"\r\n\r\n"):
        head += connection.recv(1)
    text = json.dumps(wish).encode()
    connection.sendall(bytes([0x81, 0x80 | len(text)]) + bytes(4) + text)
    while True:
        kind, length = exactly(connection, 2)
        if length == 126:
            length = struct.unpack(">H", exactly(connection, 2))[0]
        elif length == 127:
            length = struct.unpack(">Q", exactly(connection, 8))[0]
        payload = exactly(connection, length)
        if kind & 0x0F == PING:
            connection.sendall(bytes([0x80 | PONG, 0x80 | length]) + bytes(4) + payload)
        else:
            yield payload


class Feed:
    """One way by which the wind leaves: reads its speeds, and remembers when each has come."""

    def __init__(self, name, speeds):
        self.name, self.speeds = name, []
        self.thread = threading.Thread(target=self.read, args=(speeds,), daemon=True)
        self.thread.start()

    def read(self, speeds):
        try:
            for speed in speeds:
                self.speeds.append((time.monotonic(), speed))
        except (ConnectionError, OSError, yuragi_client.Refused):
            pass  # the daemon has ended

    def delay_s(self, at, is_up):
        """From a step at that time; None: it has not come before the next one."""
        for time_s, speed in self.speeds:
            if at < time_s < at + STEP_S and (speed > MIDDLE_M_S) == is_up:
                return time_s - at
        return None


class Ports:
    def __init__(self):
        self.sensor, self.osc, self.mapped, self.sacn, self.artnet, self.nmea = (
            free_port(socket.SOCK_DGRAM) for _ in range(6))
        self.http, self.osc_query, self.broker = (free_port() for _ in range(3))


def sensor_text(ports):
    return (f'[stream]\nlisten = "127.0.0.1:0"\n[[sensor]]\ndriver = "osc"\nname = "roof"\nport = {ports.sensor}\n'
            f'[http]\nlisten = "127.0.0.1:{ports.http}"\n')


def feeds_text(ports):
    channel = f'[[dmx.channel]]\nchannel = 1\nvalue = "speed"\nfrom = "0 {DMX_MAX_M_S}"\nto = "0 255"\n'
    return (f'[[place]]\nname = "door"\nx = 3.0\nz = -1.5\n[[osc]]\nname = "osc"\nto = "127.0.0.1:{ports.osc}"\n'
            f'[[osc]]\nname = "mapped"\nto = "127.0.0.1:{ports.mapped}"\nsend = "mapped"\n[[osc.map]]\nvalue = "speed"\n'
            f'address = "/layer"\nfrom = "0 30"\nto = "0 30"\n'
            f'[[dmx]]\nname = "sacn"\nuniverse = 1\nto = "127.0.0.1:{ports.sacn}"\n{channel}'
            '[[dmx.grid]]\nchannel = 10\ncolumns = 32\nrows = 32\nspacing = 0.5\nfrom = "0 12"\nto = "#000010 #ffffff"\n'
            f'[[dmx]]\nname = "artnet"\nprotocol = "artnet"\nuniverse = 1\nto = "127.0.0.1:{ports.artnet}"\n{channel}'
            f'[mqtt]\nhost = "127.0.0.1"\nport = {ports.broker}\ntopic = "y"\nevery = 1\nfast = 20\n'
            f'[[nmea]]\nto = "127.0.0.1:{ports.nmea}"\nrate = 10\n[osc_query]\nlisten = "127.0.0.1:{ports.osc_query}"\n')


def osc_values(data, address):
    """The first number of each message of that address in a bundle."""
    name = address.encode() + b"\0"
    at = data.find(name)
    if at >= 0:
        after = at + len(name) + -(len(name)) % 4
        yield struct.unpack_from(">f", data, data.index(b",f", after) + 4)[0]


def read_mqtt(port):
    # It ends with the daemon's last will.
    reader = subprocess.Popen(["mosquitto_sub", "-h", "127.0.0.1", "-p", str(port), "-t", "y/fast", "-t", "y/status"],
                              stdout=subprocess.PIPE, text=True)
    for line in reader.stdout:
        if line.strip() == "offline":
            reader.terminate()
        elif line.strip() != "online":
            yield json.loads(line)["speed_m_s"]


def all_feeds(ports, address):
    def stream():
        for frame in yuragi_client.Client(address, wind=True).frames():
            yield yuragi_client.speed_m_s(frame.wind)

    def nmea():
        for data in datagrams(ports.nmea):
            yield from (float(speed) for speed in re.findall(r"MWV,[0-9.]+,T,([0-9.]+),M", data.decode()))
    return [
        Feed("stream, wind alone", stream()),
        Feed("/ws", (json.loads(text)["wind"]["speed"] for text in web_socket(ports.http, "/ws", {"wind": 60}))),
        Feed("[[osc]]", (value for data in datagrams(ports.osc) for value in osc_values(data, "/wind/speed"))),
        Feed("[[osc.map]]", (value for data in datagrams(ports.mapped) for value in osc_values(data, "/layer"))),
        Feed("[osc_query]", (struct.unpack(">f", data[-4:])[0] for data in web_socket(
            ports.osc_query, "/", {"COMMAND": "LISTEN", "DATA": "/wind/speed"}))),
        Feed("sACN", (data[126] * DMX_MAX_M_S / 255 for data in datagrams(ports.sacn) if data[113:115] == b"\0\1")),
        Feed("Art-Net", (data[18] * DMX_MAX_M_S / 255 for data in datagrams(ports.artnet))),
        Feed("[mqtt], fast = 20", read_mqtt(ports.broker)),
        Feed("[[nmea]], rate = 10", nmea()),
    ]


class Sensor(threading.Thread):
    """Sends a wind that steps; remembers when and where to."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port, self.steps, self.is_ending = port, [], False

    def run(self):
        sender, begun, is_up = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), time.monotonic(), False
        while not self.is_ending:
            now = time.monotonic()
            should_be_up = int((now - begun) / STEP_S) % 2 == 1
            if should_be_up != is_up:
                is_up = should_be_up
                self.steps.append((now, is_up))
            sender.sendto(osc("/wind", HIGH_M_S if is_up else LOW_M_S, 270.0), ("127.0.0.1", self.port))
            time.sleep(1.0 / SENSOR_HZ)


def start_daemon(yuragi, folder, text):
    config = pathlib.Path(folder) / "wall.toml"
    config.write_text(text, encoding="utf-8")
    daemon = Program(yuragi, "run", "--config", config)
    return daemon, daemon.address()


def cpu_s(daemon):
    fields = pathlib.Path(f"/proc/{daemon.process.pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def status(yuragi, address):
    return json.loads(subprocess.run([yuragi, "status", "--json", "--connect", address], capture_output=True, check=False).stdout)


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def measure_delays(yuragi, folder, ports, steps):
    sensor = Sensor(ports.sensor)
    sensor.start()
    daemon, address = start_daemon(yuragi, folder, sensor_text(ports) + feeds_text(ports))
    daemon.wait_for("roof.*live")
    feeds = all_feeds(ports, address)
    seconds = (steps + 2) * STEP_S
    time.sleep(seconds)
    state = status(yuragi, address)
    row("feed", "messages/s", "delay of a step: p50, ms", "p95, ms", "steps")
    row("---", "---", "---", "---", "---")
    for feed in feeds:
        begun = feed.speeds[0][0]
        delays = sorted(delay for at, is_up in sensor.steps if at > begun + STEP_S
                        for delay in [feed.delay_s(at, is_up)] if delay is not None)
        rate_hz = (len(feed.speeds) - 1) / (feed.speeds[-1][0] - begun)
        row(feed.name, f"{rate_hz:.1f}", f"{1e3 * statistics.median(delays):.1f}", f"{1e3 * delays[int(0.95 * len(delays))]:.1f}",
            len(delays))
    print()
    row("feed", "to", "sends", "messages/s", "bytes/s")
    row("---", "---", "---", "---", "---")
    for feed in state["feeds"]:
        row(feed["kind"], feed["target"], feed["sends"], f"{feed['messages'] / seconds:.0f}", f"{feed['bytes'] / seconds:.0f}")
    daemon.end()
    sensor.is_ending = True


def measure_costs(yuragi, folder, ports, seconds):
    print()
    row("feeds", "lateness of ticks: p50, ms", "p99, ms", "skipped", "CPU s")
    row("---", "---", "---", "---", "---")
    for name, text in 2 * [("none", ""), ("all", feeds_text(ports))]:
        sensor = Sensor(ports.sensor)
        sensor.start()
        daemon, address = start_daemon(yuragi, folder, sensor_text(ports) + text)
        feeds = all_feeds(ports, address) if text else []
        time.sleep(seconds)
        state = status(yuragi, address)
        lateness = state["tick_lateness"]
        row(name, f"{1e3 * lateness['p50_s']:.2f}", f"{1e3 * lateness['p99_s']:.2f}", state["recent_skipped_ticks"], f"{cpu_s(daemon):.2f}")
        daemon.end()
        sensor.is_ending = True
        del feeds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs")
    parser.add_argument("--steps", type=int, default=60)
    parser.add_argument("--seconds", type=float, default=20.0)
    options = parser.parse_args()
    yuragi = os.path.join(os.path.abspath(options.programs), "yuragi")
    with tempfile.TemporaryDirectory(prefix="yuragi-feeds-bench-") as folder:
        ports = Ports()
        broker = Program("mosquitto", "-p", ports.broker)
        try:
            measure_delays(yuragi, folder, ports, options.steps)
            measure_costs(yuragi, folder, ports, options.seconds)
        finally:
            broker.end()


if __name__ == "__main__":
    main()
