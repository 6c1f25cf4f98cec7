#!/usr/bin/env python3
"""Films of a recording by `yuragi-viewer --render`: whole and the same every time, or a clear error and nothing that looks whole.

usage: film_test.py DIRECTORY-OF-THE-PROGRAMS

All but one draw nothing. ffmpeg is a stand-in that keeps the pictures as they are, or hurts itself.
"""
import hashlib
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from programs import HANG_S

PROGRAMS = pathlib.Path(sys.argv.pop(1))
WIDTH, HEIGHT, FPS = 160, 90, 24
PICTURE = 3 * WIDTH * HEIGHT
SCENES = """
[look]
quality = "low"
[[scene]]
kind = "grass"
name = "patch"
blades_across = 20
blades_deep = 20
[[scene]]
kind = "flag"
name = "mast"
"""
KEEPS = '#!/bin/sh\nfor last; do :; done\nexec cat > "${last#file:}"\n'
DIES = '#!/bin/sh\nfor last; do :; done\nhead -c 100000 > "${last#file:}"\nkill -9 $$\n'
FAILS = '#!/bin/sh\nfor last; do :; done\ncat > "${last#file:}"\necho "no space left" >&2\nexit 1\n'


def children_of(pid):
    """The processes that a process has begun."""
    return [int(child) for task in pathlib.Path(f"/proc/{pid}/task").iterdir() for child in (task / "children").read_text().split()]


