"""Faults that are there when the daemon starts: does it run, what does it report, and does it recover when the cause is gone?"""
import json
import os
import re
import socket
import subprocess
import time
import urllib.error
import urllib.request

from bench import HANG_S, MEADOW, OSC_SENSOR, NotHere, NumberedSender, SmallDisk, free_port, pose_client, row, wait_until

SYNTHETIC = '[[sensor]]\nname = "roof"\ndriver = "synthetic"\nrate = 10\n'
NO_ROOM_IS_KEPT = '[recording]\nmin_free = 0\n'
POLL_S = 0.5  # the daemon's own interval of its status


class Start:
    """A daemon that starts with one fault."""

    def __init__(self, kind, reports, mend, config=SYNTHETIC, record=None, http="", http_port=None, before=()):
        self.kind = kind
        self.reports = reports  # a pattern of what needs attention; None: it recovers at the start, and logs `mend`
        self.mend = mend        # removes the cause
        self.config = config
        self.record = record
        self.http = http
        self.http_port = http_port or free_port()
        self.before = before
        self.line = ""          # what is reported
        self.recovered_s = None

    def begin(self, bench):
        page = f'[http]\nlisten = "127.0.0.1:{self.http_port}"\n{self.http}'
        file = bench.file(f"{self.kind.replace(' ', '-')}.toml", page + self.config + MEADOW)
        record = ("--record", self.record) if self.record else ()
        self.settings_file = file
        self.daemon = bench.start(*self.before, bench.settings.yuragi, "run", "--listen", "127.0.0.1:0", "--config", file, *record)

    def is_streaming(self):
        """Waits for a pose."""
        source = pose_client.SocketBytes(self.daemon.address(), None)
        try:
            source.send(pose_client.subscribe_message(client="starts"))
            return any(pose_client.body_of(message)[0] == "Frame" for message, _ in pose_client.messages(source))
        finally:
            source.socket.close()

    def attention(self, bench):
        """What `yuragi status` shows that needs attention: lines."""
        done = bench.run("status", "--connect", self.daemon.address(), "--json")
        return json.loads(done.stdout)["attention"] if done.returncode in (0, 1) else ["no status: " + done.stderr]

    def health(self):
        """(code, text) of /healthz; None if the page is not served."""
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{self.http_port}/healthz", timeout=HANG_S) as answer:
                return answer.status, answer.read().decode()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read().decode()
        except OSError:
            return None

    def reported(self, lines):
        return next((line for line in lines if re.search(self.reports, line)), None)

    def wait_for_report(self, bench):
        deadline_s = time.monotonic() + HANG_S
        while time.monotonic() < deadline_s:
            if line := self.reported(self.attention(bench)):
                return line
            wait_until(time.monotonic() + POLL_S)
        return ""


def take_port(kind, port=0):
    """A socket that has the port until it is closed, and does not reply."""
    taken = socket.socket(socket.AF_INET, kind)
    taken.bind(("127.0.0.1", port))
    return taken


def recording_starts(bench):
    """Faults of the recording's place."""
    missing = bench.file("missing")
    yield Start("folder missing", "No such file|folder exists", lambda: os.mkdir(missing), record=os.path.join(missing, "a.windlog"))

    foreign = bench.file("foreign.windlog", "not a recording\n")
    yield Start("foreign file", "not a (Yuragi )?recording|not a database", lambda: os.remove(foreign), record=foreign)

    damaged = bench.file("damaged.windlog")
    subprocess.run([bench.settings.simulator, "recording", "-o", damaged, "--duration", "600"], check=True, capture_output=True)
    with open(damaged, "r+b") as out:
        out.seek(100)  # behind the header: the schema
        out.write(bench.random.randbytes(os.path.getsize(damaged) - 100))
    yield Start("damaged recording", "damaged|malformed", lambda: os.remove(damaged), record=damaged)

    locked = bench.file("locked.windlog")
    other = bench.start_daemon(SYNTHETIC, "--record", locked)
    yield Start("locked by another daemon", "another program", lambda: bench.expect_ends(other), record=locked)

    try:
        full, read_only = SmallDisk(bench, 1 << 20, "full"), SmallDisk(bench, 1 << 20, "read-only")
    except NotHere:
        bench.figure("disk full, folder read-only: not tried without root")
        return
    full.fill()
    yield Start("disk full", "disk is full", full.empty, SYNTHETIC + NO_ROOM_IS_KEPT, os.path.join(full.folder, "a.windlog"),
                before=full.before)
    read_only.allow_writing(False)
    yield Start("folder read-only", "[Rr]ead-only", lambda: read_only.allow_writing(True), SYNTHETIC + NO_ROOM_IS_KEPT,
                os.path.join(read_only.folder, "a.windlog"), before=read_only.before)


