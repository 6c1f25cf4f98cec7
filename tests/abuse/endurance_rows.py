"""Long times: at the wall's own pace with everything going wrong, and a day as fast as it goes."""
import errno
import glob
import os
import re
import subprocess
import threading
import time

from bench import (MEADOW, OSC_SENSOR, RECORDER_WRITING, Faults, NumberedSender, Sampler, Witness, free_port, numbers_recorded, row)
from recording_rows import expect_all, expect_intact, is_blank

SENSORS = """
[stream]
max_clients = 32
[wind]
handover = 1
return_after = 2
[[sensor]]
name = "roof"
driver = "modbus"
profile = "renke-rs-fsjt-rs-fxjt-n01"
port = {modbus}
poll_interval = 0.2
[[sensor]]
name = "mast"
driver = "nmea"
transport = "tcp"
host = "127.0.0.1"
port = {nmea}
"""
FLAG = '[[scene]]\nkind = "flag"\nname = "flag"\n'


class ProcessThatReturns(threading.Thread):
    """A simulator that is killed now and then, and started again: a sensor that is unplugged."""

    def __init__(self, bench, arguments, every_s):
        super().__init__(daemon=True)
        self.bench, self.arguments, self.every_s = bench, arguments, every_s
        self.random = bench.random
        self.kills = 0
        self.ended = threading.Event()
        self.program = bench.start_simulator(*arguments)
        self.program.wait_for(r":\d+")
        self.start()

    def run(self):
        while not self.ended.wait(self.random.uniform(0.5, 1.5) * self.every_s):
            self.program.process.kill()
            self.program.process.wait()
            self.kills += 1
            if self.ended.wait(self.random.uniform(0.5, 4.0)):
                return
            self.program = self.bench.start_simulator(*self.arguments)

    def end(self):
        self.ended.set()
        self.join()


class DiskFaults(threading.Thread):
    """Faults of the disk at random times, each of which is over after a while; and a recording that is renamed."""

    def __init__(self, bench, faults, file, every_s, lasts_s):
        super().__init__(daemon=True)
        self.bench, self.faults, self.file, self.every_s, self.lasts_s = bench, faults, file, every_s, lasts_s
        self.counts = {}
        self.ended = threading.Event()
        self.start()

    def run(self):
        kinds = {"slow": {"write_delay_s": 0.1}, "hangs": {"write_delay_s": -1.0}, "full": {"write_error": errno.ENOSPC},
                 "error": {"write_error": errno.EIO}, "renamed": {}}
        while not self.ended.wait(self.bench.random.uniform(0.5, 1.5) * self.every_s):
            kind = self.bench.random.choice(sorted(kinds))
            if kind == "renamed" and not os.path.exists(self.file):
                continue
            self.counts[kind] = self.counts.get(kind, 0) + 1
            if kind == "renamed":
                os.rename(self.file, self.file.replace(".windlog", f"-moved-{self.counts[kind]}.windlog"))
            self.faults.set(**kinds[kind])
            self.ended.wait(self.bench.random.uniform(0.3, 1.5) * self.lasts_s)
            self.faults.set(write_delay_s=0.0, write_error=0)

    def end(self):
        self.ended.set()
        self.join()


