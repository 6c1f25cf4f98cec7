#!/usr/bin/env python3
"""The wind made of a station that reports instantaneous wind every 14 s, its readings taken as means and as what they are.

usage: station_plot.py YURAGI PICTURE.png [--record SONIC.csv] [--from S] [--interval S]

Draws speeds and spectra of what `yuragi wind` makes, and of the record, with gnuplot.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

RATE_HZ = 10
SHOWN_S = 240
SETTLED_S = 300
SEGMENT_S = 300


def wind_of(yuragi, log, value, folder):
    """East and north, m/s, at RATE_HZ."""
    table = folder / f"{value}.csv"
    subprocess.run([str(word) for word in (yuragi, "wind", log, "-o", table, "--rate", RATE_HZ, "--value", value)], check=True,
                   capture_output=True)
    names = table.read_text(encoding="utf-8").split("\n", 1)[0].split(",")
    return np.loadtxt(table, delimiter=",", skiprows=1, usecols=(names.index("u_m_s"), names.index("v_m_s")))


def spectrum_of(wind):
    """Frequency times density of both components, m^2/s^2, mean over half-octaves."""
    size = SEGMENT_S * RATE_HZ
    window = np.hanning(size)[:, None]
    starts = range(SETTLED_S * RATE_HZ, len(wind) - size, size // 2)
    segments = [wind[start:start + size] - wind[start:start + size].mean(axis=0) for start in starts]
    power = np.mean([np.abs(np.fft.rfft(window * part, axis=0)) ** 2 for part in segments], axis=0).sum(axis=1)
    density = 2 * power / (RATE_HZ * (window ** 2).sum())
    frequency = np.fft.rfftfreq(size, 1 / RATE_HZ)
    edges = 2.0 ** np.arange(-7.5, 1.5, 0.5)
    places = [(frequency >= low) & (frequency < high) for low, high in zip(edges, edges[1:])]
    return np.array([(frequency[at].mean(), (frequency[at] * density[at]).mean()) for at in places if at.any()])


def draw(picture, winds, from_s, folder):
    colors = {"record": "#999999", "taken as means": "#d95f02", "taken as instantaneous": "#1b9e77"}
    lines = {"speed": [], "spectrum": []}
    for name, wind in winds.items():
        begin = int(from_s * RATE_HZ)
        shown = np.hypot(*wind[begin:begin + SHOWN_S * RATE_HZ].T)
        for kind, data in (("speed", np.stack([from_s + np.arange(len(shown)) / RATE_HZ, shown], axis=-1)), ("spectrum", spectrum_of(wind))):
            file = folder / f"{kind} {name}.txt"
            np.savetxt(file, data, fmt="%.5f")
            lines[kind].append(f"'{file}' with lines lw 2 lc rgb '{colors[name]}' title '{name}'")
    script = ["set terminal pngcairo size 1500,450 font 'sans,11'", f"set output '{picture}'", "set multiplot layout 1,2",
              "set tics out nomirror", "set xlabel 's'", "set ylabel 'speed, m/s'", "plot " + ", ".join(lines["speed"]),
              "set logscale xy", "set xlabel 'frequency, Hz'", "set ylabel 'frequency times density, m^2/s^2'",
              "plot " + ", ".join(lines["spectrum"])]
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


def main():
    default = pathlib.Path(__file__).resolve().parents[3] / "shared/data/sonic/finse_csat3_10hz_20180720T133000.csv"
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("yuragi")
    options.add_argument("picture", type=pathlib.Path)
    options.add_argument("--record", type=pathlib.Path, default=default, help="a table of time, u, v at 10 Hz")
    options.add_argument("--from", dest="from_s", type=float, default=900.0, help="of the first speed, s")
    options.add_argument("--interval", dest="interval_s", type=float, default=14.0, help="of the station, s")
    options = options.parse_args()
    record = np.loadtxt(options.record, delimiter=",", skiprows=2, usecols=(1, 2))
    step = round(options.interval_s * RATE_HZ)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        rows = "\n".join(f"{at / RATE_HZ:.1f},{record[at][0]:.4f},{record[at][1]:.4f}" for at in range(0, len(record), step))
        table, log = folder / "station.csv", folder / "station.windlog"
        table.write_text(f"time_s,u_m_s,v_m_s\n{rows}\n", encoding="ascii")
        subprocess.run([str(word) for word in (options.yuragi, "import", table, "-o", log, "--u", "u_m_s", "--v", "v_m_s")], check=True,
                       capture_output=True)
        winds = {"record": record, "taken as means": wind_of(options.yuragi, log, "mean", folder),
                 "taken as instantaneous": wind_of(options.yuragi, log, "instant", folder)}
        for kind, wind in winds.items():
            settled = wind[SETTLED_S * RATE_HZ:]
            print(f"{kind}: variance {settled.var(axis=0).sum():.3f} m^2/s^2")
        draw(options.picture, winds, options.from_s, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
