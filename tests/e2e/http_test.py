#!/usr/bin/env python3
"""What the daemon answers by HTTP.

usage: http_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import re
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request

from programs import HANG_S, Program, free_port

YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")
SMALL_MEADOW = '[[scene]]\nname = "meadow"\nkind = "grass"\nblades_across = 20\nblades_deep = 20\n'


class Http(unittest.TestCase):
    def start_daemon(self, sensor):
        file = os.path.join(self.enterContext(tempfile.TemporaryDirectory()), "yuragi.toml")
        with open(file, "w", encoding="utf-8") as config:
            config.write('[http]\nlisten = "127.0.0.1:0"\n' + sensor + SMALL_MEADOW)
        daemon = self.enterContext(Program(YURAGI, "run", "--config", file, "--listen", "127.0.0.1:0"))
        self.base = daemon.wait_for(r"answering at (http://\S+)").group(1)

    def ask(self, path, body=None):
        """Status and text of the answer."""
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=HANG_S) as answer:
                return answer.status, answer.read().decode()
        except urllib.error.HTTPError as refusal:
            with refusal:
                return refusal.code, refusal.read().decode()

    def wait_for(self, path, status, pattern):
        """An answer of that status that says so."""
        hangs = time.monotonic() + HANG_S
        while time.monotonic() < hangs:
            told, text = self.ask(path)
            if told == status and re.search(pattern, text):
                return text
        self.fail(f"{path} said last: {told} {text}")

    def test_a_daemon_that_is_well_says_so_and_shows_what_it_is_asked_to(self):
        self.start_daemon('[[sensor]]\nname = "roof"\ndriver = "synthetic"\n')
        self.wait_for("/healthz", 200, "all is well")
        self.wait_for("/metrics", 200, r'yuragi_sensor_believed{sensor="roof",driver="synthetic"} 1\n')
        status = json.loads(self.ask("/api/v1/status")[1])
        self.assertEqual((status["verdict"], status["sensors"][0]["name"]), ("well", "roof"))
        code, text = self.ask("/api/v1/scenes", {"scene": "meadow", "shown": False, "over_s": 0})
        self.assertEqual((code, json.loads(text)["scenes"][0]["is_shown"]), (200, False))
        code, text = self.ask("/api/v1/scenes", {"scene": "sea"})
        self.assertEqual(code, 409)
        self.assertIn("sea", json.loads(text)["detail"])

    def test_a_sensor_that_is_not_there_is_told_with_what_to_do(self):
        self.start_daemon(f'[[sensor]]\nname = "roof"\ndriver = "nmea"\ntransport = "tcp"\nhost = "127.0.0.1"\nport = {free_port()}\n')
        self.wait_for("/healthz", 503, "roof.*127.0.0.1")
        self.wait_for("/metrics", 200, r'yuragi_sensor_believed{sensor="roof",driver="nmea"} 0\n')


if __name__ == "__main__":
    unittest.main()
