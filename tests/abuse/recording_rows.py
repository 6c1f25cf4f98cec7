"""What happens to the recording, to its disk and to the process that writes it."""
import errno
import glob
import json
import os
import shutil
import sqlite3
import subprocess
import time

from bench import (OSC_SENSOR, RECORDER_HANGING, RECORDER_RETRYING, RECORDER_WRITING, Faults, NotHere, NumberedSender, SmallDisk,
                   Witness, numbers_recorded, row, wait_until)

LOST_S = 1.5  # what was said longer ago than this when it was killed is on the disk


def is_blank(file):
    """Was the file renamed before anything was committed to it? Then its readings are in the next one. A damaged file is not blank."""
    database = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
    try:
        return database.execute("SELECT count(*) FROM sqlite_master").fetchone()[0] == 0
    except sqlite3.DatabaseError:
        return False
    finally:
        database.close()


def expect_intact(bench, file, name):
    """Is a copy of the recording, with what SQLite has beside it, a sound database? And does each command read it?"""
    copy = bench.file("copy.windlog")
    for suffix in ("", "-wal", "-shm"):
        if os.path.exists(copy + suffix):
            os.remove(copy + suffix)
        if os.path.exists(file + suffix):
            shutil.copy(file + suffix, copy + suffix)
    database = sqlite3.connect(copy)
    try:
        found = database.execute("PRAGMA integrity_check").fetchone()[0]
    except sqlite3.DatabaseError as error:
        found = str(error)
    database.close()
    bench.expect(found == "ok", f"{name}: integrity: {found}")


def expect_replays(bench, file):
    done = bench.run("replay", file, "--rate", "max", "--sensor", "numbered", "--config",
                     bench.file("replay.toml", "[animation]\nrate = 5\n"), timeout_s=600)
    bench.expect(done.returncode == 0 and "pose hash" in done.stdout, f"replay: {done.returncode} {done.stderr.strip()}")


def expect_once(bench, numbers, name=""):
    twice = len(numbers) - len(set(numbers))
    bench.expect(twice == 0, f"{name}{twice} readings are recorded twice")


def start_recording(bench, file, config="", **options):
    """Starts a daemon that records numbered readings, and waits until some are written. Answers who sends them, the daemon, and a
    witness."""
    sender = NumberedSender()
    daemon = bench.start_daemon(OSC_SENSOR.format(port=sender.port) + config, "--record", file, **options)
    witness = Witness(bench, daemon)
    witness.wait_for(lambda sensors: sensors["recorder"]["written"] > 5)
    return sender, daemon, witness


def wait_for_readings(bench, daemon):
    """From when on readings of the numbered sensor come in: a moment by which some have."""
    witness = Witness(bench, daemon)
    seen = witness.wait_for(lambda sensors: sensors["sensors"][0]["readings"] > 0)
    now_s = time.monotonic()
    witness.end()
    return now_s if seen else None


