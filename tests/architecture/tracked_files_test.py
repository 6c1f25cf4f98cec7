#!/usr/bin/env python3
"""A clone has every file that is here: git leaves nothing out of the project's folders but what Python caches.

usage: tracked_files_test.py PROJECT_ROOT
"""
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
FOLDERS = "config daemon drivers engine simulators tests viewer".split()


def left_out(root, folders):
    """The files below `folders` that git ignores, without Python's caches."""
    command = ["git", "-c", "safe.directory=*", "-C", root, "ls-files", "--others", "--ignored", "--exclude-standard", "--",
               *folders]
    said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    return [path for path in said.splitlines() if "__pycache__/" not in path]


@unittest.skipUnless((ROOT / ".git").exists(), "no git checkout")
class TrackedFilesTest(unittest.TestCase):
    def test_no_file_of_the_project_is_ignored(self):
        self.assertEqual(left_out(ROOT, FOLDERS), [],
                         "git ignores these, so that a clone lacks them: .gitignore needs an exception")

    def test_an_ignored_file_would_be_found(self):
        path = ROOT / "build" / "tracked_files_test.tmp"
        path.parent.mkdir(exist_ok=True)
        path.touch()
        self.addCleanup(path.unlink)
        self.assertIn("build/tracked_files_test.tmp", left_out(ROOT, ["build/tracked_files_test.tmp"]))


if __name__ == "__main__":
    unittest.main()
