"""Runs Yuragi's programs for the end-to-end tests: each in a process of its own, on a free port, ended with the test."""
import itertools
import os
import re
import signal
import socket
import subprocess
import threading

HANG_S = 60.0  # so long waits only who waits for something that hangs

# A shell's background jobs ignore it, and what they start inherits that; but tests end programs with it.
signal.signal(signal.SIGINT, signal.default_int_handler)


# Ports that the system does not give to whoever asks for any (32768 and above), which other tests do all the time.
FIRST_PORT, PORTS, BETWEEN_PROCESSES = 12_000, 20_000, 37
next_port = itertools.count(os.getpid() * BETWEEN_PROCESSES)
reserved = []


def reserve(port):
    """Takes a port from the other tests of this machine until this process ends, by the name of a socket that nobody else can
    have meanwhile (tests/support/free_port.hpp: likewise). False where another one has it."""
    name = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        name.bind(f"\0yuragi-test-port-{port}")
    except OSError:
        name.close()
        return False
    reserved.append(name)
    return True


def free_ports(kinds):
    """A port of 127.0.0.1 for each of these socket types that nobody has and no other test takes, all different."""
    ports = []
    for kind in kinds:
        while True:
            port = FIRST_PORT + next(next_port) % PORTS
            with socket.socket(socket.AF_INET, kind) as one:
                try:
                    one.bind(("127.0.0.1", port))
                except OSError:
                    continue  # a program that is no test has it
            if reserve(port):
                ports.append(port)
                break
    return ports


def free_port(kind=socket.SOCK_STREAM):
    return free_ports([kind])[0]


class Program:
    """A program that runs beside the test. What it says is read all the time, so that it never blocks."""

    def __init__(self, *command, **options):
        self.process = subprocess.Popen([str(word) for word in command], **{"stdin": subprocess.DEVNULL, **options},
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.said = b""
        self.is_silent = False  # for good
        self.news = threading.Condition()
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        while True:
            block = os.read(self.process.stdout.fileno(), 65536)
            with self.news:
                self.said += block
                self.is_silent = not block
                self.news.notify_all()
            if not block:
                return

    def text(self):
        """What it has said; all of it, where it has ended."""
        if self.process.poll() is not None:
            self.reader.join(HANG_S)
        with self.news:
            return self.said.decode("utf-8", "replace")

    def wait_until(self, find):
        """Waits until find(text) answers something in what it has said so far, and answers that; None where it never does."""
        with self.news:
            def found():
                return find(self.said.decode("utf-8", "replace"))

            self.news.wait_for(lambda: self.is_silent or found(), HANG_S)
            return found() or None

    def wait_for(self, pattern):
        """Waits until the output matches, and answers the match."""
        match = self.wait_until(lambda text: re.search(pattern, text))
        if match is None:
            raise AssertionError(f"no {pattern!r} in the output of {self.process.args}:\n{self.text()}")
        return match

    def address(self):
        """HOST:PORT that it listens on."""
        return self.wait_for(r"listening on (\S+:\d+)").group(1)

    def end(self, signal_number=signal.SIGTERM):
        """Ends it and answers its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal_number)
        return self.process.wait(HANG_S)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.reader.join(HANG_S)
        self.process.stdout.close()


def resident_kib(program):
    """Memory that the process holds now, KiB."""
    with open(f"/proc/{program.process.pid}/status", encoding="ascii") as status:
        return int(re.search(r"VmRSS:\s+(\d+)", status.read()).group(1))


def shared_data(*parts):
    """A file of ../shared/data, or None where it is not there."""
    project = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    path = os.path.join(os.path.dirname(project), "shared", "data", *parts)
    return path if os.path.exists(path) else None
