#!/usr/bin/env python3
"""yuragi support-bundle: what is in it, who may read it, and that no secret is.

usage: support_bundle_test.py FOLDER_OF_PROGRAMS
"""
import os
import stat
import subprocess
import sys
import tarfile
import tempfile
import unittest

from programs import HANG_S, Program

BIN = os.path.abspath(sys.argv.pop(1))
YURAGI = os.path.join(BIN, "yuragi")
SECRETS = {"text": "hunter2-correct-horse", "file": "battery-staple-42", "environment": "tr0ub4dor-and-3",
           "comment": "an-old-password-of-ours"}


class SupportBundle(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="yuragi-bundle-")
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.environment = {**os.environ, "GARDEN_PASSWORD": SECRETS["environment"]}

    def path(self, name, text=None):
        path = os.path.join(self.folder, name)
        if text is not None:
            with open(path, "w", encoding="utf-8") as out:
                out.write(text)
            os.chmod(path, 0o640)
        return path

    def config(self):
        mqtt = '[[sensor]]\ndriver = "mqtt"\nport = 1\nuser = "garden"\n'
        return self.path("wall.toml", f"# password = '{SECRETS['comment']}'\n"
                         f'[recording]\nfile = "{self.path("wall.windlog")}"\n'
                         '[[sensor]]\nname = "made-up"\ndriver = "synthetic"\n'
                         f'{mqtt}name = "a"\ntopic = "garden/a"\npassword = "{SECRETS["text"]}"\n'
                         f'{mqtt}name = "b"\ntopic = "garden/b"\npassword_file = "{self.path("password", SECRETS["file"])}"\n'
                         f'{mqtt}name = "c"\ntopic = "garden/c"\npassword_env = "GARDEN_PASSWORD"\n')

    def bundle(self, *options):
        """Makes one and answers its texts by name."""
        archive = self.path("bundle.tar.gz")
        done = subprocess.run([YURAGI, "support-bundle", "--out", archive, *options], capture_output=True, text=True,
                              timeout=HANG_S, check=False, env=self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(stat.S_IMODE(os.stat(archive).st_mode), 0o640)
        with tarfile.open(archive) as packed:
            self.assertEqual({name.split("/")[0].rsplit("-", 1)[0] for name in packed.getnames()}, {"yuragi-support"})
            return {os.path.basename(member.name): packed.extractfile(member).read().decode("utf-8", "replace")
                    for member in packed if member.isfile()}

    def test_it_holds_what_helps_and_no_secret(self):
        config = self.config()
        with Program(YURAGI, "run", "--config", config, "--listen", "127.0.0.1:0", env=self.environment) as daemon:
            with Program(YURAGI, "sensors", "watch", "--connect", daemon.address()) as watch:
                watch.wait_for(r"recorded [1-9]")
            files = self.bundle("--config", config, "--connect", daemon.address(), "--readings")
            self.assertEqual(daemon.end(), 0)
        for name, text in files.items():
            for place, secret in SECRETS.items():
                self.assertNotIn(secret, text, f"the one in the {place}, in {name}")
        for name in ("README.txt", "configuration.toml", "configuration-full.toml", "doctor.txt", "doctor.json", "status.txt",
                     "status.json", "recording.txt", "recording-last-hour.csv", "kernel.txt", "os-release.txt"):
            self.assertTrue(files[name], name)
        self.assertIn("MQTT broker 127.0.0.1:1: cannot be reached", files["doctor.txt"])
        self.assertRegex(files["recording.txt"], r"session 1: .*\n(.*\n)*sensor made-up \(synthetic\): [1-9]")
        self.assertIn("made-up", files["recording-last-hour.csv"])
        self.assertNotIn("host-name.txt", files)

    def test_a_file_that_is_there_stays(self):
        self.path("bundle.tar.gz", "mine")
        done = subprocess.run([YURAGI, "support-bundle", "--out", self.path("bundle.tar.gz")], capture_output=True, text=True,
                              timeout=HANG_S, check=False)
        self.assertEqual(done.returncode, 73)
        self.assertIn("exists already", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
