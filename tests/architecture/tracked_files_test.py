#!/usr/bin/env python3
"""A clone has every file that is here: git leaves nothing out of the project's folders but what Python caches. And it has
nothing that a build makes: no page beside the text that it is made from.

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


def made_pages(paths):
    """The HTML files that stand beside a Markdown file of their name."""
    pages = {path.with_suffix(".html") for path in paths if path.suffix == ".md"}
    return sorted(path.as_posix() for path in pages.intersection(paths))


@unittest.skipUnless((ROOT / ".git").exists(), "no git checkout")
class TrackedFilesTest(unittest.TestCase):
    def test_no_file_of_the_project_is_ignored(self):
        self.assertEqual(left_out(ROOT, FOLDERS), [],
                         "git ignores these, so that a clone lacks them: .gitignore needs an exception")

    def test_no_page_that_is_made_is_tracked(self):
        command = ["git", "-c", "safe.directory=*", "-C", ROOT, "ls-files", "--", *FOLDERS]
        said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
        self.assertEqual(made_pages({pathlib.PurePosixPath(path) for path in said.splitlines()}), [])

    def test_a_made_page_would_be_found(self):
        paths = {pathlib.PurePosixPath(path) for path in ("guide/a.md", "guide/a.html", "page/index.html")}
        self.assertEqual(made_pages(paths), ["guide/a.html"])

    def test_an_ignored_file_would_be_found(self):
        path = ROOT / "build" / "tracked_files_test.tmp"
        path.parent.mkdir(exist_ok=True)
        path.touch()
        self.addCleanup(path.unlink)
        self.assertIn("build/tracked_files_test.tmp", left_out(ROOT, ["build/tracked_files_test.tmp"]))


if __name__ == "__main__":
    unittest.main()
