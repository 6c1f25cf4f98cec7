#!/usr/bin/env python3
"""Types the lines of README.md, in their order, as somebody would after config/demo.sh; and those that config/demo.sh ends with.

    readme_test.py PROJECT BIN

PROJECT is the clone, BIN the folder of its programs. The lines are typed in a temporary folder that holds what a clone does after
the demo: config, build/release/bin and what config/examples.sh makes. `source` and `cd` begin each terminal. A line that ends by
itself must end with 0. One that runs on must say something that RUNS_ON knows; it is ended by Ctrl-C, `yuragi run` and `yuragi
replay` only when the next of them begins, so that the lines between find a daemon. Lines that NOT_RUN knows are counted and not
run. TOML is given to `yuragi check-config`.
"""
import collections
import fcntl
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time

from programs import HANG_S

NOT_RUN = (
    (r"^(config/demo|config/package|tests/run)\.sh", "installs packages and builds"),
    (r"/etc/yuragi", "needs the package to be installed"),
    (r"^sudo ", "changes the machine"),
    (r"^yuragi-viewer\b(?!.*--render)", "needs a display"),
    (r"^yuragi-viewer\b.*\.mp4$", "needs ffmpeg, and much time"),
    (r"/dev/ttyUSB|^yuragi calibrate (zero|north)", "needs a device"),
    (r"^yuragi token\b", "needs a daemon with a token: http_test.py has one"),
    (r"--usbip", "needs a kernel with USB/IP"),
    (r"--broker \d", "needs a broker"),
)
DAEMON = r"\byuragi (run|replay(?!.*--rate max))\b"
RUNS_ON = (
    (DAEMON, r"listening on \S+:\d+"),
    (r"^yuragi-sim (?!recording)", r"\S"),
    (r"^yuragi sensors watch", r"\S"),
)
CTRL_C = (0, -signal.SIGINT, 128 + signal.SIGINT)  # exit codes of what it ends: in good order, by the signal, a shell's for that
ENDS_WITHIN_S = HANG_S
SAYS_WITHIN_S = 20


def code_blocks(text):
    """The indented blocks of a Markdown text: lists of lines."""
    blocks = []
    is_in_block = False
    for line in text.splitlines():
        if line.startswith("    "):
            if not is_in_block:
                blocks.append([])
            blocks[-1].append(line[4:])
            is_in_block = True
        elif not line and is_in_block:
            blocks[-1].append("")
        else:
            is_in_block = False
    return blocks


def kind_of(block):
    """Which of "toml", "drawing" and "lines" a block is."""
    first = next(line for line in block if line.strip())
    if first.startswith("["):
        return "toml"
    return "drawing" if " -> " in first else "lines"


def lines_of_readme(project):
    """Its lines to type, and its TOML."""
    blocks = code_blocks((project / "README.md").read_text(encoding="utf-8"))
    typed = [line for block in blocks if kind_of(block) == "lines" for line in block if line.strip()]
    return typed, ["\n".join(block).rstrip() + "\n" for block in blocks if kind_of(block) == "toml"]


def lines_of_demo(project, clone):
    """The lines that config/demo.sh ends with, for a clone that stands at `clone`."""
    text = (project / "config/demo.sh").read_text(encoding="utf-8")
    shown = re.search(r"^cat <<TEXT$(.*?)^TEXT$", text, re.S | re.M).group(1).replace("$project", str(clone))
    return [line.strip() for line in shown.splitlines() if line.startswith("  ")]