@row("kill -9 at a random moment, recording at 10 Hz", short_s=14)
def kill_9(bench):
    kills = bench.choose(100, 5)
    sender = NumberedSender(rate_hz=10.0)
    file = bench.file("wall.windlog")
    expected = set()
    oldest_lost_s = 0.0
    without_readings = 0
    for kill in range(kills):
        daemon = bench.start(bench.settings.yuragi, "run", "--listen", "127.0.0.1:0", "--record", file, "--config",
                             bench.file("kill.toml", OSC_SENSOR.format(port=sender.port)))
        begin_s = time.monotonic()
        if kill + 1 < kills and bench.random.random() < 0.2:  # while it begins
            wait_until(begin_s + bench.random.uniform(0.0, 0.4))
            from_s = None
        else:
            from_s = wait_for_readings(bench, daemon)
            # The last one comes after readings that must be there.
            least_s = LOST_S + 0.3 if kill + 1 == kills else 0.0
            wait_until(time.monotonic() + least_s + bench.random.uniform(*bench.choose((0.0, 4.0), (1.2, 2.5))))
        if daemon.process.poll() is not None:
            bench.failures.append(f"it ended by itself with {daemon.process.poll()}: {daemon.text()[-300:]}")
            break
        daemon.process.kill()
        killed_s = time.monotonic()
        daemon.process.wait()
        if not os.path.exists(file):
            without_readings += 1
            continue
        expect_intact(bench, file, f"kill {kill + 1}")
        recorded = numbers_recorded(bench, file)
        expect_once(bench, recorded, f"kill {kill + 1}: ")
        recorded = set(recorded)
        if from_s is None:
            without_readings += 1
        else:
            missing = sender.numbers_sent(from_s, killed_s - 0.001) - recorded
            age_s = max((killed_s - sender.sent_s[number] for number in missing), default=0.0)
            oldest_lost_s = max(oldest_lost_s, age_s)
            expected |= sender.numbers_sent(from_s, killed_s - LOST_S)
        bench.expect(expected <= recorded, f"kill {kill + 1}: {len(expected - recorded)} readings older than {LOST_S} s are lost")
    sender.end()
    expect_replays(bench, file)
    bench.count(kills, "kills")
    bench.figure(f"{without_readings} of them while it began; {len(expected):,} readings were to be there, and were; the oldest "
                 f"that was lost was {oldest_lost_s:.2f} s old")
    bench.expect(expected or kills == without_readings, "nothing was to be recorded")


def record_through(bench, fault, mend, state, file, config="", before=(), environment=None):
    """Records numbered readings before, through and after a fault of the disk: the state is told, the recorder loses none, and the
    frames come as before. Answers the numbers that are to be recorded."""
    options = {"env": environment} if environment else {}
    sender, daemon, witness = start_recording(bench, file, config, before=before, **options)
    from_s = time.monotonic()
    quiet = witness.watch(1.0)
    fault()
    begin_s = time.monotonic()
    told_state = witness.wait_for(lambda sensors: sensors["recorder"]["state"] == state)
    if bench.expect(told_state, "the state was not told"):
        error = told_state["recorder"]["error"].replace(bench.folder + "/", "")
        bench.figure(f"told after {time.monotonic() - begin_s:.1f} s: {error}")
    wait_until(begin_s + 3.0)
    waiting = witness.wait_for(lambda sensors: True)["recorder"]["waiting"]
    mend()
    mended_s = time.monotonic()
    good = witness.wait_for(lambda sensors: sensors["recorder"]["state"] == RECORDER_WRITING
                            and sensors["recorder"]["written"] >= sensors["sensors"][0]["readings"] - 60 and sensors["recorder"]["waiting"] < 30)
    if bench.expect(good, "it did not recover"):
        bench.figure(f"{waiting} readings waited; all well again after {time.monotonic() - mended_s:.1f} s, "
                     f"{good['recorder']['lost']} lost")
        bench.expect(good["recorder"]["lost"] == 0, f"{good['recorder']['lost']} readings were lost")
    attacked = witness.mark()
    witness.expect_undisturbed(quiet, attacked)
    bench.figure("client beside it: " + attacked.text())
    bench.expect_alive(daemon)
    to_s = time.monotonic()
    took_s = bench.expect_ends(daemon)
    bench.figure(f"ended in {took_s:.1f} s")
    sender.end()
    return sender.numbers_sent(from_s, to_s - 0.2)


def expect_all(bench, wanted, recorded):
    expect_once(bench, recorded)
    missing = wanted - set(recorded)
    bench.count(len(wanted), "readings")
    bench.expect(not missing, f"{len(missing)} of {len(wanted)} readings are missing")


@row("disk full, and then not", short_s=15)
def disk_full(bench):
    try:
        disk = SmallDisk(bench, 1 << 20)
    except NotHere:
        return disk_full_by_errno(bench)
    file = os.path.join(disk.folder, "wall.windlog")
    wanted = record_through(bench, disk.fill, disk.empty, RECORDER_RETRYING, file, before=disk.before,
                            config="[recording]\nmin_free = 0\n")
    expect_all(bench, wanted, numbers_recorded(bench, file, before=disk.before))
    bench.figure("a tmpfs of 1 MiB")


