#!/usr/bin/env python3
"""Processor seconds of `yuragi import` beside those of `sqlite3 .import` (and of pandas, where it is installed) for the same file, in turn.

usage: import_bench.py YURAGI [--rows 2600000] [--turns 3]
"""
import argparse
import pathlib
import random
import resource
import statistics
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("yuragi")
parser.add_argument("--rows", type=int, default=2_600_000)
parser.add_argument("--turns", type=int, default=3)
arguments = parser.parse_args()


def write(file, rows):
    draw = random.Random(1)
    with open(file, "w", encoding="utf-8") as out:
        out.write("time,speed_m_s,direction_deg\n")
        for i in range(rows):
            seconds, tenth = divmod(i, 10)
            day, second = divmod(seconds, 86400)
            out.write(f"2024-{1 + day // 28:02}-{1 + day % 28:02}T{second // 3600:02}:{second // 60 % 60:02}:{second % 60:02}.{tenth}Z,"
                      f"{draw.random() * 9:.2f},{draw.randrange(360)}\n")


def cpu_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


with tempfile.TemporaryDirectory() as folder:
    source, recording, database = (pathlib.Path(folder, name) for name in ("a.csv", "a.windlog", "a.db"))
    write(source, arguments.rows)
    commands = {
        "yuragi import": [arguments.yuragi, "import", source, "-o", recording],
        "sqlite3 .import": ["sqlite3", database, ".mode csv", "create table t(time text, speed real, direction real)", f".import --skip 1 {source} t"],
        "pandas": [sys.executable, "-c", f"import pandas, sqlite3; pandas.read_csv({str(source)!r}, parse_dates=['time'])"
                   f".to_sql('t', sqlite3.connect({str(database)!r}), index=False)"],
    }
    if subprocess.run([sys.executable, "-c", "import pandas"], stderr=subprocess.DEVNULL, check=False).returncode != 0:
        del commands["pandas"]
        print("pandas is not installed")
    times = {name: [] for name in commands}
    for _ in range(arguments.turns):
        for name, command in commands.items():
            for file in (recording, database):
                file.unlink(missing_ok=True)
            times[name].append(cpu_seconds(command))
    base = statistics.median(times["sqlite3 .import"])
    print(f"{arguments.rows} rows, median of {arguments.turns}")
    for name, values in times.items():
        print(f"{name:16} {statistics.median(values):7.2f} s of processor  {statistics.median(values) / base:5.2f} of sqlite3 .import")
