#!/usr/bin/env python3
"""Who is told when something is wrong: a daemon with [[alert]]s, by a command and by a webhook.

usage: alerts_test.py FOLDER_OF_PROGRAMS
"""
import http.server
import json
import os
import queue
import re
import signal
import socket
import sys
import tempfile
import threading
import time
import unittest

from programs import HANG_S, Program, free_port

PROGRAMS = os.path.abspath(sys.argv.pop(1))


class Webhook(http.server.ThreadingHTTPServer):
    """Keeps what is posted to it."""

    def __init__(self, port=0):
        super().__init__(("127.0.0.1", port), WebhookRequest)
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


CLOSE_ON_EXEC = 0o2000000  # O_CLOEXEC, as /proc/PID/fdinfo shows it


def inherited(pid):
    """What a child would inherit of this process besides standard input, output and error: its open files."""
    files = []
    for number in os.listdir(f"/proc/{pid}/fd"):
        try:
            with open(f"/proc/{pid}/fdinfo/{number}", encoding="ascii") as info:
                flags = int(re.search(r"flags:\s+(\d+)", info.read()).group(1), 8)
            if int(number) > 2 and not flags & CLOSE_ON_EXEC:
                files.append(os.readlink(f"/proc/{pid}/fd/{number}"))
        except FileNotFoundError:
            pass  # closed meanwhile
    return files


