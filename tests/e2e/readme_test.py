#!/usr/bin/env python3
"""Types the lines of README.md and of the guide (config/guide), as a user would after config/demo.sh, and those that config/demo.sh
ends with.

    readme_test.py PROJECT BIN

PROJECT is the clone, BIN the folder of its programs. The lines are typed in a temporary folder that has what a clone has after the
demo: config, build/release/bin and what config/examples.sh makes. `source` and `cd` begin each terminal. A line that ends by itself
must end with 0. A line that runs on must print what RUNS_ON expects; it is ended by Ctrl-C. `yuragi run` and `yuragi replay` are
ended only when the next of them or the next page begins, so that the lines between find a daemon. A line is typed once for each
daemon. Lines in NOT_RUN are counted and not run. TOML is given to `yuragi check-config`; Python, which begins with "from", is compiled.
"""
import collections
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import own_network
from programs import HANG_S

MAX_README_WORDS = 1200
MAX_NOT_RUN = 20
NOT_RUN = {
    "config/demo.sh": "installs packages and builds",
    "tests/run.sh": "installs packages and builds",
    "config/package.sh": "installs packages and builds",
    "yuragi-viewer": "needs a display",
    "yuragi-viewer --config wall.toml": "needs a display",
    "yuragi-viewer --render storm.windlog --duration 20 --size 1920x1080 --fps 60 --config garden.toml --scene fire --out fire.mp4":
        "needs ffmpeg and much time",
    "yuragi calibrate zero --config roof.toml --sensor roof": "needs a device",
    "yuragi calibrate north --config roof.toml --sensor roof --bearing 214": "needs a device",
    "yuragi token --config wall.toml --new": "needs a configuration with a token: http_test.py has one",
    "sudo apt install ./build/package/package/yuragi_*.deb": "changes the machine",
    "sudoedit /etc/yuragi/yuragi.toml": "needs the installed package",
    "sudo yuragi check-config /etc/yuragi/yuragi.toml --as-service": "needs the installed package",
    "sudo systemctl enable --now yuragi": "changes the machine",
    "sudo systemctl enable --now yuragi-viewer@7": "changes the machine",
    "sudo systemctl enable --now yuragi-report.timer": "changes the machine",
    "sudo systemctl reload yuragi": "needs the installed package",
    "sudo -u yuragi yuragi doctor": "needs the installed package",
    "sudo yuragi support-bundle": "needs the installed package",
}
DAEMON = r"\byuragi (run|replay(?!.*--rate max))\b"
RUNS_ON = (
    (DAEMON, r"listening on \S+:\d+"),
    (r"^yuragi-sim (?!recording)", r"\S"),
    (r"^yuragi sensors watch", r"\S"),
    (r"^python3 yuragi_client.py", r"wind \S+ m/s from"),
    (r"^python3 wind_to_osc.py", r"connected, yuragi"),
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
    """"toml", "python" or "lines"."""
    first = next(line for line in block if line.strip())
    return "toml" if first.startswith("[") else "python" if first.startswith("from ") else "lines"


def documents_of(project):
    return [project / "README.md", *sorted((project / "config/guide").glob("*.md"))]


def blocks_of(document, kind):
    """Its code blocks of this kind, each as a list of lines."""
    return [block for block in code_blocks(document.read_text(encoding="utf-8")) if kind_of(block) == kind]


def lines_of(document):
    """Its lines to type."""
    return [line for block in blocks_of(document, "lines") for line in block if line.strip()]


def configurations_of(document):
    """Its TOML, a text for each block."""
    return ["\n".join(block).rstrip() + "\n" for block in blocks_of(document, "toml")]


def command_of(line):
    """A line without its comment."""
    return re.sub(r"\s+#.*", "", line).strip()


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
        self.daemon_command = None
        self.typed = set()  # each command, and the command of the daemon that it found
        self.counts = collections.Counter()
        self.complaints = []

    def begin_page(self):
        """Ends the daemon of the page before: a page starts the daemon that it needs."""
        if complaint := self.end_daemon():
            self.complaints.append(complaint)

    def type(self, line):
        begun = time.monotonic()
        command = command_of(line)
        reason = NOT_RUN.get(command)
        if command == self.daemon_command or (not re.search(DAEMON, line) and (command, self.daemon_command) in self.typed):
            self.counts["typed before"] += 1
            return
        self.typed.add((command, self.daemon_command))
        if line.split()[0] in ("source", "cd"):
            self.beginning = [one for one in self.beginning if one.split()[0] != line.split()[0]] + [line]
            reason, error = None, self.run("true")
            self.typed.clear()
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
                self.daemon, self.daemon_command = process, command_of(line)
                return complaint
            code = end(process)
            return None if code in CTRL_C else f"  Ctrl-C ended it with {code}:\n{text_of(output)}"

    def end_daemon(self):
        if not self.daemon:
            return None
        code = end(self.daemon)
        line = self.daemon.args[-1].splitlines()[-1]
        self.daemon = self.daemon_command = None
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


def faults_of_documents(project):
    """Too many words in README.md, too many lines in NOT_RUN, or lines there that no document has."""
    written = {command_of(line) for document in documents_of(project) for line in lines_of(document)}
    faults = [f"NOT_RUN has a line that no document has: {command}" for command in NOT_RUN if command not in written]
    if len(NOT_RUN) > MAX_NOT_RUN:
        faults.append(f"NOT_RUN has too many lines: {len(NOT_RUN)} (maximum {MAX_NOT_RUN})")
    words = len((project / "README.md").read_text(encoding="utf-8").split())
    if words > MAX_README_WORDS:
        faults.append(f"README.md has too many words: {words} (maximum {MAX_README_WORDS}); move some to config/guide")
    return faults


def check_python(terminal, block, folder):
    """A program of a document: its imports work, and the rest can be compiled."""
    compile("\n".join(block), "the guide", "exec")
    done = subprocess.run([sys.executable, "-c", block[0]], cwd=folder, capture_output=True, text=True, timeout=HANG_S, check=False)
    terminal.counts["programs in Python"] += 1
    if done.returncode != 0:
        terminal.complaints.append(f"{block[0]}\n{done.stderr}")


def main():
    why_not = own_network.enter()
    if why_not:
        print(f"{why_not}: the addresses that the documents name must be free")
    project, programs = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    with tempfile.TemporaryDirectory() as name:
        clone = pathlib.Path(name)
        shutil.copytree(project / "config", clone / "config")
        (clone / "engine/wire").mkdir(parents=True)
        shutil.copy(project / "engine/wire/pose.fbs", clone / "engine/wire")
        (clone / "build/release").mkdir(parents=True)
        (clone / "build/release/bin").symlink_to(programs)
        subprocess.run([clone / "config/examples.sh"], check=True)

        terminal = Terminal(clone)
        for document in documents_of(project):
            print(document.relative_to(project))
            terminal.begin_page()
            for line in lines_of(document):
                terminal.type(line)
            for block in blocks_of(document, "python"):
                check_python(terminal, block, clone / "build/examples")
            for text in configurations_of(document):
                check_toml(terminal, text, clone / "build/examples")
        if configurations_of(project / "README.md")[0] != (project / "config/examples/roof.toml").read_text(encoding="utf-8"):
            terminal.complaints.append("README's roof.toml is not config/examples/roof.toml")
        terminal.complaints += faults_of_documents(project)
        terminal.begin_page()
        terminal.beginning = []
        for line in lines_of_demo(project, clone):
            terminal.type(line)
        terminal.begin_page()

    print(*(f"{count:3d} {what}" for what, count in sorted(terminal.counts.items())), sep="\n")
    for complaint in terminal.complaints:
        print(f"FAILED: {complaint}", file=sys.stderr)
    return 1 if terminal.complaints else 0


if __name__ == "__main__":
    sys.exit(main())
