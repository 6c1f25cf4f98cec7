#!/usr/bin/env python3
"""Who is told when something is wrong: a daemon with [[alert]]s, by a command and by a webhook.

usage: alerts_test.py FOLDER_OF_PROGRAMS
"""
import http.server
import json
import os
import queue
import signal
import sys
import tempfile
import threading
import unittest

from programs import HANG_S, Program, free_port

PROGRAMS = os.path.abspath(sys.argv.pop(1))


class Webhook(http.server.ThreadingHTTPServer):
    """Keeps what is posted to it."""

    def __init__(self):
        super().__init__(("127.0.0.1", 0), WebhookRequest)
        self.posts = queue.Queue()
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def __exit__(self, *args):
        self.shutdown()
        super().__exit__(*args)

    def next(self):
        return self.posts.get(timeout=HANG_S)


class WebhookRequest(http.server.BaseHTTPRequestHandler):
    def do_POST(self):
        self.server.posts.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
        self.send_response(204)
        self.end_headers()

    def log_message(self, *_):
        pass


class Alerts(unittest.TestCase):
    def test_a_sensor_that_dies_and_returns_is_told_once_each(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        webhook = self.enterContext(Webhook())
        port = free_port()
        config = os.path.join(folder, "yuragi.toml")
        with open(config, "w", encoding="utf-8") as file:
            file.write(f"""[[sensor]]
name = "roof"
driver = "nmea"
transport = "tcp"
host = "127.0.0.1"
port = {port}

[[alert]]
name = "roof is silent"
sensor = "roof"
after = 1
end_after = 1
command = 'echo "$YURAGI_ALERT_STATE: $YURAGI_ALERT_MESSAGE" >> {folder}/told'
webhook = "http://127.0.0.1:{webhook.server_port}/hooks/s3cret"
""")
        os.chmod(config, 0o600)

        def simulator():
            return Program(os.path.join(PROGRAMS, "yuragi-sim"), "nmea", "--tcp", f"127.0.0.1:{port}")

        with Program(os.path.join(PROGRAMS, "yuragi"), "run", "--config", config, "--listen", "127.0.0.1:0") as daemon:
            with simulator() as sensor:
                daemon.wait_for(r"sensor roof.*live")
                sensor.end(signal.SIGKILL)
            daemon.wait_for(r"alert roof is silent: began: sensor roof is")
            began = webhook.next()
            self.assertEqual((began["alert"], began["state"]), ("roof is silent", "began"))
            self.assertRegex(began["message"], r"^sensor roof is (stale|disconnected)")
            with simulator():
                daemon.wait_for(r"alert roof is silent: ended: sensor roof is live again")
                ended = webhook.next()
            self.assertEqual(ended["state"], "ended")
            daemon.end()
            self.assertNotIn("s3cret", daemon.text())
        self.assertTrue(webhook.posts.empty())
        with open(os.path.join(folder, "told"), encoding="utf-8") as file:
            told = file.read().splitlines()
        self.assertEqual([line.split(":")[0] for line in told], ["began", "ended"], told)


if __name__ == "__main__":
    unittest.main()