def page_starts(bench):
    """Faults of the page and of its token."""
    page = take_port(socket.SOCK_STREAM)
    yield Start("page's port taken", "not served", page.close, http_port=page.getsockname()[1])

    def with_token(kind, token, free):
        start = Start(kind, "token_file", None, http=f'token_file = "{token}"\n')

        def mend():
            free()
            made = bench.run("token", "--config", start.settings_file, "--new")
            bench.expect(made.returncode == 0, f"{kind}: no new token: {made.stderr}")

        start.mend = mend
        return start

    yield with_token("token file missing", bench.file("token"), lambda: None)
    unreadable = bench.file("token-unreadable")
    os.mkdir(unreadable)  # root reads everything but this
    yield with_token("token file unreadable", unreadable, lambda: os.rmdir(unreadable))


def sensor_starts(bench):
    """Faults of the sensors, and of what is known of their site."""
    site = bench.file("site.json", '{"times_s": [1, "')
    yield Start("damaged site file", None, r"site\.json.*unreadable", SYNTHETIC + f'[shaping]\nsite_median = 5\nsite_file = "{site}"\n')

    device = bench.file("anemometer")
    yield Start("sensor's device missing", "roof",
                lambda: bench.start_simulator("nmea", "--pty", "--link", device),
                f'[[sensor]]\nname = "roof"\ndriver = "nmea"\ntransport = "serial"\ndevice = "{device}"\n')

    sender = NumberedSender()
    bench.cleanups.append(sender.end)
    port = take_port(socket.SOCK_DGRAM, sender.port)
    yield Start("sensor's port taken", "numbered", port.close, OSC_SENSOR.format(port=sender.port))


@row("12 faults that are there at the start", short_s=14)
def starts(bench):
    all_starts = [*recording_starts(bench), *page_starts(bench), *sensor_starts(bench)]
    for start in all_starts:
        start.begin(bench)
    for start in all_starts:
        bench.expect(start.is_streaming(), f"{start.kind}: no pose")
        if start.reports is None:
            start.line = start.daemon.wait_for(f".*{start.mend}.*").group()
            start.recovered_s = 0.0
            continue
        start.line = start.wait_for_report(bench)
        bench.expect(start.line, f"{start.kind}: not reported; what is: {start.attention(bench)}")
        health = start.health()
        bench.expect((health is None) == (start.kind == "page's port taken"), f"{start.kind}: healthz: {health}")
        bench.expect(health is None or health[0] == 503 and re.search(start.reports, health[1]), f"{start.kind}: healthz: {health}")

    wait_until(time.monotonic() + bench.choose(30.0, 0.0))
    waiting = [start for start in all_starts if start.recovered_s is None]
    for start in waiting:
        start.mend()
        start.mended_s = time.monotonic()
    deadline_s = time.monotonic() + HANG_S
    while waiting and time.monotonic() < deadline_s:
        for start in waiting:
            health = start.health()
            if health and not start.reported(health[1].splitlines()) and not start.reported(start.attention(bench)):
                start.recovered_s = time.monotonic() - start.mended_s
        waiting = [start for start in waiting if start.recovered_s is None]
        wait_until(time.monotonic() + POLL_S)
    for start in waiting:
        bench.failures.append(f"{start.kind}: it did not recover: {start.attention(bench)}")
    bench.count(len(all_starts), "faults")
    for start in all_starts:
        bench.expect_alive(start.daemon)
        bench.expect_ends(start.daemon)
        recovered = "not recovered" if start.recovered_s is None else f"recovered after {start.recovered_s:.1f} s"
        line = start.line.replace(bench.folder + "/", "")
        bench.figure(f"{start.kind}: runs; \"{line}\"; {recovered}")
