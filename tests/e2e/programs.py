"""Runs Yuragi's programs for the end-to-end tests: each in a process of its own, on a free port, ended with the test."""
import os
import re
import signal
import subprocess
import tempfile
import time


class Program:
    """A program that runs beside the test. Its output goes to a file, so that it never blocks."""

    def __init__(self, *command, **options):
        self.output = tempfile.NamedTemporaryFile(prefix="yuragi-e2e-", suffix=".log")
        self.process = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL,
                                        stdout=self.output, stderr=subprocess.STDOUT, **options)

    def text(self):
        with open(self.output.name, encoding="utf-8", errors="replace") as log:
            return log.read()

    def wait_for(self, pattern, timeout_s=20.0):
        """Waits until the output matches, and answers the match."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            match = re.search(pattern, self.text())
            if match:
                return match
            if self.process.poll() is not None:
                break
            time.sleep(0.02)
        raise AssertionError(f"no {pattern!r} in the output of {self.process.args}:\n{self.text()}")

    def address(self):
        """HOST:PORT that it listens on."""
        return self.wait_for(r"listening on (\S+:\d+)").group(1)

    def end(self, signal_number=signal.SIGTERM, timeout_s=10.0):
        """Ends it and answers (exit code, seconds that it took)."""
        if self.process.poll() is None:
            self.process.send_signal(signal_number)
        begun = time.monotonic()
        code = self.process.wait(timeout_s)
        return code, time.monotonic() - begun

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.output.close()


def resident_kib(program):
    """Memory that the process holds now, KiB."""
    with open(f"/proc/{program.process.pid}/status", encoding="ascii") as status:
        return int(re.search(r"VmRSS:\s+(\d+)", status.read()).group(1))


def shared_data(*parts):
    """A file of ../shared/data, or None where it is not there."""
    project = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    path = os.path.join(os.path.dirname(project), "shared", "data", *parts)
    return path if os.path.exists(path) else None
