#!/usr/bin/env python3
"""[osc_query] announce: a daemon in one network, and Avahi's browser in another that is joined to it.

usage: announcement_test.py FOLDER_OF_PROGRAMS

Both networks are the test's own, each with a D-Bus and an avahi-daemon of its own; the test is skipped where the system does not
allow that.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import own_network
from programs import HANG_S, Program

BUS = """<busconfig><type>system</type><listen>unix:path=/run/dbus/system_bus_socket</listen><auth>EXTERNAL</auth>
<policy context="default"><allow user="*"/><allow own="*"/><allow send_type="method_call"/><allow send_type="signal"/>
<allow send_requested_reply="true"/><allow receive_type="method_call"/><allow receive_type="signal"/>
<allow receive_type="method_return"/><allow receive_type="error"/></policy></busconfig>
"""
# avahi-daemon wants /run/avahi-daemon to belong to its user; here there is one user only.
USERS = {"passwd": "root:x:0:0::/:/bin/sh\navahi:x:0:0::/:/bin/sh\n", "group": "root:x:0:\navahi:x:0:\nnetdev:x:0:\n"}
AVAHI = "[server]\nuse-ipv6=no\nratelimit-interval-usec=1000\nratelimit-burst=10000\n"
PROGRAMS = ("nsenter", "ip", "dbus-daemon", "avahi-daemon", "avahi-publish", "avahi-browse")
WHY_NOT = own_network.enter("mount", "uts", needs=PROGRAMS)
YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")


class Machine:
    """A network and a /run of its own, in which programs run."""

    def __init__(self, test, name, folder):
        self.test, self.folder = test, folder
        self.root = self.started(Program("unshare", "--net", "--mount", "--uts", "sh", "-c", f"""
            mount -t tmpfs none /run && mkdir /run/dbus && hostname {name} && ip link set lo up || exit
            mount --bind {folder}/passwd /etc/passwd && mount --bind {folder}/group /etc/group && echo ready
            exec sleep infinity"""))
        self.root.wait_for("ready")

    def started(self, program):
        self.test.addCleanup(program.__exit__)
        return program

    def command(self, *words):
        return ["nsenter", "--target", self.root.process.pid, "--net", "--mount", "--uts", *words]

    def start(self, *words):
        return self.started(Program(*self.command(*words)))

    def run(self, *words):
        return subprocess.run([str(word) for word in self.command(*words)], capture_output=True, text=True, timeout=HANG_S,
                              check=False).stdout

    def start_bus(self):
        self.start("dbus-daemon", "--nofork", "--print-address", "--config-file", self.folder / "bus.conf").wait_for("unix:path")

    def start_avahi(self):
        avahi = self.start("avahi-daemon", "--no-drop-root", "--no-chroot", "--no-rlimits", "--file", self.folder / "avahi.conf")
        avahi.wait_for("Server startup complete")
        return avahi


@unittest.skipIf(WHY_NOT, WHY_NOT)
class Announcement(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-announcement-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "bus.conf").write_text(BUS, encoding="utf-8")
        (self.folder / "avahi.conf").write_text(AVAHI, encoding="utf-8")
        for name, text in USERS.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        self.wall, self.desk = Machine(self, "wall", self.folder), Machine(self, "desk", self.folder)
        for machine, other, address in ((self.wall, self.desk, "10.77.0.1/24"), (self.desk, None, "10.77.0.2/24")):
            if other:
                machine.run("ip", "link", "add", "eth", "type", "veth", "peer", "name", "eth", "netns", other.root.process.pid)
            machine.run("ip", "address", "add", address, "broadcast", "+", "dev", "eth")
            machine.run("ip", "link", "set", "eth", "multicast", "on", "up")
            machine.start_bus()

    def services(self):
        """What the other machine finds: kind, name, address and port."""
        found = set()
        for kind in ("_oscjson._tcp", "_http._tcp", "_osc._udp"):
            for line in self.desk.run("avahi-browse", "--resolve", "--terminate", "--parsable", kind).splitlines():
                fields = line.split(";")
                if fields[0] == "=":
                    found.add((kind, fields[3], fields[7], int(fields[8])))
        return found

    def wait_for(self, is_there, what):
        end = time.monotonic() + HANG_S
        while not (last := is_there()):
            self.assertLess(time.monotonic(), end, f"{what}: {last}")
            time.sleep(0.2)

    def status(self):
        return self.wall.run(YURAGI, "status")

    def test_other_machines_find_it_while_it_runs(self):
        config = self.folder / "wall.toml"
        config.write_text('[stream]\nlisten = "127.0.0.1:7410"\n[http]\nlisten = "0.0.0.0:7480"\n'
                          '[osc_query]\nlisten = "0.0.0.0:7490"\nname = "hall"\n'
                          '[[sensor]]\ndriver = "osc"\nname = "far"\nhost = "0.0.0.0"\nport = 9000\nfrom = "10.77.0.0/24"\n'
                          '[[sensor]]\ndriver = "osc"\nname = "near"\nport = 9001\n', encoding="utf-8")
        daemon = self.wall.start(YURAGI, "run", "--config", config)
        daemon.wait_for("listening on")
        self.wait_for(lambda: "install and start avahi-daemon" in self.status(), "without Avahi it says what to do")

        self.desk.start_avahi()
        avahi = self.wall.start_avahi()
        all_of_it = {("_oscjson._tcp", "hall", "10.77.0.1", 7490), ("_http._tcp", "hall", "10.77.0.1", 7480),
                     ("_osc._udp", "hall", "10.77.0.1", 9000)}
        self.wait_for(lambda: self.services() == all_of_it, "announced once Avahi is there")
        info = self.desk.run("python3", "-c", "import urllib.request; "
                             "print(urllib.request.urlopen('http://10.77.0.1:7490/?HOST_INFO').read().decode())")
        self.assertIn('"NAME":"hall"', info)
        self.wait_for(lambda: "avahi" not in self.status(), "no trouble any more")

        avahi.end()
        self.wait_for(lambda: "avahi-publish has failed" in self.status(), "Avahi has gone")
        self.wall.start_avahi()
        self.wait_for(lambda: self.services() == all_of_it, "announced again")

        self.assertEqual(daemon.end(), 0)
        self.wait_for(lambda: self.services() == set(), "no longer announced")


if __name__ == "__main__":
    unittest.main(verbosity=2)
