#!/usr/bin/env python3
"""Clients that do not behave, in a process of their own: what they did is printed in JSON at the end.

usage: attackers.py FOLDER_OF_SCHEMA_MODULES KIND HOST:PORT SECONDS SEED [COUNT]

SIGTERM ends the attack early.
"""
import collections
import json
import os
import random
import resource
import select
import signal
import socket
import struct
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "e2e"))
import pose_client  # noqa: E402

MAX_CLIENT_MESSAGE_BYTES = 4096


class Attack:
    def __init__(self, address, seconds, seed, count):
        host, port = address.rsplit(":", 1)
        self.target = (host, int(port))
        self.end_s = time.monotonic() + seconds
        self.random = random.Random(seed)
        self.count = count
        self.done = collections.Counter()
        self.valid = [pose_client.subscribe_message(), pose_client.subscribe_message(poses=False, sensors=True),
                      pose_client.control_message("grass"), pose_client.control_message("", shown=False, over_s=0.0)]

    def end(self):
        self.end_s = 0.0

    def is_on(self):
        return time.monotonic() < self.end_s

    def connect(self, receive_bytes=None):
        """A connection, or None where the daemon takes none."""
        client = socket.socket()
        if receive_bytes is not None:
            client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
        client.settimeout(60.0)
        try:
            client.connect(self.target)
        except OSError:
            client.close()
            return None
        self.done["connections"] += 1
        return client

    def send(self, client, data):
        """False where the daemon has let it go."""
        try:
            client.sendall(data)
            return True
        except OSError:
            return False

    def hold(self, clients):
        """Keeps connections without a word, and counts those that the daemon has closed by then."""
        poll = select.poll()
        for client in clients:
            poll.register(client, select.POLLRDHUP)
        waiting = {client.fileno(): client for client in clients}
        is_last = False
        while waiting and not is_last:
            is_last = not self.is_on()
            for descriptor, _ in poll.poll(1000.0 if is_last else 100.0):
                poll.unregister(descriptor)
                waiting.pop(descriptor)
                self.done["let go"] += 1
        for client in clients:
            client.close()

    def several(self):
        return [client for client in (self.connect() for _ in range(self.count)) if client is not None]

    # ---- what a client can do ----

    def idle(self):
        """Connects, and never says anything."""
        self.hold(self.several())

    def half_said(self):
        """Says the first half of what it wants."""
        clients = self.several()
        for client in clients:
            self.send(client, self.valid[0][:len(self.valid[0]) // 2])
        self.hold(clients)

    def crowd(self):
        """All at once, and all want everything."""
        clients = self.several()
        for client in clients:
            self.send(client, self.valid[0])
        for client in clients:
            try:
                # The greeting, and for whom there is only a place for questions the refusal behind it.
                answers = pose_client.messages(Reader(client))
                bodies = [pose_client.body_of(next(answers)[0])]
                if bodies[0][1].Refused() is None:
                    bodies.append(pose_client.body_of(next(answers)[0]))
                refused = any(kind == "Hello" and body.Refused() is not None for kind, body in bodies)
                self.done["refused" if refused else "taken"] += 1
            except (OSError, EOFError):
                self.done["closed"] += 1
        for client in clients:
            client.close()

    def storm(self):
        """Comes and goes as fast as it can; every other one with a reset."""
        while self.is_on():
            client = self.connect()
            if client is None:
                continue
            if self.random.random() < 0.5:
                client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            if self.random.random() < 0.3:
                self.send(client, self.random.choice(self.valid))
            client.close()

    def mutated(self):
        """Messages that are nearly right."""
        self.say(lambda: self.mutation(self.random.choice(self.valid)))

    def random_bytes(self):
        self.say(lambda: self.random.randbytes(self.random.choice((1, 4, 8, 64, 1000, 5000))))

    def oversized(self):
        """A message that says it is larger than any may be."""
        self.say(lambda: struct.pack("<I", self.random.choice((MAX_CLIENT_MESSAGE_BYTES + 1, 1 << 20, 1 << 31, (1 << 32) - 1)))
                 + self.random.randbytes(200))

    def say(self, message):
        while self.is_on():
            client = self.connect()
            if client is None:
                continue
            if self.random.random() < 0.5:
                self.send(client, self.valid[0])
            for _ in range(self.random.randrange(1, 20)):
                if not self.send(client, message()):
                    break
                self.done["messages"] += 1
            client.close()

    HOSTILE_BYTES = (b"\xff", b"\x80\xc3", b"\xc0\xaf", b"\xed\xa0\x80", b"\x00", b"\r", b"\r\r", b"\x1b[2J", b"a" * 20_000)
    HTTP_PARTS = ("method", "target", "version", "host", "field name", "field", "length", "body")

    def http_bytes(self):
        """Requests of which one part has bytes that no text has, or is overlong; each on a connection of its own."""
        while self.is_on():
            part = self.random.choice(self.HTTP_PARTS)
            hostile = self.random.choice((*self.HOSTILE_BYTES, self.random.randbytes(self.random.randrange(1, 40))))
            def at(name, usual):
                return usual[:len(usual) // 2] + hostile + usual[len(usual) // 2:] if name == part else usual
            body = at("body", b'{"scene": "meadow"}')
            request = b"\r\n".join((
                at("method", self.random.choice((b"GET", b"POST"))) + b" "
                + at("target", self.random.choice((b"/", b"/api/v1/scenes", b"/api/v1/pair", b"/data/report/?windspeedmph=1")))
                + b" " + at("version", b"HTTP/1.1"),
                b"Host: " + at("host", b"127.0.0.1"),
                at("field name", b"Authorization") + b": Bearer " + at("field", b"abc"),
                b"Content-Type: application/json",
                b"Content-Length: " + at("length", str(len(body)).encode()),
                b"", body))
            client = self.connect()
            if client is None:
                continue
            self.send(client, request)
            answer = b""
            try:
                client.shutdown(socket.SHUT_WR)
                while block := client.recv(65536):
                    answer += block
            except OSError:
                pass  # it was closed while the request was still on its way
            client.close()
            self.done["requests"] += 1
            self.done["faults (500)"] += answer.startswith(b"HTTP/1.1 500")
            self.done["answers"] += answer.startswith(b"HTTP/1.1 ")

    def mutation(self, message):
        bytes_ = bytearray(message)
        for _ in range(self.random.randrange(1, 6)):
            kind = self.random.randrange(5)
            place = self.random.randrange(4, len(bytes_))
            if kind == 0:
                bytes_[place] ^= 1 << self.random.randrange(8)
            elif kind == 1:
                bytes_[place] = self.random.choice((0, 1, 0x7F, 0x80, 0xFF))
            elif kind == 2:
                bytes_[place:place + 4] = struct.pack("<I", self.random.choice((0, 0x7FFFFFFF, 0xFFFFFFFF, len(bytes_))))
            elif kind == 3 and len(bytes_) > 16:
                del bytes_[place:]
            else:
                bytes_[place:place] = self.random.randbytes(self.random.randrange(1, 16))
            if len(bytes_) < 8:
                break
        if self.random.random() < 0.9:  # the rest has a wrong size, too
            bytes_[:4] = struct.pack("<I", len(bytes_) - 4)
        return bytes(bytes_)

    def slow(self):
        """Says what it wants byte by byte, on many connections at once."""
        clients = self.several()
        place = 0
        while self.is_on() and place < len(self.valid[0]):
            for client in clients:
                if self.send(client, self.valid[0][place:place + 1]):
                    self.done["bytes"] += 1
            place += 1
            time.sleep(0.05)
        for client in clients:
            client.close()

    def stalled(self):
        """Wants every frame, and reads none."""
        clients = [client for client in (self.connect(receive_bytes=2048) for _ in range(self.count)) if client is not None]
        for client in clients:
            self.send(client, self.valid[0])
        self.hold_unread(clients)

    def silent(self):
        """Subscribes to nothing, and asks for nothing."""
        clients = self.several()
        for client in clients:
            self.send(client, pose_client.subscribe_message(poses=False))
        self.hold(clients)

    def hold_unread(self, clients):
        while self.is_on():
            time.sleep(0.1)
        for client in clients:
            try:  # whether it was let go: a reset, or its end behind what was buffered
                client.settimeout(5.0)
                received = 0
                while block := client.recv(65536):
                    received += len(block)
                    if received > 1 << 20:
                        break
                self.done["let go"] += not block
            except ConnectionError:
                self.done["let go"] += 1
            except TimeoutError:
                pass
            client.close()

    def controls(self):
        """Orders without end, whose replies it does not read."""
        while self.is_on():
            client = self.connect()
            if client is None:
                continue
            if self.send(client, pose_client.subscribe_message(poses=False, client="flood")):
                client.settimeout(0.2)
                while self.is_on() and self.send(client, pose_client.control_message("no-such-scene-" + "x" * 200) * 20):
                    self.done["orders"] += 20
            client.close()

    def names(self):
        """Names of a kilobyte, full of what a terminal obeys."""
        while self.is_on():
            client = self.connect()
            if client is None:
                continue
            name = "\x1b[2J\n\r" + "".join(chr(self.random.randrange(1, 0x2FF)) for _ in range(700))
            self.send(client, pose_client.subscribe_message(poses=False, sensors=True, client=name[:1000]))
            self.done["names"] += 1
            client.close()

    def passers_by(self):
        """All of it, now and then: clients that come, read a while, stall, talk nonsense, and go."""
        clients = []  # (socket, does it read, until when)
        while self.is_on():
            now_s = time.monotonic()
            if len(clients) < 12 and self.random.random() < 0.3:
                client = self.connect()
                if client is not None:
                    kind = self.random.choice(("reads", "reads", "stalls", "idle", "nonsense", "order"))
                    self.done[kind] += 1
                    if kind != "idle":
                        self.send(client, self.valid[0])
                    if kind == "nonsense":
                        self.send(client, self.mutation(self.valid[0]))
                    if kind == "order":
                        self.send(client, pose_client.control_message("grass"))
                    client.setblocking(False)
                    clients.append((client, kind in ("reads", "order"), now_s + self.random.uniform(0.1, 8.0)))
            readable, _, _ = select.select([client for client, reads, _ in clients if reads], [], [], 0.1)
            gone = set()
            for client in readable:
                try:
                    if not client.recv(1 << 20):
                        gone.add(client)
                except OSError:
                    gone.add(client)
            for client, _, until_s in clients:
                if client in gone or now_s > until_s:
                    if self.random.random() < 0.3:
                        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                    client.close()
            clients = [entry for entry in clients if entry[0].fileno() >= 0]
        for client, _, _ in clients:
            client.close()

    # ---- what a stranger can do to a sensor that listens ----

    def datagrams(self, make):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            while self.is_on():
                try:
                    out.sendto(make(), self.target)
                    self.done["datagrams"] += 1
                except ConnectionError:
                    pass  # nobody listens just now

    def osc_flood(self):
        def make():
            message = b"/wind\0\0\0,ff\0" + struct.pack(">ff", self.random.uniform(0.0, 20.0), self.random.uniform(0.0, 360.0))
            if self.random.random() < 0.7:
                return message
            return message[:self.random.randrange(1, 20)] + self.random.randbytes(self.random.randrange(60))

        self.datagrams(make)

    def nmea_flood(self):
        def make():
            text = f"WIMWV,{self.random.uniform(0.0, 360.0):.1f},R,{self.random.uniform(0.0, 20.0):.1f},M,A"
            checksum = 0
            for byte in text.encode():
                checksum ^= byte
            checksum ^= self.random.random() < 0.3
            return f"${text}*{checksum:02X}\r\n".encode() * self.random.choice((1, 1, 50))

        self.datagrams(make)


class Reader:
    """What pose_client.messages() reads from."""

    def __init__(self, client):
        self.client = client

    def read(self, count):
        data = b""
        while len(data) < count:
            block = self.client.recv(count - len(data))
            if not block:
                raise EOFError
            data += block
        return bytearray(data)


def main():
    schema, kind, address, seconds, seed = sys.argv[1:6]
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(most, 8192), most))
    pose_client.load_schema(schema)
    attack = Attack(address, float(seconds), int(seed), int(sys.argv[6]) if len(sys.argv) > 6 else 1)
    signal.signal(signal.SIGTERM, lambda *_: attack.end())
    getattr(attack, kind)()
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # it ends by itself now
    print(json.dumps(attack.done))


if __name__ == "__main__":
    main()