class Alerts(unittest.TestCase):
    def setUp(self):
        self.folder = self.enterContext(tempfile.TemporaryDirectory())
        self.told = os.path.join(self.folder, "told")
        self.config = os.path.join(self.folder, "yuragi.toml")
        self.environment = {**os.environ, "STATE_DIRECTORY": self.folder}

    def sensor(self, port):
        return Program(os.path.join(PROGRAMS, "yuragi-sim"), "nmea", "--tcp", f"127.0.0.1:{port}")

    def daemon(self, *options):
        return Program(os.path.join(PROGRAMS, "yuragi"), "run", "--config", self.config, "--listen", "127.0.0.1:0",
                       *options, env=self.environment)

    def write_config(self, text, *ports):
        with open(self.config, "w", encoding="utf-8") as file:
            for name, port in zip(("roof", "mast"), ports):
                file.write(f"""[[sensor]]
name = "{name}"
driver = "nmea"
transport = "tcp"
host = "127.0.0.1"
port = {port}

""")
            file.write(text)
        os.chmod(self.config, 0o600)

    def test_a_command_inherits_nothing(self):
        ports = [free_port(), free_port()]
        self.write_config(f"""[http]
listen = "127.0.0.1:0"

[[sensor]]
name = "datagrams"
driver = "nmea"
transport = "udp"
host = "127.0.0.1"
port = {free_port(socket.SOCK_DGRAM)}

[[sensor]]
name = "console"
driver = "ecowitt-push"
host = "127.0.0.1"
port = {free_port()}

[[alert]]
name = "roof is silent"
sensor = "roof"
after = 0
end_after = 0
command = 'ls -l /proc/self/fd > {self.told}; echo done'
""", *ports)
        with self.sensor(ports[1]), self.sensor(ports[0]) as roof, self.daemon() as daemon:
            stream = daemon.wait_for(r"listening on (\S+):(\d+)").groups()
            page = daemon.wait_for(r"answering at http://([\d.]+):(\d+)").groups()
            daemon.wait_for(r"sensor roof.*live")
            daemon.wait_for(r"sensor mast.*live")
            with socket.create_connection(stream), socket.create_connection(page) as browser:
                # It is accepted once it is answered.
                browser.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")
                self.assertTrue(browser.recv(1))
                # The standard library reads and writes a small file without O_CLOEXEC: no child has it, and it is closed at once.
                deadline = time.monotonic() + HANG_S
                while inherited(daemon.process.pid) and time.monotonic() < deadline:
                    time.sleep(0.01)
                self.assertEqual(inherited(daemon.process.pid), [])
                roof.end(signal.SIGKILL)
                # It may have begun and ended before: while the sensor was not connected yet.
                daemon.wait_for(r"(?s)began: sensor roof is disconnected.*done")
            with open(self.told, encoding="utf-8") as file:
                found = re.findall(r"(\d+) -> (.*)", file.read())
        # ls itself reads the folder.
        files = {number: name for number, name in found if not re.fullmatch(r"/proc/\d+/fd", name)}
        self.assertEqual(files.keys(), {"0", "1", "2"}, files)

    def test_a_command_that_hangs_delays_no_other_alert(self):
        self.write_config("".join(f"""[[alert]]
name = "{name}"
after = 0
command = '{command}'

""" for name, command in (("first", "sleep 1000"), ("second", "sleep 1000"), ("third", "echo told"))), free_port())
        with self.daemon() as daemon:
            daemon.wait_for("told")
            # The commands end with the daemon.
            self.assertEqual(daemon.end(), 0)

    def test_what_was_on_when_the_daemon_was_killed_ends_once_after_its_restart(self):
        port = free_port()
        self.write_config(f"""[[alert]]
name = "roof is silent"
sensor = "roof"
after = 0
end_after = 0
command = 'echo "$YURAGI_ALERT_STATE" >> {self.told}'
""", port)
        with self.daemon("--verbose") as daemon:
            daemon.wait_for(r"began: sensor roof[^\0]*alerts.json is written")
            daemon.end(signal.SIGKILL)
        with self.daemon("--verbose") as daemon:
            with self.sensor(port):
                # Its record is removed once all is told.
                daemon.wait_for(r"ended: sensor roof is live again[^\0]*alerts.json is removed")
            daemon.end(signal.SIGKILL)
            self.assertNotIn("began: sensor roof", daemon.text().split("ended: sensor roof")[0])
        with open(self.told, encoding="utf-8") as file:
            told = file.read().split()
        self.assertEqual(told.count("ended"), 1, told)

    def test_what_was_not_delivered_is_delivered_after_a_restart(self):
        port = free_port()
        self.write_config(f"""[[alert]]
name = "roof is silent"
sensor = "roof"
after = 0
webhook = "http://127.0.0.1:{port}/hooks/s3cret"
""", free_port())
        with self.daemon() as daemon:
            daemon.wait_for(r"its webhook: .*it is tried again")
            daemon.end()
        with open(os.path.join(self.folder, "alerts.json"), encoding="utf-8") as file:
            self.assertNotIn("s3cret", file.read())
        webhook = self.enterContext(Webhook(port))
        with self.daemon():
            self.assertEqual(webhook.next()["state"], "began")
        self.assertTrue(webhook.posts.empty())

    def test_a_sensor_that_dies_and_returns_is_told_once_each(self):
        webhook = self.enterContext(Webhook())
        port = free_port()
        self.write_config(f"""[[alert]]
name = "roof is silent"
sensor = "roof"
after = 1
end_after = 1
command = 'echo "$YURAGI_ALERT_STATE: $YURAGI_ALERT_MESSAGE" >> {self.told}; echo "$YURAGI_ALERT_STATE has been written"'
webhook = "http://127.0.0.1:{webhook.server_port}/hooks/s3cret"
""", port)
        with self.daemon() as daemon:
            with self.sensor(port) as sensor:
                daemon.wait_for(r"sensor roof.*live")
                sensor.end(signal.SIGKILL)
            daemon.wait_for(r"alert roof is silent: began: sensor roof is")
            began = webhook.next()
            self.assertEqual((began["alert"], began["state"]), ("roof is silent", "began"))
            self.assertRegex(began["message"], r"^sensor roof is (stale|disconnected)")
            with self.sensor(port):
                daemon.wait_for(r"alert roof is silent: ended: sensor roof is live again")
                ended = webhook.next()
                daemon.wait_for("ended has been written")
            self.assertEqual(ended["state"], "ended")
            daemon.end()
            self.assertNotIn("s3cret", daemon.text())
        self.assertTrue(webhook.posts.empty())
        with open(self.told, encoding="utf-8") as file:
            told = file.read().splitlines()
        self.assertEqual([line.split(":")[0] for line in told], ["began", "ended"], told)


if __name__ == "__main__":
    unittest.main()