@row("half an hour at its own pace: sensors, disk and clients at random", short_s=20)
def half_hour(bench):
    minutes = bench.settings.minutes or 30.0
    quiet_s, fault_s = bench.choose((4.0 * minutes, 60.0 * minutes), (3.0, 14.0))
    ports = {"modbus": free_port(), "nmea": free_port()}
    seed = str(bench.random.randrange(1 << 31))
    period_s = bench.choose("20", "4")
    sensors = [ProcessThatReturns(bench, arguments, bench.choose(60.0, 8.0)) for arguments in (
        ("modbus", "--tcp", f"127.0.0.1:{ports['modbus']}", "--random-faults", period_s, "--random-fault-duration", "2",
         "--seed", seed),
        ("nmea", "--tcp", f"127.0.0.1:{ports['nmea']}", "--rate", "10", "--random-faults", period_s, "--random-fault-duration", "2",
         "--seed", seed))]
    sender = NumberedSender()
    faults = Faults(bench)
    file = bench.file("wall.windlog")
    # The numbered sensor is the first.
    config = OSC_SENSOR.format(port=sender.port) + SENSORS.format(**ports).replace("[stream]", "\n[stream]") + FLAG
    daemon = bench.start_daemon(config, "--record", file, env=faults.environment())
    witness = Witness(bench, daemon)
    witness.wait_for(lambda sensors: sensors["recorder"]["written"] > 5)
    from_s = time.monotonic()
    quiet = witness.watch(quiet_s)
    sampler = Sampler(daemon.process.pid)
    before = sampler.sample()
    disk = DiskFaults(bench, faults, file, bench.choose(30.0, 2.0), bench.choose(8.0, 1.5))
    visitors = bench.attack("passers_by", daemon.address(), fault_s)
    visited = bench.end_of_attack(visitors)
    disk.end()
    attacked = witness.mark()
    sampler.end()
    for sensor in sensors:
        sensor.end()

    good = witness.wait_for(lambda seen: seen["recorder"]["state"] == RECORDER_WRITING and seen["recorder"]["waiting"] < 50
                            and seen["clients"] == 1)
    bench.expect(good, "recorder or clients did not come back")
    to_s = time.monotonic()
    bench.expect_alive(daemon)
    witness.expect_undisturbed(quiet, attacked, sampler.stood_still_s())
    bench.figure(f"the machine itself stood still for up to {sampler.stood_still_s():.1f} s")
    memory_kib, descriptors, threads = sampler.growth(1), sampler.growth(3), sampler.growth(4)
    peak_kib = max((sample[2] for sample in sampler.samples), default=0)
    bench.expect(memory_kib < bench.choose(1024, 6 * 1024), f"memory grows: {memory_kib:.0f} KiB along the fitted line")
    # Up to 12 visitors are there at any moment: in a short time the line follows them.
    bench.expect(descriptors < bench.choose(6.0, 15.0), f"descriptors grow: {descriptors:.1f} along the fitted line")
    bench.expect(threads < 1.0, f"threads grow: {threads:.1f} along the fitted line")
    after = sampler.sample()
    # A sensor's, that is just found.
    bench.expect(after[3] <= before[3] + 2, f"{after[3] - before[3]} descriptors more than before")
    bench.expect(after[4] <= before[4], f"{after[4] - before[4]} threads more than before")
    if good:
        bench.expect(good["recorder"]["lost"] == 0, f"{good['recorder']['lost']} readings lost by the recorder")
        ticks, io = (", ".join(f"{1e3 * value:.2f}" for value in good[key]) for key in ("tick_lateness_s", "io_lateness_s"))
        bench.figure(f"lateness p50, p99, most: ticks {ticks} ms, I/O {io} ms")
        bench.figure(f"{good['stuck_clients']} clients let go because they stopped reading; reconnects of the sensors "
                     f"{', '.join(str(sensor['reconnects']) for sensor in good['sensors'])}")
    took_s = bench.expect_ends(daemon)
    sender.end()
    recorded = []
    for part in [file, *sorted(glob.glob(file.replace(".windlog", "-moved-*.windlog")))]:
        if part != file and is_blank(part):
            continue
        expect_intact(bench, part, os.path.basename(part))
        recorded += numbers_recorded(bench, part)
    expect_all(bench, sender.numbers_sent(from_s, to_s - 0.2), recorded)
    bench.count(sum(disk.counts.values()), "faults of the disk")
    bench.count(sum(sensor.kills for sensor in sensors), "sensors unplugged")
    bench.count(visited.get("connections", 0), "visits")
    bench.figure("in the quiet time: " + quiet.text())
    bench.figure("then: " + attacked.text())
    bench.figure(f"memory {memory_kib:+.0f} KiB (at most {peak_kib / 1024:.1f} MiB), descriptors {descriptors:+.1f}, threads "
                 f"{threads:+.1f} along the fitted line over {0.75 * fault_s:.0f} s; ended in {took_s:.1f} s")


