#!/usr/bin/env python3
"""What the daemon tells a service manager (sd_notify(3)): the test is the manager, with a real socket.

usage: service_manager_test.py FOLDER_OF_PROGRAMS
"""
import os
import signal
import socket
import sys
import tempfile
import time
import unittest
import urllib.request

from programs import HANG_S, Program

YURAGI = os.path.join(os.path.abspath(sys.argv.pop(1)), "yuragi")
WATCHDOG_S = 2.0


class ServiceManager:
    """The socket that NOTIFY_SOCKET names."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="yuragi-notify-")
        self.path = os.path.join(self.folder.name, "notify")
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(self.path)

    def environment(self, **others):
        return {**os.environ, "NOTIFY_SOCKET": self.path, **others}

    def next(self, timeout_s=HANG_S):
        """The assignments of the next message, or None where none comes in that time."""
        self.socket.settimeout(timeout_s)
        try:
            text = self.socket.recv(65536).decode()
        except TimeoutError:
            return None
        return dict(line.split("=", 1) for line in text.splitlines())

    def wait_for(self, key):
        """All messages until one that has the key, and that one."""
        messages = []
        while not messages or key not in messages[-1]:
            message = self.next()
            assert message is not None, f"no {key} after {messages}"
            messages.append(message)
        return messages

    def fill(self):
        """Makes its queue so full that it takes nothing more: as if it had hung for long."""
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as sender:
            sender.setblocking(False)
            sender.connect(self.path)
            try:
                while True:
                    sender.send(b"STATUS=old")
            except BlockingIOError:
                pass

    def take_all(self):
        """What has come until now."""
        messages = []
        self.socket.setblocking(False)
        while True:
            try:
                messages.append(self.socket.recv(65536).decode())
            except BlockingIOError:
                return messages

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()
        self.folder.cleanup()


class ServiceManagerTest(unittest.TestCase):
    def test_it_is_ready_when_it_listens_and_has_a_frame(self):
        with ServiceManager() as manager, Program(YURAGI, "run", "--listen", "127.0.0.1:0",
                                                  env=manager.environment()) as daemon:
            messages = manager.wait_for("READY")
            self.assertEqual(messages[-1]["READY"], "1")
            self.assertNotIn("WATCHDOG", {key for message in messages for key in message})
            host, port = daemon.address().rsplit(":", 1)
            with socket.create_connection((host, int(port)), HANG_S):
                pass
            status = next(message["STATUS"] for message in messages if "STATUS" in message)
            self.assertRegex(status, r"^\d of 1 sensor live, \d clients?$")

            self.assertEqual(daemon.end(signal.SIGTERM), 0)
            last = manager.wait_for("STOPPING")[-1]
            self.assertEqual(last, {"STOPPING": "1", "STATUS": "ending: terminated"})

    def test_it_is_reloading_until_the_configuration_has_been_read_again(self):
        with ServiceManager() as manager, tempfile.TemporaryDirectory() as folder:
            config = os.path.join(folder, "wall.toml")
            for command in (("run",), ("record", os.path.join(folder, "a.windlog"))):
                for text, said in (("[shaping]\nfloor = 2\n", "applied 1 change"), ("[shaping]\nfloor = -2\n", "nothing was changed")):
                    with open(config, "w", encoding="utf-8") as out:
                        out.write("")
                    with Program(YURAGI, *command, "--config", config, "--listen", "127.0.0.1:0", env=manager.environment()) as daemon:
                        manager.wait_for("READY")
                        with open(config, "w", encoding="utf-8") as out:
                            out.write(text)
                        daemon.process.send_signal(signal.SIGHUP)
                        self.assertNotIn("READY", {key for message in manager.wait_for("RELOADING") for key in message})
                        manager.wait_for("READY")
                        daemon.wait_for(said)
                        self.assertEqual(daemon.end(), 0)
                        manager.wait_for("STOPPING")

    def test_it_stays_the_same_process_and_does_not_stop_when_the_page_adds_a_sensor(self):
        with ServiceManager() as manager, tempfile.TemporaryDirectory() as folder:
            config, token = os.path.join(folder, "wall.toml"), os.path.join(folder, "token")
            with open(config, "w", encoding="utf-8") as out:
                out.write(f'[http]\nlisten = "127.0.0.1:0"\ntoken_file = "{token}"\n')
            with open(token, "w", encoding="ascii") as out:
                out.write("correct horse battery staple\n")
            with Program(YURAGI, "run", "--config", config, "--listen", "127.0.0.1:0", env=manager.environment(STATE_DIRECTORY=folder)) as daemon:
                manager.wait_for("READY")
                base = daemon.wait_for(r"answering at (http://\S+)").group(1)
                body = b'{"name": "roof", "driver": "synthetic"}'
                fields = {"Content-Type": "application/json", "Authorization": "Bearer correct horse battery staple"}
                with urllib.request.urlopen(urllib.request.Request(base + "/api/v1/sensors", body, fields), timeout=HANG_S) as answer:
                    self.assertEqual(answer.status, 200)
                self.assertTrue(os.path.exists(os.path.join(folder, "page.toml")))
                again = manager.wait_for("RELOADING") + manager.wait_for("READY")
                self.assertNotIn("STOPPING", {key for message in again for key in message})
                daemon.wait_for("sensor roof: simulated")
                self.assertEqual(daemon.end(), 0)
                manager.wait_for("STOPPING")

    def test_record_is_ready_without_frames(self):
        with ServiceManager() as manager, tempfile.TemporaryDirectory() as folder:
            with Program(YURAGI, "record", os.path.join(folder, "a.windlog"), "--listen", "127.0.0.1:0",
                         env=manager.environment(WATCHDOG_USEC=str(int(WATCHDOG_S * 1e6)))) as daemon:
                manager.wait_for("READY")
                manager.wait_for("WATCHDOG")
                self.assertEqual(daemon.end(), 0)

    def test_the_watchdog_is_fed_while_it_goes_round_and_not_while_it_is_stopped(self):
        with ServiceManager() as manager, Program(
                YURAGI, "run", "--listen", "127.0.0.1:0",
                env=manager.environment(WATCHDOG_USEC=str(int(WATCHDOG_S * 1e6)))) as daemon:
            manager.wait_for("READY")
            begin = time.monotonic()
            for _ in range(4):
                self.assertEqual(manager.wait_for("WATCHDOG")[-1]["WATCHDOG"], "1")
            self.assertGreater(time.monotonic() - begin, 0.5 * WATCHDOG_S, "fed more often than every quarter")

            daemon.process.send_signal(signal.SIGSTOP)
            os.waitid(os.P_PID, daemon.process.pid, os.WSTOPPED | os.WNOWAIT)
            manager.take_all()
            self.assertIsNone(manager.next(WATCHDOG_S), "the manager would see it hang")
            daemon.process.send_signal(signal.SIGCONT)
            manager.wait_for("WATCHDOG")
            self.assertEqual(daemon.end(), 0)

    def test_another_process_s_watchdog_is_left_alone(self):
        with ServiceManager() as manager, Program(
                YURAGI, "run", "--listen", "127.0.0.1:0", "--duration", "1",
                env=manager.environment(WATCHDOG_USEC="40000", WATCHDOG_PID="1")) as daemon:
            messages = manager.wait_for("STOPPING")
            self.assertNotIn("WATCHDOG", {key for message in messages for key in message})
            self.assertEqual(daemon.process.wait(HANG_S), 0)

    def test_a_manager_that_hangs_holds_up_nothing_and_is_told_later(self):
        with ServiceManager() as manager:
            manager.fill()
            command = (YURAGI, "run", "--listen", "127.0.0.1:0")
            environment = manager.environment(WATCHDOG_USEC=str(int(WATCHDOG_S * 1e6)))
            with Program(*command, "--duration", "1", env=environment) as daemon:
                self.assertEqual(daemon.process.wait(HANG_S), 0, daemon.text())
            with Program(*command, env=environment) as daemon:
                host, port = daemon.address().rsplit(":", 1)
                with socket.create_connection((host, int(port)), HANG_S) as client:
                    self.assertTrue(client.recv(1), "it says hello")
                manager.wait_for("READY")  # behind what had filled the queue
                manager.wait_for("WATCHDOG")
                self.assertEqual(daemon.end(), 0)

    def test_a_manager_that_has_gone_is_no_fault(self):
        with Program(YURAGI, "run", "--listen", "127.0.0.1:0", "--duration", "1",
                     env={**os.environ, "NOTIFY_SOCKET": "/nonexistent/notify", "WATCHDOG_USEC": "40000"}) as daemon:
            self.assertEqual(daemon.process.wait(HANG_S), 0, daemon.text())


if __name__ == "__main__":
    unittest.main()