def disk_full_by_errno(bench):
    faults = Faults(bench)
    file = bench.file("wall.windlog")
    wanted = record_through(bench, lambda: faults.set(write_error=errno.ENOSPC), lambda: faults.set(write_error=0),
                            RECORDER_RETRYING, file, environment=faults.environment())
    expect_all(bench, wanted, numbers_recorded(bench, file))
    bench.figure("by ENOSPC: no mount namespace here")


@row("disk with errors (EIO on each write)")
def disk_errors(bench):
    faults = Faults(bench)
    file = bench.file("wall.windlog")
    wanted = record_through(bench, lambda: faults.set(write_error=errno.EIO), lambda: faults.set(write_error=0),
                            RECORDER_RETRYING, file, environment=faults.environment())
    expect_all(bench, wanted, numbers_recorded(bench, file))


@row("disk that hangs for a while", short_s=11)
def disk_hangs(bench):
    faults = Faults(bench)
    file = bench.file("wall.windlog")
    wanted = record_through(bench, lambda: faults.set(write_delay_s=-1.0), lambda: faults.set(write_delay_s=0.0),
                            RECORDER_HANGING, file, environment=faults.environment())
    expect_all(bench, wanted, numbers_recorded(bench, file))


@row("disk that hangs for ever, and the end", short_s=9)
def end_while_disk_hangs(bench):
    faults = Faults(bench)
    sender, daemon, witness = start_recording(bench, bench.file("wall.windlog"), env=faults.environment())
    faults.set(write_delay_s=-1.0)
    witness.wait_for(lambda sensors: sensors["recorder"]["state"] == RECORDER_HANGING or sensors["recorder"]["waiting"] > 20)
    sender.end()
    witness.end()
    took_s = bench.expect_ends(daemon)
    bench.count(1, "end")
    bench.figure(f"ended in {took_s:.1f} s")
    told = [line for line in daemon.text().splitlines() if "not" in line and "written" in line]
    bench.expect(told, "what was not written is not told: " + daemon.text()[-300:])
    bench.figure(told[-1].split(" ", 2)[-1].replace(bench.folder + "/", "") if told else "")
    faults.set(write_delay_s=0.0)
    expect_intact(bench, bench.file("wall.windlog"), "what is left")


@row("slow disk (0.3 s a write)")
def slow_disk(bench):
    faults = Faults(bench)
    file = bench.file("wall.windlog")
    sender, daemon, witness = start_recording(bench, file, env=faults.environment())
    from_s = time.monotonic()
    quiet = witness.watch(1.0)
    faults.set(write_delay_s=0.3)
    attacked = witness.watch(bench.choose(30.0, 5.0))
    waiting = attacked.sensors["recorder"]["waiting"]
    witness.expect_undisturbed(quiet, attacked)
    faults.set(write_delay_s=0.0)
    to_s = time.monotonic()
    bench.figure("client beside it: " + attacked.text())
    bench.figure(f"{waiting} readings waited at the end of it")
    bench.expect(waiting < 10 * 20, f"{waiting} readings waited")
    bench.expect_ends(daemon)
    sender.end()
    expect_all(bench, sender.numbers_sent(from_s, to_s), numbers_recorded(bench, file))


@row("disk that is pulled out and put back")
def disk_vanishes(bench):
    disk = SmallDisk(bench, 4 << 20)
    file = os.path.join(disk.folder, "wall.windlog")
    wanted = record_through(bench, disk.unmount, disk.mount, RECORDER_RETRYING, file, before=disk.before,
                            config="[recording]\nmin_free = 0\n")
    recorded = numbers_recorded(bench, file, before=disk.before)
    expect_once(bench, recorded)
    recorded = set(recorded)
    lost = wanted - recorded  # what had been written is on the disk that went
    kept = sorted(wanted & recorded)
    bench.count(len(wanted), "readings")
    bench.expect(kept and set(range(kept[0], max(wanted) + 1)) <= recorded, "there is a gap in what was recorded afterwards")
    bench.figure(f"{len(lost)} went with the disk, {len(kept)} are on the new one without a gap")


