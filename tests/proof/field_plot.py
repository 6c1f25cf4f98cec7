#!/usr/bin/env python3
"""A gust that crosses the ground, at four moments, seen from above. Draws what `yuragi field --windlog` writes with gnuplot.

usage: field_plot.py YURAGI PICTURE.png [--record SONIC.csv] [--from S] [--step S] [--interval S]

Colours are the wind's speed; the ground is 60 m wide and the mean wind blows upward where it comes from the south.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

RATE_HZ = 10
SIZE_M, STEP_M = 60, 0.5
MOMENTS = 4


def block_means(record, interval_s):
    """What a slower sensor would have said: time, u, v."""
    size = round(interval_s * RATE_HZ)
    means = record[: len(record) // size * size].reshape(-1, size, 2).mean(axis=1)
    return [(interval_s * (i + 1), u, v) for i, (u, v) in enumerate(means)]


def field_of(yuragi, readings, from_s, step_s, folder):
    """(moment, row from north to south, column from west to east): speed, m/s."""
    table = folder / "sensor.csv"
    rows = "\n".join(f"{at:.1f},{u:.4f},{v:.4f}" for at, u, v in readings)
    table.write_text(f"time_s,u_m_s,v_m_s\n{rows}\n", encoding="ascii")
    log, field = table.with_suffix(".windlog"), folder / "field.npy"
    for command in ([yuragi, "import", table, "-o", log, "--u", "u_m_s", "--v", "v_m_s"],
                    [yuragi, "field", "--windlog", log, "--time", from_s - readings[0][0], "--frames", MOMENTS, "--rate", 1 / step_s,
                     "--size", f"{SIZE_M}m", "--spacing", STEP_M, "-o", field]):
        subprocess.run(list(map(str, command)), check=True, capture_output=True)
    return np.hypot(*np.moveaxis(np.load(field)[:, :2, :, 0, :], 1, 0))


def draw(picture, speed, from_s, step_s, folder):
    script = [
        "set terminal pngcairo size 1500,400 font 'sans,11'", f"set output '{picture}'",
        "set multiplot layout 1,4 title 'Wind over the ground, m/s'", "set size ratio -1", "set tics out nomirror",
        f"set xrange [{-SIZE_M / 2}:{SIZE_M / 2}]", f"set yrange [{-SIZE_M / 2}:{SIZE_M / 2}]",
        f"set cbrange [{np.floor(speed.min())}:{np.ceil(speed.max())}]", "set palette defined (0 '#ffffe5', 0.5 '#78c679', 1 '#004529')",
        "set xlabel 'east, m'", "set ylabel 'north, m'",
    ]
    row, column = np.indices(speed.shape[1:])
    east, north = (column + 0.5) * STEP_M - SIZE_M / 2, SIZE_M / 2 - (row + 0.5) * STEP_M
    for number, moment in enumerate(speed):
        data = folder / f"moment{number}.txt"
        np.savetxt(data, np.stack([east, north, moment], axis=-1).reshape(-1, 3), fmt="%.3f")
        script += [f"set title '{from_s + number * step_s:g} s'", f"plot '{data}' using 1:2:3 with image notitle"]
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


def main():
    default = pathlib.Path(__file__).resolve().parents[3] / "shared/data/sonic/finse_csat3_10hz_20180720T140000.csv"
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("yuragi")
    options.add_argument("picture", type=pathlib.Path)
    options.add_argument("--record", type=pathlib.Path, default=default, help="a table of time, u, v at 10 Hz")
    options.add_argument("--from", dest="from_s", type=float, default=1141.0, help="of the first moment, s")
    options.add_argument("--step", dest="step_s", type=float, default=3.0, help="from moment to moment, s")
    options.add_argument("--interval", dest="interval_s", type=float, default=1.0, help="of the sensor, s")
    options = options.parse_args()
    record = np.loadtxt(options.record, delimiter=",", skiprows=2, usecols=(1, 2))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        speed = field_of(options.yuragi, block_means(record, options.interval_s), options.from_s, options.step_s, folder)
        draw(options.picture, speed, options.from_s, options.step_s, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
