#!/usr/bin/env python3
"""The wind along the ground as time goes by: which gusts cross it, and how fast. Draws with gnuplot.

usage: ground_plot.py YURAGI PICTURE.png [--record SONIC.csv] [--from S] [--mark S ...] [--before YURAGI]

Four panels of a line along the mean wind over 60 m, 60 s of it: a sensor of 0.1, 1 and 14 s at the windward edge, and two
anemometers of 1 s 30 m apart. Colours are the speed along the wind less its mean. A gust that travels is a stripe aslant, as steep
as the thin line, which is the mean wind's way; one that comes everywhere at once lies level. The second anemometer's record is made: what
the first has said, later by the way between them, with a share of another time's gusts so that they are as unlike as two
anemometers at that distance. --before draws a row of another program above.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

RATE_HZ = 10
SPAN_M, STEP_M = 60.0, 2.0
SHOWN_S = 60.0
APART_M = 30.0
ALIKE = 0.6  # root coherence of gusts over APART_M
RANGE_M_S = 3.0
COLUMNS = 4


def mean_wind(record):
    mean = np.mean(record, axis=0)
    speed = float(np.hypot(*mean))
    return speed, mean / speed


def second_record(record, speed_m_s):
    """What an anemometer APART_M downwind would have said: gusts later, and in part its own."""
    mean = np.mean(record, axis=0)
    later = np.roll(record - mean, round(APART_M / speed_m_s * RATE_HZ), axis=0)
    other = np.roll(record - mean, len(record) // 2, axis=0)
    return mean + ALIKE * later + np.sqrt(1 - ALIKE**2) * other


def write_table(file, record):
    rows = (f"{i / RATE_HZ:.1f},{u:.4f},{v:.4f}" for i, (u, v) in enumerate(record))
    file.write_text("time_s,u_m_s,v_m_s\n" + "\n".join(rows) + "\n", encoding="ascii")


def imported(yuragi, table):
    log = table.with_suffix(".windlog")
    subprocess.run([yuragi, "import", table, "-o", log, "--u", "u_m_s", "--v", "v_m_s", "--force"], check=True, capture_output=True)
    return log


def place_text(along_m, ahead):
    return f"{along_m * ahead[0]:.4f},{-along_m * ahead[1]:.4f}"


def wind_along(yuragi, log, ways_m, ahead, options):
    """(time, place): the part of the wind along its mean way."""
    command = [yuragi, "wind", log, "--rate", RATE_HZ, "-o", "-", *options]
    command += [f"--place={place_text(way, ahead)}" for way in ways_m]
    text = subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout.splitlines()
    first = next(i for i, line in enumerate(text) if line.startswith("time_s")) + 1
    columns = range(7, 7 + 2 * len(ways_m))
    table = np.loadtxt(text[first:], delimiter=",", usecols=columns)
    return table[:, 0::2] * ahead[0] + table[:, 1::2] * ahead[1]


def panel(data, title, speed_m_s, mark_s):
    lines = [f"set title '{title}'"]
    # Across the panel from its upper left corner, where the wind enters last.
    for begin in np.arange(5, SHOWN_S, 15):
        end = min(begin + SPAN_M / speed_m_s, SHOWN_S)
        way = (end - begin) * speed_m_s
        lines.append(f"set arrow from 0,{begin} to {way:.2f},{end:.2f} nohead front lc rgb '#80000000' lw 1")
    for at in mark_s:
        lines.append(f"set arrow from 0,{at:.2f} to {SPAN_M:g},{at:.2f} nohead front dashtype 2 lc rgb '#000000' lw 1")
    lines += [f"plot '{data}' using 1:2:3 with image notitle", "unset arrow"]
    return lines


def draw(picture, panels, speed_m_s, mark_s, folder):
    rows = len(panels) // COLUMNS
    script = [
        f"set terminal pngcairo size 1500,{20 + 560 * rows} font 'sans,11'", f"set output '{picture}'",
        f"set multiplot layout {rows},{COLUMNS} title 'Wind along the ground over 60 s, less its mean'",
        f"set xrange [0:{SPAN_M:g}]", f"set yrange [0:{SHOWN_S:g}]", f"set cbrange [{-RANGE_M_S}:{RANGE_M_S}]",
        "set xlabel 'way from the windward edge, m'", "set ylabel 'time, s'", "set tics out nomirror",
        "set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', 1 '#b2182b')",
    ]
    for number, (title, winds) in enumerate(panels):
        data = folder / f"panel{number}.txt"
        # Each picture element once: place and time of its middle, and the wind less that of all the panel.
        time, way = np.indices(winds.shape)
        rows = np.stack([way * STEP_M, time / RATE_HZ, winds - winds.mean()], axis=-1).reshape(-1, 3)
        np.savetxt(data, rows, fmt="%.3f")
        is_last = number % COLUMNS == COLUMNS - 1
        script.append("set colorbox; set cblabel 'm/s'" if is_last else "unset colorbox")
        script += panel(data, title, speed_m_s, mark_s)
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


def panels_of(yuragi, folder, ways, ahead, shown, seed, prefix):
    """Title and wind of each panel."""
    one, two = (imported(yuragi, folder / f"{key}.csv") for key in ("one", "two"))
    edge = ("--scene-size", SPAN_M / np.sqrt(2), "--seed", seed)
    panels = [(f"{prefix}a sensor of {t:g} s at the edge",
               wind_along(yuragi, one, ways, ahead, ("--sensor-interval", t, *edge))[shown]) for t in (0.1, 1, 14)]
    # Where they stand on the line: at its beginning and in its middle.
    both = ("--sensor-interval", 1, f"--sensor-place={place_text(-APART_M, ahead)}",
            "--also", f"{two}@{place_text(0.0, ahead)}", "--seed", seed)
    panels.append((f"{prefix}anemometers of 1 s at 0 and 30 m", wind_along(yuragi, one, ways, ahead, both)[shown]))
    return panels


def main():
    default = pathlib.Path(__file__).resolve().parents[3] / "shared/data/sonic/finse_csat3_10hz_20180720T140000.csv"
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("yuragi")
    options.add_argument("picture", type=pathlib.Path)
    options.add_argument("--record", type=pathlib.Path, default=default, help="a table of time, u, v at 10 Hz")
    options.add_argument("--from", dest="from_s", type=float, default=1110.0, help="log time at which the panels begin, s")
    options.add_argument("--mark", dest="mark_s", type=float, nargs="*", default=[], help="log times to draw a line at, s")
    options.add_argument("--before", help="another program, drawn above")
    options.add_argument("--seed", type=int, default=1)
    options = options.parse_args()
    record = np.loadtxt(options.record, delimiter=",", skiprows=2, usecols=(1, 2))
    first = round(options.from_s * RATE_HZ)
    speed, ahead = mean_wind(record[first - 100 * RATE_HZ : first + round(SHOWN_S * RATE_HZ)])
    ways = np.arange(0, SPAN_M + STEP_M / 2, STEP_M) - SPAN_M / 2
    shown = slice(first, first + round(SHOWN_S * RATE_HZ) + 1)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for key, table in (("one", record), ("two", second_record(record, speed))):
            write_table(folder / f"{key}.csv", table)
        programs = [(options.before, "before: ")] if options.before else []
        programs.append((options.yuragi, "now: " if options.before else ""))
        panels = [panel for program, prefix in programs
                  for panel in panels_of(program, folder, ways, ahead, shown, options.seed, prefix)]
        draw(options.picture, panels, speed, [at - options.from_s for at in options.mark_s], folder)
    print(f"{options.picture}: mean wind {speed:.2f} m/s toward ({ahead[0]:.2f} east, {ahead[1]:.2f} north)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