class Terminal:
    """What is typed in a clone, and what came of it."""

    def __init__(self, clone):
        self.clone = clone
        self.beginning = []  # the lines that begin each terminal
        self.daemon = None
        self.counts = collections.Counter()
        self.complaints = []

    def type(self, line):
        begun = time.monotonic()
        reason = next((reason for pattern, reason in NOT_RUN if re.search(pattern, line)), None)
        if line.split()[0] in ("source", "cd"):
            self.beginning = [one for one in self.beginning if one.split()[0] != line.split()[0]] + [line]
            reason, error = None, self.run("true")
            self.counts["begin a terminal"] += 1
        elif reason:
            self.counts[f"not run: {reason}"] += 1
            error = None
        elif said := next((said for pattern, said in RUNS_ON if re.search(pattern, line)), None):
            error = self.run_on(line, said)
            self.counts["run on"] += 1
        else:
            error = self.run(line)
            self.counts["end with 0"] += 1
        print(f"{time.monotonic() - begun:5.1f} s  {line}{'  (' + reason + ')' if reason else ''}", flush=True)
        if error:
            self.complaints.append(f"{line}\n{error}")
            print(error, flush=True)

    def start(self, line, output):
        return subprocess.Popen(["bash", "-c", "\n".join(["set -e", *self.beginning, line])], cwd=self.clone, stdin=subprocess.DEVNULL,
                                stdout=output, stderr=subprocess.STDOUT, start_new_session=True)

    def run(self, line):
        """Runs a line to its end; answers what is wrong with it."""
        with tempfile.TemporaryFile() as output:
            process = self.start(line, output)
            try:
                code = process.wait(ENDS_WITHIN_S)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                code = f"no end within {ENDS_WITHIN_S} s"
            return None if code == 0 else f"  ended with {code}:\n{text_of(output)}"

    def run_on(self, line, said):
        """Runs a line until it says that; answers what is wrong with it."""
        is_daemon = re.search(DAEMON, line)
        complaint = self.end_daemon() if is_daemon else None
        with tempfile.TemporaryFile() as output:
            process = self.start(line, output)
            given_up_s = time.monotonic() + SAYS_WITHIN_S
            while not re.search(said, text_of(output)):
                if process.poll() is not None or time.monotonic() > given_up_s:
                    end(process)
                    return f"  did not say {said}; it said:\n{text_of(output)}"
                time.sleep(0.02)
            if is_daemon:
                self.daemon = process
                return complaint
            code = end(process)
            return None if code in CTRL_C else f"  Ctrl-C ended it with {code}:\n{text_of(output)}"

    def end_daemon(self):
        if not self.daemon:
            return None
        code = end(self.daemon)
        line = self.daemon.args[-1].splitlines()[-1]
        self.daemon = None
        return None if code in CTRL_C else f"  Ctrl-C ended {line} with {code}"


def end(process):
    """Ctrl-C; answers the exit code."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
    try:
        return process.wait(ENDS_WITHIN_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return f"no end within {ENDS_WITHIN_S} s"


def text_of(output):
    return os.pread(output.fileno(), 1 << 20, 0).decode("utf-8", "replace")


def check_toml(terminal, text, folder):
    """A part of a configuration, with a sensor around it where it is a part of one."""
    if text.startswith("[sensor."):
        text = '[[sensor]]\nname = "any"\ndriver = "synthetic"\n' + text
    file = folder / f"readme_{terminal.counts['configurations']}.toml"
    file.write_text(text, encoding="utf-8")
    terminal.counts["configurations"] += 1
    error = terminal.run(f"yuragi check-config {file}")
    if error:
        terminal.complaints.append(f"{text}\n{error}")


def enter_network_of_its_own():
    """Runs this again in a network namespace, where the addresses that README names are free; not where that is not allowed."""
    if "YURAGI_README_TEST_INSIDE" in os.environ:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:  # ip link set lo up
            fcntl.ioctl(any_socket, 0x8914, struct.pack("16sh14x", b"lo", 0x1 | 0x40))  # SIOCSIFFLAGS, IFF_UP | IFF_RUNNING
        return
    unshare = ["unshare", "--map-root-user", "--net"]
    if shutil.which("unshare") and subprocess.run([*unshare, "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
        os.environ["YURAGI_README_TEST_INSIDE"] = "1"
        os.execvp("unshare", [*unshare, sys.executable, *sys.argv])
    print("no network of its own: the addresses that README names must be free")


def main():
    enter_network_of_its_own()
    project, programs = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    lines, configurations = lines_of_readme(project)
    with tempfile.TemporaryDirectory() as name:
        clone = pathlib.Path(name)
        shutil.copytree(project / "config", clone / "config")
        (clone / "build/release").mkdir(parents=True)
        (clone / "build/release/bin").symlink_to(programs)
        subprocess.run([clone / "config/examples.sh"], check=True)

        terminal = Terminal(clone)
        for line in lines:
            terminal.type(line)
        for text in configurations:
            check_toml(terminal, text, clone)
        if configurations[0] != (project / "config/examples/roof.toml").read_text(encoding="utf-8"):
            terminal.complaints.append("README's roof.toml is not config/examples/roof.toml")
        terminal.beginning = []
        for line in lines_of_demo(project, clone):
            terminal.type(line)
        if complaint := terminal.end_daemon():
            terminal.complaints.append(complaint)

    print(*(f"{count:3d} {what}" for what, count in sorted(terminal.counts.items())), sep="\n")
    for complaint in terminal.complaints:
        print(f"FAILED: {complaint}", file=sys.stderr)
    return 1 if terminal.complaints else 0


if __name__ == "__main__":
    sys.exit(main())