@row("recording renamed, removed and replaced while it is written", short_s=12)
def recording_renamed(bench):
    file = bench.file("wall.windlog")
    sender, daemon, witness = start_recording(bench, file)
    from_s = time.monotonic()
    times = bench.choose(30, 3)
    for number in range(times):
        before = witness.wait_for(lambda sensors: True)["recorder"]["written"]
        os.rename(file, bench.file(f"moved-{number}.windlog"))
        if number % 3 == 2:  # another file takes its name: one that becomes a recording, or one that is none
            is_empty = number % 2 == 0
            with open(file, "w", encoding="utf-8") as other:
                other.write("" if is_empty else "not a recording\n")
            witness.wait_for(lambda sensors, least=before + 15, empty=is_empty: sensors["recorder"]["written"] > least if empty
                             else sensors["recorder"]["state"] == RECORDER_RETRYING)
            os.rename(file, bench.file(f"other-{number}.windlog"))
            before = witness.wait_for(lambda sensors: True)["recorder"]["written"]
        goes_on = witness.wait_for(lambda sensors, least=before + 15: sensors["recorder"]["written"] > least
                                   and os.path.exists(file))
        bench.expect(goes_on, f"it did not go on after rename {number + 1}")
    lost = witness.wait_for(lambda sensors: True)["recorder"]["lost"]
    to_s = time.monotonic()
    bench.expect_alive(daemon)
    bench.expect_ends(daemon)
    sender.end()
    recorded = []
    for part in [file, *sorted(glob.glob(bench.file("moved-*.windlog")) + glob.glob(bench.file("other-*.windlog")))]:
        with open(part, "rb") as content:
            if not content.read(16).startswith(b"SQLite format") or is_blank(part):
                continue
        expect_intact(bench, part, os.path.basename(part))
        recorded += numbers_recorded(bench, part)
    bench.count(times, "renames")
    bench.expect(lost == 0, f"{lost} readings were lost")
    expect_all(bench, sender.numbers_sent(from_s, to_s - 0.2), recorded)


@row("clock set forward, back, and by 31 years, while it records")
def clock_steps(bench):
    faults = Faults(bench)
    file = bench.file("wall.windlog")
    sender, daemon, witness = start_recording(bench, file, env=faults.environment())
    from_s = time.monotonic()
    quiet = witness.watch(1.0)
    steps = [3600.0, -7200.0, 86400.0, 31 * 365.25 * 86400.0, -31 * 365.25 * 86400.0]
    steps += [bench.random.uniform(-1e5, 1e5) for _ in range(bench.choose(40, 0))]
    for step_s in steps:
        faults.set(clock_ahead_s=step_s)
        wait_until(time.monotonic() + bench.random.uniform(0.3, 1.3))
    attacked = witness.mark()
    witness.expect_undisturbed(quiet, attacked)
    lost = witness.wait_for(lambda sensors: True)["recorder"]["lost"]
    to_s = time.monotonic()
    bench.figure("client beside it: " + attacked.text())
    bench.expect_ends(daemon)
    sender.end()
    bench.count(len(steps), "steps")
    expect_intact(bench, file, "the recording")
    bench.figure(f"{lost} readings lost")
    recorded = numbers_recorded(bench, file)
    expect_all(bench, sender.numbers_sent(from_s, to_s - 0.2), recorded)


