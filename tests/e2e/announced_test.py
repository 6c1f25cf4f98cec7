#!/usr/bin/env python3
"""`yuragi sensors list --broker`, with a real broker: what it prints is a configuration that can be used.

usage: announced_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

from programs import HANG_S, Program, free_port

BIN = os.path.abspath(sys.argv.pop(1))
YURAGI = os.path.join(BIN, "yuragi")


def run(*arguments):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, timeout=HANG_S, check=False)


class Announced(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-announced-")
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name

    def file(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        return path

    def test_prints_a_configuration_of_what_is_announced(self):
        port = free_port()
        broker = Program("mosquitto", "-c", self.file("broker.conf", f"listener {port} 127.0.0.1\nuser root\n"
                                                                     "allow_anonymous true\npersistence false\n"))
        self.addCleanup(broker.__exit__)
        broker.wait_for("running")

        def announce(name, announcement):
            subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(port), "-q", "1", "-r", "-m", json.dumps(announcement),
                            "-t", f"homeassistant/sensor/roof/{name}/config"], check=True, timeout=HANG_S)

        place = f"127.0.0.1:{port}"
        none = run("sensors", "list", "--broker", place)
        self.assertEqual(none.returncode, 0, none.stderr)
        self.assertIn(f"No anemometer is announced on {place}", none.stdout)

        announce("wind_speed", {"unit_of_meas": "km/h", "name": "Wind Speed", "stat_t": "roof/sensor/wind_speed/state",
                                "dev": {"ids": "a4cf12", "name": "roof"}})
        announce("wind_direction", {"unit_of_meas": "\u00b0", "name": "Wind Direction",
                                    "stat_t": "roof/sensor/wind_direction/state", "dev": {"ids": "a4cf12", "name": "roof"}})
        announce("computed", {"dev_cla": "wind_speed", "unit_of_meas": "km/h", "stat_t": "a", "val_tpl": "{{ value | float * 3.6 }}"})
        done = run("sensors", "list", "--broker", place)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("{{ value | float * 3.6 }}", done.stdout)
        table = done.stdout.split("[[sensor]]")[1].split("\n\n")[0]
        toml = "[[sensor]]\n" + "\n".join(line.strip() for line in table.splitlines())
        for line in ('topic = "roof/sensor/wind_speed/state"', 'direction_topic = "roof/sensor/wind_direction/state"',
                     'speed_unit = "km/h"', f"port = {port}"):
            self.assertIn(line, toml)
        checked = run("check-config", self.file("announced.toml", toml))
        self.assertEqual(checked.returncode, 0, checked.stderr + toml)
        found = json.loads(run("sensors", "list", "--broker", place, "--json").stdout)
        self.assertEqual(len(found), 2)

        nowhere = run("sensors", "list", "--broker", f"127.0.0.1:{free_port()}")
        self.assertEqual(nowhere.returncode, 69, nowhere.stderr)
        self.assertIn("check its address", nowhere.stderr)
        self.assertEqual(run("sensors", "list", "--user", "garden").returncode, 64)


if __name__ == "__main__":
    unittest.main(verbosity=2)
