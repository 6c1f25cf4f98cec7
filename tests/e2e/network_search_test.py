#!/usr/bin/env python3
"""`yuragi sensors list --network`, with simulated stations on the loopback: what it prints is a configuration that can be used.

usage: network_search_test.py FOLDER_OF_PROGRAMS

The ports are those of the protocols, and so the test makes a network of its own, where the system allows it.
"""
import os
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import unittest

import own_network
from programs import HANG_S, Program


def name_of(*labels):
    return b"".join(bytes([len(label)]) + label.encode() for label in labels) + b"\0"


def record(name, kind, data):
    return name + struct.pack(">HHIH", kind, 0x8001, 120, len(data)) + data


def answer_to(question):
    """Who answers multicast DNS: a WeatherLink Live, and a Signal K server whose name is meant to do harm."""
    hosts = {"_weatherlinklive": ("weatherlinklive-700008", 80), "_signalk-ws": ('boat"\n[evil]\x1b[2J', 3100)}
    for kind, (label, port) in hosts.items():
        if kind.encode() not in question:
            continue
        service, host = name_of(kind, "_tcp", "local"), name_of("host", "local")
        instance = bytes([len(label)]) + label.encode() + service
        return struct.pack(">6H", 0, 0x8400, 0, 3, 0, 0) + record(service, 12, instance) + record(
            instance, 33, struct.pack(">3H", 0, 0, port) + host) + record(host, 1, socket.inet_aton("127.0.0.9"))
    return None


class Responder(threading.Thread):
    def __init__(self):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 5353))
        self.heard = []

    def run(self):
        while True:
            question, asker = self.socket.recvfrom(4096)
            self.heard.append(question)
            answer = answer_to(question)
            if answer:
                self.socket.sendto(answer, asker)


class NetworkSearch(unittest.TestCase):
    def test_prints_a_configuration_of_what_answers(self):
        yuragi, sim = (os.path.join(BIN, name) for name in ("yuragi", "yuragi-sim"))
        responder = Responder()
        responder.start()
        gateway = Program(sim, "ecowitt", "--tcp", "127.0.0.1:0", "--search", "127.0.0.1:46000")
        self.addCleanup(gateway.__exit__)
        gateway.wait_for("listening on")
        hub = Program(sim, "tempest", "--udp", "127.0.0.1:50222")
        self.addCleanup(hub.__exit__)

        def search(*more):
            done = subprocess.run([yuragi, "sensors", "list", *more], capture_output=True, text=True, timeout=HANG_S, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout

        self.assertIn("sensors list --network", search())
        self.assertEqual(responder.heard, [], "nothing is asked unless it is wanted")

        printed = search("--network", "5", "--ask", "127.0.0.1")
        self.assertNotIn("\x1b", printed)
        tables = [block.split("\n\n")[0] for block in printed.split("[[sensor]]")[1:]]
        toml = "".join("[[sensor]]\n" + "\n".join(line.strip() for line in table.splitlines()) + "\n" for table in tables)
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(toml)
            file.flush()
            checked = subprocess.run([yuragi, "check-config", file.name], capture_output=True, text=True, timeout=HANG_S, check=False)
        self.assertEqual(checked.returncode, 0, checked.stderr + toml)
        drivers = sorted(line.split('"')[1] for line in toml.splitlines() if line.startswith("driver ="))
        self.assertEqual(drivers, ["ecowitt", "signalk", "tempest", "weatherlink"], printed)
        self.assertIn('host = "127.0.0.9"', toml)
        self.assertNotIn("evil", toml)


if __name__ == "__main__":
    why_not = own_network.enter()
    if why_not:
        print(f"{why_not}: UDP ports 5353, 46000 and 50222 of the loopback must be free")
    BIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