def is_running(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def record(folder, moments):
    """A recording with a reading at each of these seconds."""
    (folder / "wind.csv").write_text("time,speed\n" + "".join(
        f"2026-05-01T12:{second // 60:02.0f}:{second % 60:06.3f}Z,{3 + i % 5}\n" for i, second in enumerate(moments)))
    recording = folder / "wind.windlog"
    subprocess.run([PROGRAMS / "yuragi", "import", folder / "wind.csv", "-o", recording], check=True, capture_output=True)
    return recording


class Film(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        signal.signal(signal.SIGHUP, signal.SIG_DFL)  # nohup would have films ignore it
        cls.kept = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.kept.name)
        (folder / "scenes.toml").write_text(SCENES)
        cls.recording = record(folder, [i / 4 for i in range(240)])
        cls.config = folder / "scenes.toml"

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def command(self, *words, drawn=False):
        words = [str(word) for word in words]
        command = [str(PROGRAMS / "yuragi-viewer")]
        for name, value in (("--render", self.recording), ("--config", self.config), ("--size", f"{WIDTH}x{HEIGHT}"), ("--fps", FPS)):
            if name not in words:
                command += [name, str(value)]
        return command + ([] if drawn else ["--draw-nothing"]) + words

    def environment(self, ffmpeg=None):
        """Without a display, and with this ffmpeg alone."""
        others = self.folder / "programs"
        others.mkdir(exist_ok=True)
        if ffmpeg:
            (others / "ffmpeg").write_text(ffmpeg)
            (others / "ffmpeg").chmod(0o755)
            for tool in ("cat", "head"):
                if not (others / tool).exists():
                    (others / tool).symlink_to(f"/usr/bin/{tool}")
        kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        return {**kept, "PATH": str(others)}

    def make(self, *words, code=0, drawn=False, ffmpeg=None, **options):
        """Runs it to its end; what it wrote and said."""
        done = subprocess.run(self.command(*words, drawn=drawn), env=self.environment(ffmpeg), timeout=HANG_S, check=False,
                              **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options})
        said = done.stderr.decode()
        self.assertEqual(done.returncode, code, said)
        return done.stdout, said

    def begin(self, *words, **options):
        """A film that goes on until the test ends it."""
        return subprocess.Popen(self.command(*words), env=self.environment(options.pop("ffmpeg", None)), stderr=subprocess.PIPE, **options)

    def end(self, film, code):
        said = film.communicate(timeout=HANG_S)[1].decode()
        self.assertEqual(film.returncode, code, said)
        return said

    def assert_ended(self, pids):
        until = time.monotonic() + HANG_S
        while any(map(is_running, pids)):
            self.assertLess(time.monotonic(), until, "an orphan is left")
            time.sleep(0.01)

    def test_the_same_film_twice_is_the_same_bit_for_bit(self):
        films = []
        for name in ("first", "second"):
            self.make("--scene", "patch", "--duration", 0.06, "--from", 5, "--samples", 1, "--out", self.folder / name, drawn=True)
            pictures = sorted((self.folder / name).iterdir())
            self.assertEqual([picture.name for picture in pictures], ["000001.png", "000002.png"])
            films.append([hashlib.sha256(picture.read_bytes()).hexdigest() for picture in pictures])
        self.assertEqual(*films)
        self.assertEqual(len(set(films[0])), 2, "nothing moves")

    def test_the_first_picture_of_a_gale_shows_a_flag_that_flies(self):
        gale = self.folder / "gale.windlog"
        subprocess.run([PROGRAMS / "yuragi-sim", "recording", "-o", gale, "--speed", "16", "--direction", "270", "--duration", "30", "--seed", "5"],
                       check=True, capture_output=True)
        for place in (0, 20):
            rgb, _ = self.make("--render", gale, "--scene", "mast", "--from", place, "--duration", 0.01, "--samples", 1, "--camera", "0,5,7",
                               "--look", "time=12:00", "--out", "-", drawn=True)
            self.assertEqual(len(rgb), PICTURE)
            blue = [(i // 3 % WIDTH, i // 3 // WIDTH) for i in range(0, PICTURE, 3) if rgb[i] < 60 and rgb[i + 2] > 1.5 * max(rgb[i], rgb[i + 1])]
            wide, high = (max(side) - min(side) + 1 for side in zip(*blue))
            self.assertGreater(wide, 0.8 * high, f"from {place} s: {wide} x {high} pixels of cloth")

    def test_every_moment_of_the_recording_has_its_picture(self):
        pictures, said = self.make("--out", "-", "--duration", 2)
        self.assertEqual(len(pictures), 2 * FPS * PICTURE)
        self.assertIn("48 pictures, 2.00 s", said)
        pictures, _ = self.make("--out", "-", "--from", 55)
        self.assertEqual(len(pictures) % PICTURE, 0)
        self.assertAlmostEqual(len(pictures) / PICTURE, 4.75 * FPS, delta=2)
        pictures, _ = self.make("--out", "-", "--duration", 0.5, "--fps", 240)
        self.assertEqual(len(pictures), 120 * PICTURE, "more of them than ticks")

    def test_films_of_parts_join_by_the_states_that_they_keep(self):
        states = self.folder / "states"
        wind = record(self.folder, range(70))
        part = lambda: self.make("--render", wind, "--from", 61, "--duration", 0.1, "--states", states, "--out", "-", drawn=True)[0]
        first = part()
        self.assertEqual(len(list(states.iterdir())), 1, "of the first minute")
        self.assertEqual(part(), first)

    def test_an_mp4_appears_when_it_is_whole(self):
        film = self.folder / "take.mp4"
        self.make("--out", film, "--duration", 1, ffmpeg=KEEPS)
        self.assertEqual(film.stat().st_size, FPS * PICTURE)
        self.assertEqual([file.name for file in self.folder.iterdir() if file.is_file()], ["take.mp4"])

    def test_an_ffmpeg_that_dies_or_fails_or_is_not_there_leaves_no_file(self):
        for ffmpeg, code, words in ((DIES, 73, "was killed by signal 9 (Killed)"), (FAILS, 73, "has failed with exit code 1"),
                                    (None, 69, "in the package ffmpeg")):
            (self.folder / "programs" / "ffmpeg").unlink(missing_ok=True)
            _, said = self.make("--out", self.folder / "take.mp4", "--duration", 5, code=code, ffmpeg=ffmpeg)
            self.assertIn(words, said)
            self.assertFalse([file for file in self.folder.iterdir() if file.is_file()], said)

    def test_ctrl_c_ends_it_and_its_children_and_leaves_no_half_film(self):
        slow = "#!/bin/sh\nread -r line\nexec cat > /dev/null\n"  # a terminal's reader that has stopped
        for ffmpeg in (KEEPS, slow):
            film = self.begin("--out", self.folder / "take.mp4", "--fps", 1000, ffmpeg=ffmpeg)
            until = time.monotonic() + HANG_S
            while len(children := children_of(film.pid)) < 2:
                self.assertLess(time.monotonic(), until)
            film.send_signal(signal.SIGINT)
            self.assertIn("interrupted", self.end(film, 128 + signal.SIGINT))
            self.assertFalse(any(map(is_running, children)))
            self.assertFalse([file for file in self.folder.iterdir() if file.is_file()])

    def test_ctrl_c_ends_it_while_nobody_reads_its_pictures(self):
        film = self.begin("--out", "-", stdout=subprocess.PIPE)
        self.assertTrue(film.stdout.read(PICTURE))
        film.send_signal(signal.SIGINT)
        film.wait(HANG_S)
        self.assertIn("interrupted", self.end(film, 128 + signal.SIGINT))

    def test_a_full_disk_and_a_reader_who_left_are_told(self):
        with open("/dev/full", "wb") as full:
            self.assertIn("No space left on device", self.make("--out", "-", code=73, stdout=full)[1])
        film = self.begin("--out", "-", stdout=subprocess.PIPE)
        film.stdout.read(PICTURE)
        film.stdout.close()
        film.stdout = None
        self.assertIn("whoever read the pictures", self.end(film, 73))

    def test_a_replay_that_is_killed_is_told_and_none_outlives_the_film(self):
        film = self.begin("--out", "-", stdout=subprocess.PIPE)
        film.stdout.read(PICTURE)
        os.kill(children_of(film.pid)[0], signal.SIGKILL)
        self.assertIn("`yuragi replay`, which plays the recording, was killed by signal 9 (Killed)", self.end(film, 70))

        film = self.begin("--out", "-", stdout=subprocess.PIPE)
        film.stdout.read(PICTURE)
        children = children_of(film.pid)
        film.kill()
        self.end(film, -signal.SIGKILL)
        self.assert_ended(children)

    def test_what_cannot_be_made_is_said_at_once(self):
        pictures = self.folder / "pictures"
        self.make("--out", pictures, "--duration", 0.1)
        for code, words, more in ((73, "another film", ("--out", pictures)), (64, "it has: patch, mast", ("--scene", "tree", "--out", "-")),
                                  (64, "even", ("--size", "161x90", "--out", self.folder / "take.mp4")),
                                  (64, "no film", ("--out", self.folder / "take.gif")), (64, "--out", ()),
                                  (64, "--connect", ("--connect", "127.0.0.1:1", "--out", "-")),
                                  (78, "scenes.toml", ("--config", "no/scenes.toml", "--out", "-"))):
            self.assertIn(words, self.make(*more, code=code)[1])
        self.assertIn("the recording does not exist", self.make("--render", self.folder / "none.windlog", "--out", "-", code=66)[1])

    def test_a_film_that_fails_leaves_no_folder(self):
        folder = self.folder / "takes" / "first"
        for code, more in ((66, ("--render", self.folder / "none.windlog")), (64, ("--scene", "tree")), (78, ("--config", "no/scenes.toml")),
                           (64, ("--from", "yesterday"))):
            self.make(*more, "--out", folder, code=code)
            self.assertFalse(folder.parent.exists(), more)
        for harm, code in ((lambda film: film.send_signal(signal.SIGINT), 128 + signal.SIGINT),
                           (lambda film: film.send_signal(signal.SIGTERM), 128 + signal.SIGINT),
                           (lambda film: film.send_signal(signal.SIGHUP), 128 + signal.SIGINT),
                           (lambda film: os.kill(children_of(film.pid)[0], signal.SIGKILL), 70)):
            film = self.begin("--out", folder, "--fps", 1000)
            until = time.monotonic() + HANG_S
            while not (folder / "000002.png").exists():
                self.assertLess(time.monotonic(), until)
            harm(film)
            self.end(film, code)
            self.assertFalse(folder.parent.exists())

    def test_a_film_from_beyond_the_end_is_refused_and_leaves_nothing(self):
        for place in (999, "2030-01-01T00:00:00Z"):
            for name in ("takes/first", "take.mp4"):
                _, said = self.make("--from", place, "--out", self.folder / name, code=65, ffmpeg=KEEPS)
                self.assertIn(str(place), said)
                self.assertEqual([file.name for file in self.folder.iterdir()], ["programs"])

    def test_a_disk_that_fills_up_leaves_nothing(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (PICTURE, PICTURE))
        size = ("--size", "640x360", "--duration", 1)
        self.assertIn("cannot write", self.make("--out", self.folder / "takes" / "first", *size, code=73, drawn=True, preexec_fn=limit)[1])
        self.assertIn("ffmpeg", self.make("--out", self.folder / "take.mp4", *size, code=73, ffmpeg=KEEPS, preexec_fn=limit)[1])
        self.assertEqual([file.name for file in self.folder.iterdir()], ["programs"])


if __name__ == "__main__":
    unittest.main()
