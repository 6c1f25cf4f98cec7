#!/usr/bin/env python3
"""[[dmx]] with a receiver that others have written: a daemon sends sACN and Art-Net, and OLA receives a universe of each.

usage: ola_test.py FOLDER_OF_PROGRAMS

olad listens on the ports of these protocols. The test makes a network of its own, and is skipped if the system does not allow that.
"""
import os
import pathlib
import select
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import own_network
from programs import HANG_S, Program

WHY_NOT = own_network.enter(needs=("ip", "olad"))
try:
    from ola.OlaClient import OlaClient
except ImportError:
    WHY_NOT = WHY_NOT or "not installed: ola-python (config/setup.sh --test installs it)"
BIN = os.path.abspath(sys.argv.pop(1))
YURAGI, SIM = (os.path.join(BIN, name) for name in ("yuragi", "yuragi-sim"))

UNIVERSES = SACN, ART_NET = 1, 2  # the same numbers in the protocols and in OLA
# The first input of each of OLA's plug-ins, E1.31 (11) and Art-Net (2), and its universe.
PATCHED = f"11-1-I-0 = {SACN}\n2-1-I-0 = {ART_NET}\n"
DISABLED = ("dummy espnet ftdidmx gpio karate kinet milinst opendmx openpixelcontrol osc pathport renard sandnet shownet spi stageprofi "
            "uartdmx usbdmx usbserial")
ADDRESS = "10.77.0.1"

REST, LOWEST, HIGHEST, DESK = 17, 40, 240, 254  # the wind gives neither the level of rest nor that of the desk
CHANNEL = 3
FAN = f'[[dmx.channel]]\nchannel = {CHANNEL}\nvalue = "speed"\nfrom = "0 12"\nto = "{LOWEST} {HIGHEST}"\nrest = {REST}\n'
WIND = '[[sensor]]\ndriver = "synthetic"\nspeed = 4.0\nturbulence = 0.2\nrate = 20\n'
GUSTS, GUST_EVERY_S = 20, 8


def level_of(speed_m_s):
    return LOWEST + (HIGHEST - LOWEST) * speed_m_s / 12.0


def gusts():
    """A scenario: from 2 m/s up to 11 m/s and down again, repeated, so that a daemon that starts slowly still gets a whole gust."""
    winds = ["[[wind]]\nspeed = 2\nturbulence = 0\n"]
    for gust in range(GUSTS):
        for after_s, speed_m_s in ((4, 11), (8, 2)):
            winds.append(f'[[wind]]\nat = "{gust * GUST_EVERY_S + after_s}s"\nramp = "2s"\nspeed = {speed_m_s}\nturbulence = 0\n')
    return "".join(winds) + '[[device]]\nname = "roof"\nsimulate = "nmea --tcp 127.0.0.1:0 --format mwv --rate 20"\n'


class Receiver:
    """A client of olad, which collects the levels of the fan's channel in each universe."""

    def __init__(self):
        self.client = OlaClient()
        self.levels = {}
        for universe in UNIVERSES:
            self.levels[universe] = []
            self.client.RegisterUniverse(universe, OlaClient.REGISTER, lambda data, of=universe: self.add(of, data))

    def add(self, universe, data):
        if len(data) >= CHANNEL:  # a universe without a source can have no levels
            self.levels[universe].append(data[CHANNEL - 1])

    def wait_until(self, is_found, what):
        end = time.monotonic() + HANG_S
        while not is_found():
            ready, _, _ = select.select([self.client.GetSocket()], [], [], max(0.0, end - time.monotonic()))
            if not ready:
                raise AssertionError(f"{what}: OLA received {[levels[-100:] for levels in self.levels.values()]}")
            self.client.SocketReady()

    def wait_for(self, universes, is_found, what):
        """Waits for such a level in each of the universes, among those that come from now on."""
        begin = {universe: len(self.levels[universe]) for universe in universes}
        self.wait_until(lambda: all(any(map(is_found, self.levels[universe][begin[universe]:])) for universe in universes), what)