@row("a simulated half year within its quota", short_s=8)
def half_year(bench):
    if not os.path.exists(bench.settings.half_year):
        raise NotHere("yuragi-half-year is not built")
    interval_s = bench.choose(1.0, 60.0)
    days, max_size_mb = 183, bench.choose(100, 2)
    # (keep_days, max_size, max_file_size)
    rules = {"keep_days": (60, 0, 0), "max_size": (0, max_size_mb, 0), "all rules": (120, max_size_mb, bench.choose(2, 1))}
    for rule in bench.choose(sorted(rules), ["all rules"]):
        keep, size, by_size = rules[rule]
        folder = bench.file(rule)
        os.mkdir(folder)
        file = os.path.join(folder, "wall.windlog")
        done = subprocess.run([bench.settings.half_year, file, str(days), str(interval_s), str(keep), str(size), str(by_size), "0"],
                              capture_output=True, text=True, timeout=1200, check=False)
        if not bench.expect(done.returncode == 0, f"{rule}: {done.stderr}"):
            continue
        said = json.loads(done.stdout)
        bench.count(said["pushed"], f"readings ({rule})")
        bench.expect(said["lost"] == 0 and said["written"] == said["pushed"], f"{rule}: {said['lost']} lost")
        left = bench.run("export", file, "-o", "-", timeout_s=600)
        rows = left.stdout.splitlines()[1:]
        if not bench.expect(left.returncode == 0 and rows, f"{rule}: cannot be read as one: {left.stderr}"):
            continue
        # What is left: the newest span, one reading after the other, to the end of the half year.
        columns = [line.split(",") for line in rows]
        times_s = [float(cells[1]) for cells in columns]
        gap_s = max((after - before for before, after in zip(times_s, times_s[1:])), default=0.0)
        bench.expect(abs(gap_s - interval_s) < 1e-3, f"{rule}: a gap of {gap_s} s")
        last_day = round(10.0 * float(columns[-1][3]))
        first_day = round(10.0 * float(columns[0][3]))
        bench.expect(last_day == days - 1, f"{rule}: the last day is {last_day}")
        if keep:
            bench.expect(days - 1 - first_day <= keep + 1, f"{rule}: from day {first_day} on is more than {keep} days")
        if keep and not size:
            bench.expect(days - 1 - first_day >= keep - 1, f"{rule}: only days from {first_day} on are left")
        if size:
            bench.expect(said["most_bytes"] <= 1e6 * size,
                         f"{rule}: {said['most_bytes'] / 1e6:.1f} MB at once, where {size} MB are allowed")
        bench.figure(f"{rule}: at most {said['most_bytes'] / 1e6:.2f} MB in {said['most_files']} files at {said['looks']:,} looks; "
                     f"left {said['left_bytes'] / 1e6:.2f} MB, days {first_day} to {last_day}")
        shutil.rmtree(folder)


@row("a simulated half year on a disk that is too small: min_free")
def half_year_min_free(bench):
    size_mb, free_mb = bench.choose((200, 100), (20, 6))
    disk = SmallDisk(bench, size_mb * 1_000_000)
    file = os.path.join(disk.folder, "wall.windlog")
    interval_s = bench.choose(1.0, 60.0)
    done = subprocess.run([*disk.before, bench.settings.half_year, file, "183", str(interval_s), "0", "0", "0", str(free_mb)],
                          capture_output=True, text=True, timeout=1200, check=False)
    if not bench.expect(done.returncode == 0, done.stderr):
        return
    said = json.loads(done.stdout)
    bench.count(said["pushed"], "readings")
    bench.expect(said["lost"] == 0 and said["written"] == said["pushed"], f"{said['lost']} lost")
    least_mb = said["least_free_bytes"] / 1e6
    bench.figure(f"a tmpfs of {size_mb} MB of which {free_mb} are to be free: at least {least_mb:.2f} MB were, at {said['looks']:,} "
                 f"looks; {said['left_files']} files are left")
    bench.expect(least_mb >= free_mb, f"only {least_mb:.2f} MB were free")
    bench.expect(said["left_files"] > 1, "hardly anything is left")