@row("recorded wind as fast as it goes")
def day_at_max_rate(bench):
    hours, rate = bench.choose((24, 60), (0.5, 20))
    log = bench.file("day.windlog")
    subprocess.run([bench.settings.simulator, "recording", "-o", log, "--interval", "1", "--duration", str(int(3600 * hours)),
                    "--speed", "7", "--seed", str(bench.settings.seed)], check=True, capture_output=True, timeout=600)
    config = bench.file("day.toml", f"[animation]\nrate = {rate}\n" + MEADOW)
    hashes = []
    for _ in range(2):
        begin_s = time.monotonic()
        replay = bench.start(bench.settings.yuragi, "replay", log, "--rate", "max", "--config", config)
        sampler = Sampler(replay.process.pid, every_s=bench.choose(1.0, 0.1))
        code = replay.process.wait(3600)
        took_s = time.monotonic() - begin_s
        sampler.end()
        bench.expect(code == 0, f"it ended with {code}: {replay.text()[-300:]}")
        found = re.search(r"pose hash  ([0-9a-f]{16})", replay.text())
        hashes.append(found.group(1) if found else None)
        memory_kib, descriptors = sampler.growth(1), sampler.growth(3)
        # SQLite keeps up to 2 MB of the pages that it has read.
        bench.expect(memory_kib < 2048, f"memory grows: {memory_kib:.0f} KiB along the fitted line")
        bench.expect(abs(descriptors) < 0.5, f"descriptors grow: {descriptors:.1f}")
        peak_kib = max((sample[2] for sample in sampler.samples), default=0)
        bench.figure(f"{took_s:.0f} s, memory {memory_kib:+.0f} KiB along the fitted line (at most {peak_kib / 1024:.1f} MiB), "
                     f"descriptors {descriptors:+.1f}")
    bench.count(hours, f"hours at {rate} ticks a second, twice")
    bench.expect(hashes[0] is not None and hashes[0] == hashes[1], f"the hashes differ: {hashes}")
    bench.figure(f"hash {hashes[0]} both times")


@row("scenes exchanged by reloads, again and again", short_s=13)
def scene_exchanges(bench):
    exchanges = bench.choose(250, 5)
    scenes = '[[scene]]\nkind = "grass"\nblades_across = {}\nblades_deep = 20\n[[scene]]\nkind = "tree"\nname = "tree"\n' + FLAG
    config = bench.file("scenes.toml", scenes.format(20))
    daemon = bench.start(bench.settings.yuragi, "run", "--listen", "127.0.0.1:0", "--config", config)
    address = daemon.address()  # it has read the file
    samples = Sampler(daemon.process.pid, every_s=bench.choose(1.0, 0.2))
    for number in range(exchanges):  # each waits until the one before has faded
        os.rename(bench.file("next.toml", scenes.format(21 - number % 2)), config)
        done = bench.run("reload", "--connect", address)
        bench.expect(done.returncode == 0 and "blades_across" in done.stdout, f"reload {number + 1}: {done.stdout}{done.stderr}")
    samples.end()
    memory_kib, descriptors, threads = (samples.growth(column) / (0.75 * exchanges) for column in (1, 3, 4))
    bench.count(exchanges, "exchanges")
    bench.expect(memory_kib < bench.choose(10.0, 2048.0), f"memory grows: {memory_kib:.1f} KiB for each")
    bench.expect(descriptors < bench.choose(0.02, 1.0), f"descriptors grow: {descriptors:.2f} for each")
    bench.expect(threads < bench.choose(0.02, 1.0), f"threads grow: {threads:.2f} for each")
    bench.expect_alive(daemon)
    bench.expect_ends(daemon)
    bench.figure(f"for each along the fitted line: memory {memory_kib:+.1f} KiB, descriptors {descriptors:+.2f}, threads {threads:+.2f}")