@unittest.skipIf(WHY_NOT, WHY_NOT)
class Ola(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for words in ("link add eth0 type veth peer name eth1", f"address add {ADDRESS}/24 broadcast + dev eth0",
                      "link set eth0 multicast on up", "link set eth1 up"):
            subprocess.run(["ip", *words.split()], check=True)

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-ola-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        for name in DISABLED.split():
            self.write(f"ola-{name}.conf", "enabled = false\n")
        self.write("ola-port.conf", PATCHED)
        # olad does not run as root, which is the only user of this test's namespace.
        self.olad = self.start("unshare", "--user", "--map-user=1000", "olad", "--config-dir", self.folder, "--log-level", "3",
                               "--no-http", "--no-register-with-dns-sd")
        for universe in UNIVERSES:
            self.olad.wait_for(f"Patched .* to universe {universe}\n")
        self.receiver = Receiver()

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def start(self, *command):
        program = Program(*command)
        self.addCleanup(program.__exit__)
        return program

    def start_daemon(self, sensor):
        config = self.write("wall.toml", f"""\
[stream]
listen = "127.0.0.1:0"
[wind]
handover = 0.2
{sensor}
[[dmx]]
name = "lamps"
universe = {SACN}
interface = "{ADDRESS}"
{FAN}
[[dmx]]
name = "fans"
protocol = "artnet"
universe = {ART_NET}
to = "{ADDRESS}"
{FAN}
""")
        return self.start(YURAGI, "run", "--config", config)

    def wait_for_rest_and_end(self):
        """Art-Net has no end of a stream."""
        for universe in UNIVERSES:
            self.receiver.wait_until(lambda levels=self.receiver.levels[universe]: levels[-1] == REST, "the level of rest")
        self.olad.wait_for(f"sent a termination for universe {SACN}\n")

    def wait_for_levels(self):
        self.receiver.wait_for(UNIVERSES, lambda level: level > LOWEST, "a level of the wind")

    def test_it_follows_a_gust_and_rests_when_the_daemon_ends(self):
        scenario = self.start(SIM, "scenario", self.write("gusts.scenario.toml", gusts()))
        port = scenario.wait_for(r"roof: listening on \S+:(\d+)").group(1)
        daemon = self.start_daemon(f'[[sensor]]\ndriver = "nmea"\ntransport = "tcp"\nhost = "127.0.0.1"\nport = {port}\n')
        weak, strong = level_of(4), level_of(9)
        self.receiver.wait_for(UNIVERSES, lambda level: level < weak, "before the gust")
        begin = {universe: len(self.receiver.levels[universe]) for universe in UNIVERSES}
        self.receiver.wait_for(UNIVERSES, lambda level: level > strong, "in the gust")
        self.receiver.wait_for(UNIVERSES, lambda level: level < weak, "after the gust")
        for universe in UNIVERSES:
            levels = self.receiver.levels[universe][begin[universe]:]
            self.assertGreater(len({level for level in levels if weak < level < strong}), 5, "it is no step")
            self.assertGreaterEqual(min(levels), LOWEST)
        self.assertEqual(daemon.end(), 0)
        self.wait_for_rest_and_end()

    def test_it_rests_after_a_crash_by_the_subcommand(self):
        daemon = self.start_daemon(WIND)
        self.wait_for_levels()
        self.assertEqual(daemon.end(signal.SIGKILL), -signal.SIGKILL)
        self.assertNotIn("sent a termination", self.olad.text())
        self.assertNotIn(REST, self.receiver.levels[SACN] + self.receiver.levels[ART_NET])
        done = subprocess.run([YURAGI, "feeds", "rest", "--config", self.folder / "wall.toml"], capture_output=True, text=True,
                              timeout=HANG_S, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.wait_for_rest_and_end()

    def test_a_desk_of_a_higher_priority_takes_over_and_gives_back(self):
        self.start_daemon(WIND)
        self.wait_for_levels()
        fader = f'[[dmx.channel]]\nchannel = {CHANNEL}\nvalue = "speed"\nto = "{DESK} 255"\nrest = {DESK}\n'
        desk = self.start(YURAGI, "run", "--config", self.write("desk.toml", f"""\
[stream]
listen = "127.0.0.1:0"
[[dmx]]
name = "desk"
universe = {SACN}
interface = "{ADDRESS}"
priority = 150
{fader}
"""))
        self.receiver.wait_for([SACN], lambda level: level >= DESK, "the desk's level")
        begin = len(self.receiver.levels[SACN])
        self.receiver.wait_for([ART_NET], lambda level: level > LOWEST, "where the desk does not send")
        self.receiver.wait_for([SACN], lambda level: level >= DESK, "the desk's level, still")
        self.assertGreaterEqual(min(self.receiver.levels[SACN][begin:]), DESK)
        self.assertEqual(desk.end(), 0)
        self.receiver.wait_for([SACN], lambda level: level < DESK, "given back")


if __name__ == "__main__":
    unittest.main(verbosity=2)
