#!/usr/bin/env python3
"""The Debian package: made twice from programs that are built, looked at, installed, upgraded, rolled back, removed and purged.

usage: package_test.py PROJECT_ROOT BUILD_FOLDER

The tree into which it is installed is empty but for dpkg's own records: what it depends on is not there, and nothing of it is
run. tests/package/by_hand.sh does that in a whole system.
"""
import hashlib
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

ROOT, BUILD = (pathlib.Path(word).resolve() for word in (sys.argv.pop(1), sys.argv.pop(1)))
EPOCH_S = 1_700_000_000
CONFIGURATION = "etc/yuragi/yuragi.toml"
RECORDING = "var/lib/yuragi/wind.windlog"
# Files that the programs of an installation make when the guide's advice is followed: tokens, alerts, paired browsers, caches.
MADE_IN_USE = [
    "etc/yuragi/token",
    "etc/yuragi/token.part-4711",
    "etc/yuragi/yuragi.toml.bak",
    "etc/yuragi/yuragi.toml.pairings.json",
    "var/lib/systemd/timers/stamp-yuragi-report.timer",
    "var/lib/yuragi/alerts.json",
    "var/lib/yuragi/alerts.json.part-4711",
    "var/lib/yuragi/motion.snapshot",
    "var/lib/yuragi/page.toml",
    "var/lib/yuragi/page.toml.before",
    "var/lib/yuragi/pairings.json",
    "var/lib/yuragi/pairings.json.damaged",
    "var/lib/yuragi/site.json",
    "var/lib/yuragi/site.json.unreadable-2",
    "var/lib/yuragi/.cache/mesa_shader_cache/72/b70b",
    "var/lib/yuragi/.local/share/xorg/Xorg.7.log",
]
# Files of a person: a purge leaves them.
OF_A_PERSON = [
    "etc/yuragi/mqtt-password",
    "var/lib/yuragi/wind.2026-11-26.windlog",
    "var/lib/yuragi/reports/2026-11-26.html",
]
PROGRAMS = ["yuragi", "yuragi-sim", "yuragi-viewer"]
EXAMPLE = "usr/share/yuragi/yuragi.toml"
CONTENTS = [
    EXAMPLE,
    *[f"usr/bin/{name}" for name in PROGRAMS],
    *[f"usr/share/man/man1/{name}.1.gz" for name in PROGRAMS],
    *[f"usr/share/bash-completion/completions/{name}" for name in PROGRAMS],
    *[f"lib/systemd/system/{name}" for name in ("yuragi.service", "yuragi-viewer@.service", "yuragi-report.service",
                                                "yuragi-report.timer")],
    "usr/lib/sysusers.d/yuragi.conf",
    "usr/lib/udev/rules.d/70-yuragi.rules",
    "usr/lib/yuragi/daily-report",
    "usr/share/doc/yuragi/changelog.gz",
    "usr/share/doc/yuragi/copyright",
    *[f"usr/share/doc/yuragi/examples/{name}" for name in ("yuragi_client.py", "wind_to_osc.py", "pose.fbs", "wall.toml")],
    *[f"usr/share/yuragi/guide/{name}" for name in ("index.html", "keys.html", "troubleshooting.html", "guide.css")],
    "usr/share/yuragi/profiles/generic-rs485-cup.toml",
]


def run(*command, **options):
    """What the command says; its failure is the test's."""
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}:\n{done.stdout}")
    return done.stdout


def make_package(folder):
    # Compressed as it is soonest done: the bytes within are what is looked at.
    run("cpack", "-G", "DEB", "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip", "-B", folder, cwd=BUILD,
        env={**os.environ, "SOURCE_DATE_EPOCH": str(EPOCH_S)})
    return next(folder.glob("*.deb"))


def pack(tree):
    """The package of a tree, beside it."""
    package = tree.with_suffix(".deb")
    run("dpkg-deb", "--root-owner-group", "-Zgzip", "-z1", "-b", tree, package)
    return package


def service_group(tree):
    """The number of the service's group in this system."""
    return int(re.search(r"^yuragi:[^:]*:(\d+):", (tree / "etc/group").read_text(encoding="utf-8"), re.MULTILINE)[1])


def files_below(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if not path.is_dir() or path.is_symlink()}


class PackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="yuragi-package-")
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.package = make_package(cls.folder / "first")
        cls.contents = cls.folder / "contents"
        run("dpkg-deb", "-R", cls.package, cls.contents)
        cls.version = run("dpkg-deb", "-f", cls.package, "Version").strip()
        cls.small = cls.folder / "small"  # the same, but its programs are a line: dpkg installs it many times in a moment
        shutil.copytree(cls.contents, cls.small, symlinks=True)
        for name in PROGRAMS:
            (cls.small / "usr/bin" / name).write_text("#!/bin/false\n", encoding="ascii")
        cls.small_package = pack(cls.small)

    def test_two_builds_give_the_same_bytes(self):
        second = make_package(self.folder / "second")
        digests = {hashlib.sha256(path.read_bytes()).hexdigest() for path in (self.package, second)}
        self.assertEqual(len(digests), 1)

    def test_its_name_has_the_version_the_distribution_and_the_architecture(self):
        architecture = run("dpkg", "--print-architecture").strip()
        self.assertEqual(self.package.name, f"yuragi_{self.version}_{architecture}.deb")
        project = re.search(r"project\(yuragi VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
        system = platform.freedesktop_os_release()
        distribution = {"debian": "deb"}.get(system["ID"], system["ID"]) + system["VERSION_ID"]
        self.assertEqual(self.version, f"{project.group(1)}+{distribution}")

    def test_everything_is_in_it_and_belongs_to_root(self):
        present = files_below(self.contents)
        self.assertEqual([path for path in CONTENTS if path not in present], [])
        with subprocess.Popen(["dpkg-deb", "--fsys-tarfile", self.package], stdout=subprocess.PIPE) as unpacked:
            with tarfile.open(fileobj=unpacked.stdout, mode="r|") as archive:
                for member in archive:
                    self.assertEqual((member.uid, member.gid, member.mtime), (0, 0, EPOCH_S), member.name)
                    self.assertFalse(member.mode & 0o022, f"{member.name} can be written by others")
        self.assertFalse((self.contents / "DEBIAN/conffiles").exists(), "dpkg asks about them at an upgrade")
        self.assertFalse((self.contents / CONFIGURATION).exists())
        self.assertIn('[http]\nlisten = "127.0.0.1:7480"\n', (self.contents / EXAMPLE).read_text(encoding="utf-8"))

    def test_it_depends_on_the_libraries_that_are_linked(self):
        depends = run("dpkg-deb", "-f", self.package, "Depends")
        for library in ("libc6", "libsqlite3-0", "libfftw3-double3", "libglfw3", "gnuplot-nox"):
            self.assertIn(library, depends)

    def test_each_unit_starts_what_is_in_it_or_is_recommended(self):
        for unit in (self.contents / "lib/systemd/system").glob("*.service"):
            text = unit.read_text(encoding="utf-8").replace("\\\n", " ")
            for program in re.findall(r"(?:=|\s)(/usr/(?:bin|lib)/\S+)", text):
                if program not in ("/usr/bin/xinit", "/usr/bin/Xorg"):
                    self.assertTrue(os.access(self.contents / program[1:], os.X_OK), f"{unit.name}: {program}")

    @unittest.skipUnless(shutil.which("man"), "man is not installed")
    def test_the_manual_pages_are_read_without_a_warning(self):
        for name in PROGRAMS:
            page = self.contents / f"usr/share/man/man1/{name}.1.gz"
            done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", str(page)], capture_output=True, text=True, check=False,
                                  env={**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "80"})
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("--help", done.stdout)
        self.assertIn("calibrate span", run("man", "-E", "UTF-8", "-l", self.contents / "usr/share/man/man1/yuragi.1.gz",
                                            env={**os.environ, "LC_ALL": "C.UTF-8"}))

    def completions(self, *words):
        """What bash would offer for the last word."""
        script = self.contents / "usr/share/bash-completion/completions" / words[0]
        function = "_" + words[0].replace("-", "_")
        return run("bash", "-c", f'source "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); {function}; echo "${{COMPREPLY[@]}}"',
                   script, *words).split()

    def test_bash_completes_subcommands_and_options(self):
        self.assertEqual(self.completions("yuragi", "check"), ["check-config"])
        self.assertEqual(self.completions("yuragi", "player", "st"), ["status", "step"])
        self.assertIn("--config", self.completions("yuragi", "run", "--verbose", "--"))
        self.assertEqual(self.completions("yuragi", "run", "--config", "gar"), [])  # left to the names of files
        self.assertIn("--fullscreen", self.completions("yuragi-viewer", "--"))

    def test_bash_completes_values_and_drivers(self):
        self.assertEqual(self.completions("yuragi", "spectrum", "--model", "k"), ["kaimal"])
        self.assertEqual(self.completions("yuragi", "spectrum", "--model", "kaimal", "--mod"), ["--model"])
        self.assertEqual(self.completions("yuragi", "sensors", "describe", "mo"), ["modbus"])

    @unittest.skipUnless(shutil.which("lintian"), "lintian is not installed")
    def test_lintian_has_nothing_to_say(self):
        done = subprocess.run(["lintian", "--allow-root", "--tag-display-limit", "0", self.package], check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, ""))

    def other_version(self, name, version, change):
        """The small package with another version; `change` is called with its tree."""
        tree = self.folder / name
        shutil.copytree(self.small, tree, symlinks=True)
        control = tree / "DEBIAN/control"
        control.write_text(re.sub(r"^Version: .*$", f"Version: {version}", control.read_text(encoding="utf-8"), flags=re.M),
                           encoding="utf-8")
        change(tree)
        return pack(tree)

    def next_version(self):
        """With another example configuration."""
        def change(tree):
            with open(tree / EXAMPLE, "a", encoding="utf-8") as example:
                example.write("# The next version's example has more.\n")
        return self.other_version("next", "99.0", change)

    def old_version(self):
        """As packages were: the configuration is dpkg's own file, and no script makes it."""
        def change(tree):
            (tree / CONFIGURATION).parent.mkdir(parents=True)
            (tree / EXAMPLE).rename(tree / CONFIGURATION)
            with open(tree / CONFIGURATION, "a", encoding="utf-8") as example:
                example.write("# The older example.\n")
            (tree / "DEBIAN/conffiles").write_text(f"/{CONFIGURATION}\n", encoding="utf-8")
            for script in ("postinst", "postrm"):
                (tree / "DEBIAN" / script).unlink()
        return self.other_version("old", "0.0.1", change)

    def new_tree(self, name):
        """An empty system, and dpkg in it. It has nobody to ask: a question ends it with an error."""
        tree = self.folder / name
        for folder in ("etc", "var/lib/dpkg/info", "var/lib/dpkg/updates", "var/lib/dpkg/triggers"):
            (tree / folder).mkdir(parents=True)
        (tree / "var/lib/dpkg/status").touch()
        (tree / "var/lib/dpkg/available").touch()
        return tree, lambda *words: run("dpkg", f"--root={tree}", "--force-script-chrootless", "--force-depends", "--force-unsafe-io",
                                        "--log=/dev/null", *words, stdin=subprocess.DEVNULL)

    @unittest.skipUnless(os.geteuid() == 0, "dpkg gives files to root: this needs to be root")
    def test_an_upgrade_from_an_older_package_asks_nothing_and_keeps_the_configuration(self):
        for edit in ("", "# ours\n"):
            tree, dpkg = self.new_tree(f"upgraded{len(edit)}")
            dpkg("-i", self.old_version() if not edit else self.folder / "old.deb")
            own = (tree / CONFIGURATION).read_text(encoding="utf-8") + edit
            (tree / CONFIGURATION).write_text(own, encoding="utf-8")
            dpkg("-i", self.small_package)
            self.assertEqual((tree / CONFIGURATION).read_text(encoding="utf-8"), own)
            self.assertEqual(list((tree / CONFIGURATION).parent.iterdir()), [tree / CONFIGURATION])
            self.assertEqual((tree / CONFIGURATION).stat().st_gid, service_group(tree))
            os.chown(tree / CONFIGURATION, -1, 12345)
            dpkg("-i", self.small_package)
            self.assertEqual((tree / CONFIGURATION).stat().st_gid, 12345, "a person's choice")
            dpkg("-P", "yuragi")
            self.assertFalse((tree / CONFIGURATION).parent.exists())

    @unittest.skipUnless(os.geteuid() == 0, "dpkg gives files to root: this needs to be root")
    def test_a_configuration_that_is_missing_is_made_again_and_another_is_left(self):
        tree, dpkg = self.new_tree("missing")
        dpkg("-i", self.small_package)
        made = (tree / CONFIGURATION).read_text(encoding="utf-8")
        self.assertEqual(made, (self.contents / EXAMPLE).read_text(encoding="utf-8"))
        # With it the token's file, which `yuragi token --new` gives to the configuration's group, can be read by the service.
        self.assertEqual((tree / CONFIGURATION).stat().st_gid, service_group(tree))
        (tree / CONFIGURATION).unlink()
        (tree / CONFIGURATION).symlink_to("elsewhere.toml")
        dpkg("-i", self.small_package)
        self.assertTrue((tree / CONFIGURATION).is_symlink())
        (tree / CONFIGURATION).unlink()
        dpkg("-i", self.small_package)
        self.assertEqual((tree / CONFIGURATION).read_text(encoding="utf-8"), made)

    @unittest.skipUnless(os.geteuid() == 0, "dpkg gives files to root: this needs to be root")
    def test_it_installs_upgrades_rolls_back_and_leaves_no_trace_but_recordings(self):
        tree, dpkg = self.new_tree("tree")

        def configuration():
            return (tree / CONFIGURATION).read_text(encoding="utf-8")

        dpkg("-i", self.package)  # the programs themselves, once
        self.assertRegex((tree / "etc/passwd").read_text(encoding="utf-8"),
                         r"^yuragi:x:\d+:\d+:Yuragi:/var/lib/yuragi:/usr/sbin/nologin\n")
        self.assertFalse((tree / "etc/systemd").exists(), "it enables something by itself")

        own = configuration() + "# ours\n"
        (tree / CONFIGURATION).write_text(own, encoding="utf-8")
        (tree / RECORDING).parent.mkdir(parents=True)
        (tree / RECORDING).write_text("months", encoding="utf-8")
        link = tree / "etc/systemd/system/multi-user.target.wants/yuragi.service"
        link.parent.mkdir(parents=True)
        link.symlink_to("/lib/systemd/system/yuragi.service")

        dpkg("-i", self.next_version())
        self.assertEqual(configuration(), own)
        self.assertTrue(link.is_symlink())
        dpkg("-i", self.small_package)  # back again
        self.assertEqual(configuration(), own)
        self.assertTrue(link.is_symlink())
        self.assertEqual((tree / RECORDING).read_text(encoding="utf-8"), "months")

        dpkg("-r", "yuragi")
        self.assertFalse(link.is_symlink())
        self.assertEqual(configuration(), own)
        self.assertFalse((tree / "usr/bin/yuragi").exists())
        said = dpkg("-P", "yuragi")
        self.assertIn("recordings", said)
        left = {path for path in files_below(tree) if not path.startswith("var/lib/dpkg/")}
        self.assertEqual(left - {f"etc/{name}" for name in ("passwd", "group", "shadow", "gshadow", ".pwd.lock")}, {RECORDING})

        dpkg("-i", self.small_package)
        (tree / RECORDING).unlink()
        dpkg("-P", "yuragi")
        self.assertFalse((tree / RECORDING).parent.exists())

    @unittest.skipUnless(os.geteuid() == 0, "dpkg gives files to root: this needs to be root")
    def test_a_purge_removes_what_the_programs_made_and_names_where_the_rest_is(self):
        tree, dpkg = self.new_tree("purged")
        dpkg("-i", self.small_package)
        present = files_below(tree / "etc")
        for path in [*MADE_IN_USE, *OF_A_PERSON]:
            (tree / path).parent.mkdir(parents=True, exist_ok=True)
            (tree / path).write_text("here", encoding="utf-8")
        dpkg("-r", "yuragi")
        self.assertEqual([path for path in [*MADE_IN_USE, *OF_A_PERSON] if not (tree / path).is_file()], [])
        said = dpkg("-P", "yuragi")
        for folder in ("etc/yuragi", "var/lib/yuragi"):
            self.assertIn(f"{folder} has files that a purge does not remove", said)
            self.assertEqual(files_below(tree / folder), {path.removeprefix(folder + "/") for path in OF_A_PERSON if path.startswith(folder)})
        self.assertEqual({f"etc/{path}" for path in present - files_below(tree / "etc")}, {CONFIGURATION})
        self.assertEqual([path.name for path in (tree / "var/lib/yuragi").iterdir() if path.name.startswith(".")], [])

        dpkg("-i", self.small_package)
        for path in OF_A_PERSON:
            (tree / path).unlink()
        self.assertNotIn("does not remove", dpkg("-P", "yuragi"))
        self.assertEqual([folder for folder in ("etc/yuragi", "var/lib/yuragi") if (tree / folder).exists()], [])


if __name__ == "__main__":
    unittest.main()
