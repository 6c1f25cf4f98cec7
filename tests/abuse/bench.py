"""The frame of the rows of tests/abuse: what runs the programs, watches them, and says in a table how it went."""
import csv
import io
import json
import mmap
import os
import random
import re
import resource
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import traceback

HERE = os.path.dirname(os.path.abspath(__file__))
PROJECT = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(PROJECT, "tests", "e2e"))

import pose_client  # noqa: E402
from programs import HANG_S, Program, free_port  # noqa: E402

TICK_RATE_HZ = 60.0
MEADOW = '[[scene]]\nkind = "grass"\nblades_across = 20\nblades_deep = 20\n'  # small: what is tried is not the scenes
RECORDER_WRITING, RECORDER_RETRYING, RECORDER_HANGING = 0, 1, 2  # enum RecorderState
LINES = []  # every row, in the order in which the table shows them


class Line:
    """A row that can be tried."""

    def __init__(self, attack, function, short_s):
        self.name = function.__name__.replace("_", "-")
        self.attack = attack
        self.function = function
        self.short_s = short_s  # about how long its short form takes: the longest begin first


def row(attack, short_s=6):
    """Registers a function of a Bench as a row of the table."""

    def register(function):
        LINES.append(Line(attack, function, short_s))
        return function

    return register


class NotHere(Exception):
    """What the row needs is not on this machine."""


class Settings:
    """What the rows run, and how long."""

    def __init__(self, programs, helpers, schema_modules, is_long, seed, minutes=None):
        self.yuragi = os.path.abspath(os.path.join(programs, "yuragi"))
        self.simulator = os.path.abspath(os.path.join(programs, "yuragi-sim"))
        self.faults_library = os.path.abspath(os.path.join(helpers, "libyuragi_abuse_faults.so"))
        self.half_year = os.path.abspath(os.path.join(helpers, "yuragi-half-year"))
        self.schema_modules = os.path.abspath(schema_modules)
        self.is_long = is_long
        self.seed = seed
        self.minutes = minutes  # of the rows that take long; None: as long as each is meant to


class Bench:
    """One row while it is tried: its programs end with it. The seed repeats its random choices."""

    def __init__(self, settings, name):
        self.settings = settings
        self.name = name
        self.random = random.Random(f"{settings.seed} {name}")
        self.counts = []
        self.figures = []
        self.failures = []
        self.skipped = ""
        self.cleanups = []

    # ---- what the row says ----

    def count(self, number, of_what):
        self.counts.append(f"{number:,} {of_what}")

    def figure(self, text):
        self.figures.append(text)

    def expect(self, condition, otherwise):
        if not condition:
            self.failures.append(otherwise)
        return bool(condition)

    def choose(self, long, short):
        """What the long form takes, or the short one."""
        return long if self.settings.is_long else short

    # ---- what the row runs ----

    def __enter__(self):
        folder = tempfile.TemporaryDirectory(prefix="yuragi-abuse-")
        self.cleanups.append(folder.cleanup)
        self.folder = folder.name
        return self

    def __exit__(self, *_):
        while self.cleanups:
            self.cleanups.pop()()

    def file(self, name, text=None):
        path = os.path.join(self.folder, name)
        if text is not None:
            with open(path, "w", encoding="utf-8") as out:
                out.write(text)
        return path

    def start(self, *command, **options):
        program = Program(*command, **options)
        self.cleanups.append(program.__exit__)
        return program

    def start_daemon(self, config="", *arguments, before=(), **options):
        """A daemon with the small meadow, and whatever else the configuration says, that listens."""
        path = self.file(f"wall-{len(self.cleanups)}.toml", config + MEADOW)
        daemon = self.start(*before, self.settings.yuragi, "run", "--listen", "127.0.0.1:0", "--config", path, *arguments,
                            **options)
        daemon.address()
        return daemon

    def start_simulator(self, *arguments):
        return self.start(self.settings.simulator, *arguments)

    def run(self, *arguments, before=(), timeout_s=HANG_S):
        return subprocess.run([*before, self.settings.yuragi, *map(str, arguments)], capture_output=True, text=True,
                              timeout=timeout_s, check=False)

    def attack(self, kind, address, seconds, *arguments):
        """Starts an attacker (attackers.py), which leaves the machine to the others: what is tried is not its speed."""
        seed = self.random.randrange(1 << 32)
        attacker = self.start("nice", "-n", "10", sys.executable, os.path.join(HERE, "attackers.py"),
                              self.settings.schema_modules, kind,
                              address, seconds, seed, *arguments)
        attacker.seconds = seconds
        return attacker

    def end_of_attack(self, attacker, now=False):
        """Waits for it, or ends it now, and answers what it counted."""
        if now:
            attacker.process.terminate()
        if attacker.process.wait(attacker.seconds + HANG_S) != 0:
            raise AssertionError(f"the attacker failed:\n{attacker.text()}")
        return json.loads(attacker.text().splitlines()[-1])

    def expect_alive(self, daemon):
        if not self.expect(daemon.process.poll() is None, f"the daemon has ended by itself with {daemon.process.poll()}"):
            print(daemon.text()[-3000:], file=sys.stderr)

    def expect_ends(self, daemon, number=signal.SIGTERM):
        begin_s = time.monotonic()
        code = daemon.end(number)
        took_s = time.monotonic() - begin_s
        self.expect(code == 0, f"it ended with {code}")
        return took_s


