"""The process itself: signals, and a log that nobody reads."""
import fcntl
import os
import re
import signal
import subprocess
import time

from bench import MEADOW, Witness, numbers_recorded, row, wait_until
from recording_rows import expect_all, expect_intact, start_recording

WITHOUT_MEANING = (signal.SIGUSR1, signal.SIGUSR2, signal.SIGPIPE, signal.SIGXFSZ, signal.SIGALRM)


@row("signals that mean nothing to it")
def signals_without_meaning(bench):
    file = bench.file("wall.windlog")
    sender, daemon, witness = start_recording(bench, file)
    from_s = time.monotonic()
    quiet = witness.watch(1.0)
    signals = bench.choose(5000, 200)
    for _ in range(signals):
        daemon.process.send_signal(bench.random.choice(WITHOUT_MEANING[:4]))
        wait_until(time.monotonic() + bench.random.uniform(0.0, 0.02))
        if daemon.process.poll() is not None:
            break
    attacked = witness.mark()
    bench.expect_alive(daemon)
    witness.expect_undisturbed(quiet, attacked)
    to_s = time.monotonic()
    bench.expect_ends(daemon)
    sender.end()
    bench.count(signals, "signals")
    bench.figure("client beside it: " + attacked.text())
    expect_all(bench, sender.numbers_sent(from_s, to_s - 0.2), numbers_recorded(bench, file))


@row("SIGTERM and SIGINT at a random moment of its set-up or of its run")
def end_at_any_moment(bench):
    ends = bench.choose(100, 12)
    longest_s = 0.0
    codes = {}
    file = bench.file("wall.windlog")
    config = bench.file("end.toml", '[[sensor]]\ndriver = "synthetic"\nrate = 10\n' + MEADOW)
    for number in range(ends):
        daemon = bench.start(bench.settings.yuragi, "run", "--listen", "127.0.0.1:0", "--config", config, "--record", file)
        wait_until(time.monotonic() + bench.random.uniform(0.0, bench.choose(1.0, 0.8)))
        which = bench.random.choice((signal.SIGTERM, signal.SIGINT))
        begin_s = time.monotonic()
        code = daemon.end(which)
        longest_s = max(longest_s, time.monotonic() - begin_s)
        codes[code] = codes.get(code, 0) + 1
        # While it sets up a signal has its default action.
        bench.expect(code == 0 or (code == -which and "listening on" not in daemon.text()),
                     f"end {number + 1}: {code}: {daemon.text()[-200:]}")
        if os.path.exists(file):
            expect_intact(bench, file, f"end {number + 1}")
    bench.count(ends, "ends")
    bench.expect(longest_s < 6.0, f"it took {longest_s:.1f} s")
    bench.figure(f"the longest took {longest_s:.2f} s")
    bench.figure(f"{codes.get(0, 0)} with code 0, {ends - codes.get(0, 0)} by the signal during the set-up")


class UnreadDaemon:
    """A daemon that logs much into a pipe of 4 KiB, of which nothing is read but the address."""

    def __init__(self, bench):
        config = bench.file("log.toml", MEADOW)
        self.process = subprocess.Popen([bench.settings.yuragi, "run", "--listen", "127.0.0.1:0", "--verbose", "--config", config],
                                        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, bufsize=0)
        bench.cleanups += [self.process.stderr.close, self.process.wait, self.process.kill]
        fcntl.fcntl(self.process.stderr, fcntl.F_SETPIPE_SZ, 4096)
        lines = (re.search(rb"listening on (\S+:\d+)", line) for line in self.process.stderr)
        self.listens = next(found for found in lines if found).group(1).decode()

    def address(self):
        return self.listens


def log_row(bench, spoil):
    daemon = UnreadDaemon(bench)
    witness = Witness(bench, daemon)
    quiet = witness.watch(bench.choose(4.0, 1.5))
    spoil(daemon)
    for what, number in bench.end_of_attack(bench.attack("storm", daemon.address(), bench.choose(30.0, 2.0))).items():
        bench.count(number, what + ", each of which is logged")
    attacked = witness.mark()
    bench.expect(daemon.process.poll() is None, f"it has ended with {daemon.process.poll()}")
    witness.expect_undisturbed(quiet, attacked)
    bench.figure("client beside it: " + attacked.text())
    begin_s = time.monotonic()
    daemon.process.terminate()
    code = daemon.process.wait(60)
    took_s = time.monotonic() - begin_s
    bench.expect(code == 0, f"it ended with {code}")
    bench.expect(took_s < 6.0, f"it took {took_s:.1f} s to end")
    bench.figure(f"ended in {took_s:.1f} s")


@row("log: a pipe that nobody reads")
def log_unread(bench):
    log_row(bench, lambda daemon: None)


@row("log: a pipe whose reader has gone")
def log_reader_gone(bench):
    log_row(bench, lambda daemon: daemon.process.stderr.close())
