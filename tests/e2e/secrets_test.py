#!/usr/bin/env python3
"""Passwords: in nothing that is printed, streamed or recorded, and taken out of recordings that hold them.

usage: secrets_test.py FOLDER_OF_PROGRAMS FOLDER_OF_SCHEMA_MODULES
"""
import os
import sqlite3
import stat
import subprocess
import sys
import tempfile
import unittest

import pose_client
from programs import HANG_S, Program, free_port

BIN, SCHEMA_MODULES = (os.path.abspath(word) for word in (sys.argv.pop(1), sys.argv.pop(1)))
YURAGI = os.path.join(BIN, "yuragi")
PASSWORD = "hunter2-correct-horse"


def run(*arguments):
    return subprocess.run([YURAGI, *map(str, arguments)], capture_output=True, text=True, timeout=HANG_S, check=False)


class Secrets(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def file(self, name, text=None, mode=0o640):
        path = os.path.join(self.folder, name)
        if text is not None:
            with open(path, "w", encoding="utf-8") as out:
                out.write(text)
            os.chmod(path, mode)
        return path

    def start(self, *command):
        program = Program(*command)
        self.addCleanup(program.__exit__)
        return program

    def start_broker(self):
        """One that lets in only who knows the password."""
        passwords = self.file("broker-passwords")
        subprocess.run(["mosquitto_passwd", "-c", "-b", passwords, "garden", PASSWORD], check=True, timeout=HANG_S)
        port = free_port()
        self.start("mosquitto", "-c", self.file("broker.conf", f"listener {port} 127.0.0.1\nuser root\npersistence false\n"
                                                               f"password_file {passwords}\n")).wait_for("running")
        return port

    def publish(self, port, speed):
        subprocess.run(["mosquitto_pub", "-h", "127.0.0.1", "-p", str(port), "-u", "garden", "-P", PASSWORD, "-q", "1",
                        "-t", "garden/speed", "-m", str(speed)], check=True, timeout=HANG_S)

    def mqtt_config(self, lines, port=1883, mode=0o640):
        return self.file("wall.toml", '[[sensor]]\nname = "garden"\ndriver = "mqtt"\ntopic = "garden/speed"\n'
                                      f'user = "garden"\nport = {port}\n' + lines, mode)

    def files_with_password(self, *names):
        found = []
        for name in names:
            with open(self.file(name), "rb") as content:
                found += [name] if PASSWORD.encode() in content.read() else []
        return found

    def recording_with_passwords(self, name):
        """As the versions wrote it that recorded passwords."""
        path = self.file(name)
        self.assertEqual(run("record", path, "--listen", "127.0.0.1:0", "--duration", "1.5").returncode, 0)
        database = sqlite3.connect(path)
        with database:
            options = f"password = '{PASSWORD}'\nuser = 'garden'"
            database.execute("UPDATE session SET configuration = ?",
                             (f"seed = 3\n\n[[sensor]]\ndriver = 'mqtt'\n{options}\n",))
            database.execute("UPDATE sensor SET driver = 'mqtt', options = ?", (options,))
        database.close()
        return path

    def test_a_password_that_is_used_is_seen_nowhere(self):
        port = self.start_broker()
        config = self.mqtt_config(f'password = "{PASSWORD}"\n', port)
        daemon = self.start(YURAGI, "run", "--listen", "127.0.0.1:0", "--config", config, "--record", self.file("a.windlog"),
                            "--verbose")
        address = daemon.address()
        daemon.wait_for("waits for wind|garden")
        watch = self.start(YURAGI, "sensors", "watch", "--raw", "garden", "--connect", address)
        streamed = pose_client.SocketBytes(address, HANG_S)
        streamed.send(pose_client.subscribe_message(False, True, "secrets_test.py", "garden"))
        said = b""
        while b"5.25" not in said or "5.25" not in watch.text():  # both show the message
            self.publish(port, 5.25)
            said += streamed.socket.recv(65536)
        self.assertEqual(stat.S_IMODE(os.stat(self.file("a.windlog")).st_mode), 0o640)
        self.assertEqual(self.files_with_password("a.windlog", "a.windlog-wal"), [])
        self.assertNotIn(PASSWORD.encode(), said)
        streamed.socket.close()
        watch.end()
        self.assertEqual(daemon.end(), 0)
        self.assertNotIn("everybody", daemon.text())
        outputs = [daemon.text(), watch.text()]
        for command in (["check-config", config], ["check-config", "--full", config], ["report", self.file("a.windlog"), "-o", self.file("a.html")],
                        ["export", self.file("a.windlog"), "-o", "-"]):
            done = run(*command)
            self.assertEqual(done.returncode, 0, done.stderr)
            outputs.append(done.stdout + done.stderr)
        for output in outputs:
            self.assertNotIn(PASSWORD, output)
        self.assertEqual(self.files_with_password("a.windlog", "a.html"), [])
        self.assertIn("password = '(secret)'", outputs[3])

    def test_what_was_printed_in_place_of_a_password_is_no_password(self):
        config = self.mqtt_config(f'password = "{PASSWORD}"\n')
        printed = self.file("printed.toml", run("check-config", "--full", config).stdout)
        for command in (["check-config", printed], ["run", "--listen", "127.0.0.1:0", "--config", printed]):
            done = run(*command)
            self.assertEqual(done.returncode, 78)
            self.assertRegex(done.stderr, r'printed\.toml:\d+:\d+: sensor: password: is "\(secret\)", which stands for it')

    def test_who_can_read_a_password_is_told(self):
        config = self.mqtt_config(f'password = "{PASSWORD}"\n', mode=0o644)
        for command in (["check-config", config], ["run", "--listen", "127.0.0.1:0", "--config", config, "--duration", "0.1"]):
            done = run(*command)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{config}:1:1: sensor.password: everybody on this machine can read {config}; chmod 640 {config}",
                          done.stderr)
        secret = self.file("secret", PASSWORD + "\n", 0o644)
        config = self.mqtt_config(f'password_file = "{secret}"\n', mode=0o644)
        self.assertIn(f"sensor.password_file: everybody on this machine can read {secret};", run("check-config", config).stderr)
        os.chmod(secret, 0o640)
        self.assertEqual(run("check-config", config).stderr, "")

    def test_a_password_is_taken_out_of_an_old_recording(self):
        path = self.recording_with_passwords("old.windlog")
        os.chmod(path, 0o600)
        before = run("export", path, "-o", "-").stdout
        self.assertEqual(self.files_with_password("old.windlog"), ["old.windlog"])
        done = run("clean-secrets", path)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, path + ": 2 secrets taken out\n", ""))
        self.assertEqual(os.listdir(self.folder), ["old.windlog"])
        self.assertEqual(self.files_with_password("old.windlog"), [])
        self.assertEqual(stat.S_IMODE(os.stat(path).st_mode), 0o600)
        self.assertEqual(run("export", path, "-o", "-").stdout, before, "the readings are as they were")
        self.assertGreater(before.count("\n"), 5)
        database = sqlite3.connect(path)
        self.assertEqual(database.execute("SELECT configuration FROM session").fetchall(),
                         [("seed = 3\n\n[[sensor]]\ndriver = 'mqtt'\npassword = \"(secret)\"\nuser = 'garden'\n",)])
        self.assertEqual(database.execute("SELECT DISTINCT options FROM sensor").fetchall(),
                         [("password = \"(secret)\"\nuser = 'garden'",)])
        database.close()
        done = run("clean-secrets", path)
        self.assertEqual((done.returncode, done.stdout), (0, path + ": has no secrets in it\n"))

    def test_each_recording_is_cleaned_or_it_is_told_why_not(self):
        old = self.recording_with_passwords("old.windlog")
        odd = self.recording_with_passwords("odd.windlog")
        database = sqlite3.connect(odd)
        with database:
            database.execute("UPDATE session SET configuration = ?", ("password = " + PASSWORD,))
        database.close()
        live = self.file("live.windlog")
        recorder = self.start(YURAGI, "record", live, "--listen", "127.0.0.1:0")
        recorder.address()
        done = run("clean-secrets", self.file("none.windlog"), live, odd, old)
        self.assertEqual(done.returncode, 66, "of the first that failed")
        self.assertEqual(done.stdout, f"{odd}: 1 secret taken out\n{old}: 2 secrets taken out\n")
        self.assertIn("none.windlog: the recording does not exist", done.stderr)
        self.assertRegex(done.stderr, r"another program \(process \d+\) records to \S*/live.windlog: end it, or choose another file")
        self.assertIn("odd.windlog: 1 configuration cannot be read as TOML", done.stderr)
        self.assertNotIn(PASSWORD, done.stdout + done.stderr)
        self.assertEqual(recorder.end(), 0)
        self.assertEqual(run("clean-secrets", live).returncode, 0)
        self.assertEqual(run("clean-secrets", odd).returncode, 65)


if __name__ == "__main__":
    pose_client.load_schema(SCHEMA_MODULES)
    unittest.main(verbosity=2)
