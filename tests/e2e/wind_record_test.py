#!/usr/bin/env python3
"""`yuragi wind` over a real recording, checked with numpy alone: is the wind that slow readings give the wind outside?

usage: wind_record_test.py YURAGI [SONIC.csv]

Imports a sonic anemometer's recording, lets `yuragi wind` hear it as a sensor of 1 s and of 14 s, and compares what
comes out with the recording: variance, mean speed and the power in octaves. The recording stands in
../shared/data/sonic beside the project; without it the test is skipped (77).
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

RATE_HZ = 20
SEEDS = 6
SEGMENT_S = 1080
# dB; variance from, to; mean speed. The octaves of six seeds scatter by a little: half a dB more than of 32.
BOUNDS = {1: (2.0, 0.85, 1.10, 0.01), 14: (4.5, 0.70, 1.30, 0.03)}


def density(wind, rate_hz):
    """One-sided density of u and v together (Welch 1967): Hann, less a straight line, all of the record."""
    size = round(SEGMENT_S * rate_hz)
    spare = len(wind) - size
    starts = np.linspace(0, spare, int(np.ceil(2 * spare / size)) + 1).astype(int)
    window = np.hanning(size + 1)[:-1]
    x = np.arange(size)
    total = 0.0
    for start in starts:
        for component in wind[start : start + size].T:
            residue = component - np.polyval(np.polyfit(x, component, 1), x)
            total = total + np.abs(np.fft.rfft(residue * window)) ** 2
    return 2 * total / (len(starts) * rate_hz * np.sum(window**2))


def octaves(psd):
    """Power from 0.6 Hz downward to 0.003 Hz."""
    frequency = np.arange(len(psd)) / SEGMENT_S
    top = 0.6
    result = []
    while top > 0.003:
        bottom = max(top / 2, 0.003)
        result.append(np.sum(psd[(frequency >= bottom) & (frequency < top)]) / SEGMENT_S)
        top /= 2
    return np.array(result[::-1])


def variance(wind):
    return np.sum(np.var(wind, axis=0))


def speed(wind):
    return np.mean(np.hypot(*wind.T))


def check(yuragi, recording, interval, record, folder):
    """Compares, prints what was found, and says whether it holds."""
    outputs = []
    out = pathlib.Path(folder, "wind.csv")
    for seed in range(1, SEEDS + 1):
        subprocess.run([yuragi, "wind", recording, "--rate", str(RATE_HZ), "--seed", str(seed), "--sensor-interval",
                        str(interval), "-o", out, "--force"], check=True, capture_output=True)
        outputs.append(np.loadtxt(out, delimiter=",", skiprows=1, usecols=(1, 2)))
    skip_s = max(30, 3 * interval)
    end_s = 1800 // interval * interval
    truth = record[10 * skip_s : 10 * end_s]
    winds = [wind[RATE_HZ * skip_s : RATE_HZ * end_s] for wind in outputs]

    ratio = np.mean([variance(wind) for wind in winds]) / variance(truth)
    mean = np.mean([speed(wind) for wind in winds]) / speed(truth)
    found = 10 * np.log10(np.mean([octaves(density(wind, RATE_HZ)) for wind in winds], axis=0) / octaves(density(truth, 10)))
    most_db, least_variance, most_variance, mean_bound = BOUNDS[interval]
    print(f"sensor of {interval} s: variance {ratio:.3f}, mean speed {mean:.4f}, octaves",
          " ".join(f"{value:+.2f}" for value in found), "dB")
    return np.max(np.abs(found)) <= most_db and least_variance <= ratio <= most_variance and abs(mean - 1) <= mean_bound


def main():
    yuragi = sys.argv[1]
    beside = pathlib.Path(__file__).resolve().parents[3] / "shared/data/sonic/finse_csat3_10hz_20180720T140000.csv"
    table = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else beside
    if not table.exists():
        print(f"skipped: {table} is not here")
        return 77
    record = np.loadtxt(table, delimiter=",", skiprows=2, usecols=(1, 2))
    with tempfile.TemporaryDirectory() as folder:
        recording = pathlib.Path(folder, "sonic.windlog")
        subprocess.run([yuragi, "import", table, "-o", recording], check=True, capture_output=True)
        holds = [check(yuragi, recording, interval, record, folder) for interval in BOUNDS]
    print("holds" if all(holds) else "does not hold")
    return 0 if all(holds) else 1


if __name__ == "__main__":
    sys.exit(main())