# ---- a client that does all as it should, and says what it saw ----


class Watched:
    """What the well-behaved client saw in a while, and for how long the daemon's threads then ran, and waited for a processor."""

    def __init__(self, said, times_s):
        self.seconds = said["seconds"]
        self.frames = said["frames"]
        self.missed = said["missed"]          # frames that it did not get
        self.skipped = said["skipped"]        # ticks that the animation left out
        self.longest_pause_s = said["longest_pause_s"]
        self.sensors = said["sensors"]
        self.io_ran_s, self.animation_ran_s, self.io_waited_s, self.animation_waited_s, self.client_waited_s = times_s

    def text(self):
        return (f"{self.frames:,} frames, {self.missed} missed, {self.skipped} ticks skipped, longest pause "
                f"{1e3 * self.longest_pause_s:.0f} ms (threads waited for a processor: I/O {self.io_waited_s:.2f} s, animation "
                f"{self.animation_waited_s:.2f} s)")


def processor_times_s(process_id):
    """Since they began, of the daemon's I/O thread and of its animation: for how long they ran, and for how long they were ready
    to run and had no processor. The latter is the machine's load, of which neither the daemon nor a client is the cause."""
    ran_s, waited_s = [0.0, 0.0], [0.0, 0.0]
    for task in os.listdir(f"/proc/{process_id}/task"):
        with open(f"/proc/{process_id}/task/{task}/comm", encoding="ascii") as comm:
            is_animation = comm.read().strip() == "animation"
        if is_animation or int(task) == process_id:
            with open(f"/proc/{process_id}/task/{task}/schedstat", encoding="ascii") as schedstat:
                ran_s[is_animation], waited_s[is_animation] = (1e-9 * int(word) for word in schedstat.read().split()[:2])
    return ran_s + waited_s


