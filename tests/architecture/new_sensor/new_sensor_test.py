#!/usr/bin/env python3
"""A sensor that follows CONTRIBUTING's recipe for one that sends lines is read, decoded, simulated and accepted, and takes ten files.

usage: new_sensor_test.py ROOT FOLDER_OF_PROGRAMS
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = pathlib.Path(sys.argv.pop()).resolve()
ROOT = pathlib.Path(sys.argv.pop()).resolve()
HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(ROOT / "tests/e2e"))
from programs import free_port  # pylint: disable=wrong-import-position
HANG_S = 300
MOST_FILES = 10


def recipe_files():
    """The files that the recipe names, for the Kestrel."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    recipe = re.search(r"## Add a sensor\n(.*?)\n## ", text, re.DOTALL).group(1)
    lines = re.search(r"(.*?)\nOther sensors", recipe, re.DOTALL).group(1)
    named = re.findall(r"`((?:drivers|simulators|tests|daemon|engine)/[^`]*\.(?:hpp|cpp|txt))`", lines)
    return {path.replace("FAMILY", "text").replace("NAME", "kestrel") for path in named}


def run(program, *arguments, **options):
    return subprocess.run([PROGRAMS / program, *arguments], capture_output=True, text=True, timeout=HANG_S, check=False, **options)


class Recipe(unittest.TestCase):
    def test_names_each_file_that_the_sensor_takes(self):
        files = recipe_files()
        made = {path.relative_to(HERE).as_posix() for path in HERE.rglob("*.[ch]pp")}
        self.assertEqual({path for path in files if "kestrel" in path}, made)
        for path in files - made:
            self.assertTrue((ROOT / path).is_file(), path)
        self.assertLessEqual(len(files), MOST_FILES, files)

    def test_gives_a_sensor_that_is_decoded_as_its_manual_has_it_and_refuses_what_is_hurt(self):
        done = run("kestrel_test")
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_gives_a_driver_that_every_command_knows(self):
        described = json.loads(run("yuragi", "sensors", "describe", "kestrel", "--json").stdout)
        self.assertIn("north_offset", json.dumps(described))
        decoded = json.loads(run("yuragi", "decode", "kestrel", input="$K,003.4,231.0*4C\n").stdout)
        self.assertEqual((decoded["speed_m_s"], decoded["direction_deg"]), (3.4, 231.0))
        self.assertIn("yuragi decode kestrel roof.log", run("yuragi", "decode", "--help").stdout)

    def test_gives_a_device_that_is_simulated_and_accepted(self):
        with tempfile.TemporaryDirectory(prefix="yuragi-kestrel-") as folder:
            config = pathlib.Path(folder, "wall.toml")
            config.write_text(f'[stream]\nlisten = "127.0.0.1:{free_port()}"\n[recording]\nfile = "{folder}/wall.windlog"\n'
                              '[[sensor]]\nname = "roof"\ndriver = "kestrel"\ndevice = "/dev/ttyUSB0"\nnorth_offset = 90\n'
                              '[[scene]]\nkind = "grass"\nblades_across = 8\nblades_deep = 8\n', encoding="utf-8")
            done = run("yuragi", "accept", "--config", config, "--for", "4", "--out", pathlib.Path(folder, "page.html"),
                       "--simulated-only", "--json")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            (roof,) = json.loads(done.stdout)["simulated"]
            self.assertIn(roof["verdict"], ("passed", "remark"), roof)


if __name__ == "__main__":
    unittest.main()
