#!/usr/bin/env python3
"""A real daemon and a real viewer, without a display: how old a sensor's reading is in the picture, and a daemon that is killed.

usage: viewer_age_test.py DIRECTORY-OF-THE-PROGRAMS
"""
import os
import re
import signal
import sys
import tempfile
import unittest

from programs import HANG_S, Program, free_port
from slow_network import SlowNetwork

PROGRAMS = os.path.abspath(sys.argv.pop(1))
YURAGI, SIMULATOR, VIEWER = (os.path.join(PROGRAMS, name) for name in ("yuragi", "yuragi-sim", "yuragi-viewer"))
CONFIG = """
[look]
quality = "low"
[[scene]]
name = "meadow"
kind = "grass"
blades_across = 10
blades_deep = 10
[[sensor]]
name = "roof"
driver = "modbus"
profile = "{profile}"
transport = "tcp"
host = "{host}"
port = {port}
"""
PROFILE = "renke-rs-fsjt-rs-fxjt-n01"
AGE = r"reading (\d+) ms old when it was shown \(of 10 s: p50 (\d+), p95 (\d+), at most (\d+) ms"


class ViewerAge(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())

    def start_daemon(self, port=0):
        config = os.path.join(self.folder, "wall.toml")
        if not os.path.exists(config):
            sensor = self.enterContext(Program(SIMULATOR, "modbus", "--tcp", "127.0.0.1:0", "--profile", PROFILE))
            host, sensor_port = sensor.wait_for(r"(127\.0\.0\.1):(\d+)").groups()
            with open(config, "w", encoding="utf-8") as out:
                out.write(CONFIG.format(profile=PROFILE, host=host, port=sensor_port))
        return self.enterContext(Program(YURAGI, "run", "--config", config, "--listen", f"127.0.0.1:{port}"))

    def view(self, address, *words):
        environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        picture = os.path.join(self.folder, "picture.png")
        return self.enterContext(Program(VIEWER, "--connect", address, "--size", "64x36", "--screenshot", picture, "--look", "quality=low", "--samples", 1,
                                         "--wait", HANG_S, *words, env=environment))

    def age_by(self, address):
        """p50, p95 and the most, ms, of a sensor that the daemon believes."""
        viewer = self.view(address, "--frames", 60, "--age")
        self.assertEqual(viewer.process.wait(HANG_S), 0, viewer.text())
        said = re.findall(AGE, viewer.text())
        self.assertTrue(said, viewer.text())
        return [int(figure) for figure in said[-1][1:]]  # at the end: the first picture takes long where the processor draws

    def test_a_readings_age_is_measured_from_the_sensor_to_the_picture(self):
        address = self.start_daemon().address()
        self.view(address, "--frames", 1).process.wait(HANG_S)  # until the sensor is there
        p50, p95, most = self.age_by(address)
        self.assertTrue(0 < p50 <= p95 <= most < 60_000, (p50, p95, most))
        delay_ms = 500
        network = SlowNetwork(address, lambda: 1e-3 * delay_ms)
        self.addCleanup(network.listener.close)
        slow = self.age_by(network.address)
        print(f"direct: {p50}, {p95}, {most} ms; 500 ms later: {slow} ms")
        self.assertGreater(slow[0], delay_ms, "the network's delay is not in it")

    def test_a_daemon_that_was_killed_and_comes_back_is_shown_again(self):
        port = free_port()
        daemon = self.start_daemon(port)
        address = daemon.address()
        viewer = self.view(address, "--frames", 1_000_000, "--age")
        viewer.wait_for(AGE)
        daemon.end(signal.SIGKILL)
        again = self.start_daemon(port)
        again.address()
        said = len(re.findall(AGE, viewer.text()))
        # The next may be of pictures from before; the one behind it is not.
        self.assertTrue(viewer.wait_until(lambda text: len(re.findall(AGE, text)) >= said + 2), viewer.text())


if __name__ == "__main__":
    unittest.main()