class Witness:
    """A well-behaved client in a process of its own (witness.py)."""

    def __init__(self, bench, daemon):
        """daemon: a Program that listens."""
        self.bench = bench
        self.daemon_id = daemon.process.pid
        self.times_s = [0.0] * 5
        address = daemon.address()
        self.process = subprocess.Popen([sys.executable, os.path.join(HERE, "witness.py"), bench.settings.schema_modules, address],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        bench.cleanups.append(self.end)
        self.mark()

    def mark(self):
        """What it has seen since the last time."""
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise AssertionError("the well-behaved client has lost its connection")
        said = json.loads(line)
        try:
            times_s = [*processor_times_s(self.daemon_id), said["waited_s"]]
        except OSError:
            times_s = self.times_s  # it has ended
        before, self.times_s = self.times_s, times_s
        return Watched(said, [now - then for now, then in zip(times_s, before)])

    def wait_for(self, condition):
        """Waits until a state of the sensors (a dictionary) is so, and answers it; None where none is for long."""
        deadline_s = time.monotonic() + HANG_S
        while time.monotonic() < deadline_s:
            self.process.stdin.write("next\n")
            self.process.stdin.flush()
            line = self.process.stdout.readline()
            if not line:
                raise AssertionError("the well-behaved client has lost its connection")
            sensors = json.loads(line)
            if condition(sensors):
                return sensors
        return None

    def watch(self, seconds):
        """What it sees in so many seconds from now on."""
        self.mark()
        wait_until(time.monotonic() + seconds)
        return self.mark()

    def end(self):
        self.process.kill()
        self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()

    def expect_undisturbed(self, quiet, attacked, stood_still_s=0.0):
        """Were the frames as in a quiet time? A tick is skipped where the animation is late by a whole one, a frame is missed where
        the I/O thread is: as often as they had no processor for so long it is the machine, else the attack. For `stood_still_s` the
        machine did nothing at all."""
        self.bench.expect(attacked.frames > 0, "no frame came")
        for what, waited_s, before, then in (("frames missed", attacked.io_waited_s, quiet.missed, attacked.missed),
                                             ("ticks skipped", attacked.animation_waited_s, quiet.skipped, attacked.skipped)):
            as_before = before * attacked.frames / max(quiet.frames, 1)
            allowed = 3.0 + 0.001 * attacked.frames + 2.0 * as_before + (waited_s + stood_still_s) * TICK_RATE_HZ
            self.bench.expect(then <= allowed, f"{then} {what}, where {allowed:.0f} are allowed")
        waited_s = attacked.io_waited_s + attacked.animation_waited_s + attacked.client_waited_s
        pause_s = 0.3 + min(waited_s, 1.0) + stood_still_s
        self.bench.expect(attacked.longest_pause_s <= pause_s,
                          f"a pause of {attacked.longest_pause_s:.2f} s, where {pause_s:.2f} s are allowed")


def wait_until(moment_s):
    """Lets time pass: for what is measured over a while."""
    threading.Event().wait(max(0.0, moment_s - time.monotonic()))


# ---- what a process holds ----


class Sampler(threading.Thread):
    """Notes the memory, descriptors and threads of a process at a fixed rate."""

    def __init__(self, process_id, every_s=1.0):
        super().__init__(daemon=True)
        self.process_id = process_id
        self.every_s = every_s
        self.samples = []  # (s, VmRSS in KiB, VmHWM in KiB, descriptors, threads)
        self.ended = threading.Event()
        self.begin_s = time.monotonic()
        self.start()

    def sample(self):
        with open(f"/proc/{self.process_id}/status", encoding="ascii") as status:
            text = status.read()
        values = [int(re.search(rf"{key}:\s+(\d+)", text).group(1)) for key in ("VmRSS", "VmHWM", "Threads")]
        descriptors = len(os.listdir(f"/proc/{self.process_id}/fd"))
        return (time.monotonic() - self.begin_s, values[0], values[1], descriptors, values[2])

    def run(self):
        while not self.ended.wait(self.every_s):
            try:
                self.samples.append(self.sample())
            except (OSError, AttributeError):
                return  # it has ended

    def end(self):
        self.ended.set()
        self.join(HANG_S)
        return self

    def stood_still_s(self):
        """The longest time by which a sample came too late: then the machine did nothing at all, for this process either."""
        times_s = [sample[0] for sample in self.samples]
        return max((after - before - self.every_s for before, after in zip(times_s, times_s[1:])), default=0.0)

    def growth(self, column, warm_up=0.25):
        """What the fitted line gains from the end of the warm-up to the end."""
        points = [(sample[0], sample[column]) for sample in self.samples[int(warm_up * len(self.samples)):]]
        if len(points) < 4:
            return 0.0
        return slope(points) * (points[-1][0] - points[0][0])


def slope(points):
    """Of the line through (x, y) with the least squares."""
    mean_x = sum(x for x, _ in points) / len(points)
    mean_y = sum(y for _, y in points) / len(points)
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / spread if spread > 0.0 else 0.0


# ---- readings that say which they are ----

OSC_SENSOR = '[[sensor]]\nname = "numbered"\ndriver = "osc"\nport = {port}\n'


def osc_message(speed_m_s, direction_deg):
    return b"/wind\0\0\0,ff\0" + struct.pack(">ff", speed_m_s, direction_deg)


class NumberedSender(threading.Thread):
    """Sends numbered readings by OSC: the number stands in speed and direction."""

    STEPS = 300  # speeds 0 to 29.9 m/s

    def __init__(self, rate_hz=10.0):
        super().__init__(daemon=True)
        self.port = free_port(socket.SOCK_DGRAM)
        self.rate_hz = rate_hz
        self.sent_s = []  # by number: when
        self.ended = threading.Event()
        self.start()

    def run(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            next_s = time.monotonic()
            while not self.ended.wait(max(0.0, next_s - time.monotonic())):
                next_s = max(next_s + 1.0 / self.rate_hz, time.monotonic())  # what is late is not made up for
                number = len(self.sent_s)
                self.sent_s.append(time.monotonic())
                try:
                    out.sendto(osc_message(0.1 * (number % self.STEPS), number // self.STEPS % 360), ("127.0.0.1", self.port))
                except ConnectionError:
                    pass  # nobody listens just now

    def end(self):
        self.ended.set()
        self.join(HANG_S)

    @classmethod
    def number_of(cls, speed_m_s, direction_deg):
        return cls.STEPS * round(direction_deg) + round(10.0 * speed_m_s)

    def numbers_sent(self, from_s, to_s):
        return {number for number, when_s in enumerate(self.sent_s) if from_s <= when_s <= to_s}


def numbers_recorded(bench, file, before=(), sensor="numbered"):
    """The numbers in a recording, as `yuragi export` reads them."""
    done = bench.run("export", file, "-o", "-", before=before, timeout_s=300)
    if not bench.expect(done.returncode == 0, f"export: {done.stderr.strip()}"):
        return []
    return [NumberedSender.number_of(float(line["speed_m_s"]), float(line["direction_deg"]))
            for line in csv.DictReader(io.StringIO(done.stdout)) if line["sensor"] == sensor]


# ---- faults of the disk and of the clock ----


class Faults:
    """What the preloaded library (fault_library.cpp) does to a program: it reads these numbers from a file that is mapped."""

    def __init__(self, bench):
        if not os.path.exists(bench.settings.faults_library):
            raise NotHere("the library of faults is not built")
        self.path = bench.file(f"faults-{len(bench.cleanups)}")
        self.library = bench.settings.faults_library
        self.clock_ahead_s, self.write_delay_s, self.write_error = 0.0, 0.0, 0
        with open(self.path, "wb+") as out:
            out.write(bytes(24))
            out.flush()
            self.memory = mmap.mmap(out.fileno(), 24)

    def set(self, clock_ahead_s=None, write_delay_s=None, write_error=None):
        """Seconds by which the clock (UTC) is ahead; how long each write to a recording takes, below 0: until this is changed;
        the errno that each fails with."""
        self.clock_ahead_s = self.clock_ahead_s if clock_ahead_s is None else clock_ahead_s
        self.write_delay_s = self.write_delay_s if write_delay_s is None else write_delay_s
        self.write_error = self.write_error if write_error is None else write_error
        self.memory[:24] = struct.pack("<qqq", int(1e9 * self.clock_ahead_s), int(1e9 * self.write_delay_s), self.write_error)

    def environment(self):
        return {**os.environ, "LD_PRELOAD": self.library, "YURAGI_ABUSE_FAULTS": self.path}


class SmallDisk:
    """A tmpfs in a mount namespace of its own, which nobody else sees and which ends with the row."""

    def __init__(self, bench, size_bytes, name="disk"):
        self.bench = bench
        self.size_bytes = size_bytes
        self.folder = os.path.join(bench.folder, name)
        os.mkdir(self.folder)
        try_out = subprocess.run(["unshare", "--mount", "mount", "-t", "tmpfs", "none", self.folder], capture_output=True,
                                 check=False)
        if try_out.returncode != 0:
            raise NotHere("no mount namespace (only root may make one)")
        self.holder = bench.start("unshare", "--mount", "--propagation", "private", "sh", "-c",
                                  "echo ready; exec tail -f /dev/null")
        self.holder.wait_for("ready")
        self.before = ("nsenter", "--mount", "--target", str(self.holder.process.pid), "--wd=/")
        self.mount()

    def inside(self, *command):
        return subprocess.run([*self.before, *command], check=True, capture_output=True, timeout=HANG_S)

    def mount(self):
        self.inside("mkdir", "-p", self.folder)
        self.inside("mount", "-t", "tmpfs", "-o", f"size={self.size_bytes}", "none", self.folder)

    def unmount(self):
        """At once, whoever has files open there; and nobody can write to the place."""
        self.inside("umount", "--lazy", self.folder)
        self.inside("rmdir", self.folder)

    def fill(self):
        subprocess.run([*self.before, "sh", "-c", f"cat /dev/zero > {self.folder}/ballast"], capture_output=True, timeout=HANG_S,
                       check=False)

    def empty(self):
        self.inside("rm", f"{self.folder}/ballast")

    def allow_writing(self, is_allowed):
        self.inside("mount", "-o", f"remount,{'rw' if is_allowed else 'ro'}", self.folder)


# ---- the table ----


def try_row(settings, line):
    bench = Bench(settings, line.name)
    begin_s = time.monotonic()
    try:
        with bench:
            line.function(bench)
    except NotHere as reason:
        bench.skipped = str(reason)
    except Exception as error:  # a row that cannot be tried has failed, and the others are tried all the same
        traceback.print_exc()
        bench.failures.append(f"{type(error).__name__}: {error}".splitlines()[0])
    bench.took_s = time.monotonic() - begin_s
    return bench


def result_text(bench):
    if bench.skipped:
        return "not tried: " + bench.skipped
    return "FAILED: " + "; ".join(bench.failures) if bench.failures else "held"


def table(lines, settings):
    """Markdown, of [(line, bench)]."""
    text = "| attack or fault | count | result | figure | command that repeats it |\n| --- | --- | --- | --- | --- |\n"
    for line, bench in lines:
        command = f"`tests/abuse/by_hand.sh {bench.name}{'' if settings.is_long else ' --short'} --seed {settings.seed}`"
        cells = (line.attack, "; ".join(bench.counts), result_text(bench), "; ".join(bench.figures), command)
        text += "| " + " | ".join(cell.replace("|", "/").replace("\n", " ") for cell in cells) + " |\n"
    return text


def raise_descriptor_limit():
    """Hundreds of connections need as many descriptors."""
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(most, 8192), most))
