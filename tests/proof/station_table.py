#!/usr/bin/env python3
"""What the wind of slow stations is like: one table of sampling, interval and wind, from outside and by numpy alone.

usage: station_table.py YURAGI [--before OLD_YURAGI] [--seeds N] [--winds NAME;...] [--intervals S,...]

Winds: both recordings of ../shared/data/sonic, and synthetic winds of von Karman's spectrum (speed, intensity and length by their
names), N seeds each. A station reports means, or instantaneous wind, at an interval; `yuragi wind` makes the wind of its readings,
there and at places around it. The table is Markdown: the median over the seeds, of the variance the 5 and 95 % quantiles, too.
OLD_YURAGI, an earlier version, gets rows of its own. Rows with NO miss a bound. 32 seeds take about an hour on two cores.
"""
import argparse
import dataclasses
import multiprocessing
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "e2e"))
import ground_wind_analysis as gw  # noqa: E402
from ground_wind_test import GUSTY, MOST_TURN_DEG, STEADY, parsed  # noqa: E402
from wind_record_test import SEGMENT_S, density  # noqa: E402

SETTLED_S = 600  # the fit's memory
MOST_WINDOWS = 4  # in which places are compared
TRAVEL_M = 20.0
ACROSS_M = (1, 3, 7, 20)
SKEWNESS_S = (0.2, 1.0, 5.0)
OCTAVES_HZ = tuple(0.6 / 2**i for i in range(7, -1, -1))
SAMPLINGS = ("mean", "instant")
INTERVALS_S = (1, 5, 14, 60)
RECORDS = {"13:30": GUSTY, "14:00": STEADY}
SYNTHETIC = {  # speed, m/s; turbulence intensity; length, m
    "5 m/s, TI 0.2, 40 m": (5.0, 0.2, 40.0),
    "3 m/s, TI 0.5, 15 m": (3.0, 0.5, 15.0),
    "10 m/s, TI 0.15, 100 m": (10.0, 0.15, 100.0),
    "1.2 m/s, TI 0.8, 15 m": (1.2, 0.8, 15.0),
    "5 m/s, TI 0.3, 300 m": (5.0, 0.3, 300.0),
}
COLUMNS = ("variance", "5 to 95 %", "octaves, dB", "sigma of direction", "kurtosis", "skewness 0.2, 1, 5 s", "delay, s",
           "travel 20 m", "sigma over 50 m", "across 1, 3, 7, 20 m")


def von_karman(speed_m_s, intensity, length_m, seed, duration_s=3277):
    """A wind toward east: von Karman's spectrum along and across it, the latter with 0.8 of the deviation."""
    count = duration_s * gw.RATE_HZ
    frequency = np.fft.rfftfreq(count, 1 / gw.RATE_HZ)
    random = np.random.default_rng(seed)
    u, v = frequency * length_m / speed_m_s, frequency * length_m / (2 * speed_m_s)
    along = 4 * length_m / speed_m_s / (1 + 70.8 * u**2) ** (5 / 6)
    across = 4 * length_m / (2 * speed_m_s) * (1 + 755.2 * v**2) / (1 + 283.2 * v**2) ** (11 / 6)
    wind = []
    for spectrum, sigma in ((along, 1.0), (across, 0.8)):
        modes = random.normal(size=len(frequency)) + 1j * random.normal(size=len(frequency))
        modes[0] = 0
        amplitude = sigma * intensity * speed_m_s * np.sqrt(spectrum * count * gw.RATE_HZ / 4)
        wind.append(np.fft.irfft(modes * amplitude, count))
    return np.stack([speed_m_s + wind[0], wind[1]], axis=1)


def sampled(wind, sampling, interval_s):
    """Times and readings of a station, each at the end of its interval."""
    size = interval_s * gw.RATE_HZ
    blocks = wind[: len(wind) // size * size].reshape(-1, size, 2)
    values = blocks.mean(axis=1) if sampling == "mean" else blocks[:, -1]
    return interval_s * np.arange(1, len(values) + 1), values


def write_station(path, wind, sampling, interval_s):
    times, values = sampled(wind, sampling, interval_s)
    speeds = np.hypot(*values.T)
    from_deg = np.degrees(np.arctan2(-values[:, 0], -values[:, 1])) % 360
    rows = "\n".join(f"{time},{speed:.4f},{direction:.3f}" for time, speed, direction in zip(times, speeds, from_deg))
    path.write_text(f"time_s,speed_m_s,direction_deg\n{rows}\n", encoding="ascii")


@dataclasses.dataclass
class Case:
    yuragi: str
    knows_value: bool  # has the program the option --value?
    wind: str
    seed: int
    sampling: str
    interval_s: int
    record: object  # an array; None: made by its seed

    def real(self):
        return self.record if self.record is not None else von_karman(*SYNTHETIC[self.wind], self.seed)


def made(case, real, places, folder):
    """The wind at the station and at places, on the record's times."""
    table, log = folder / "station.csv", folder / "station.windlog"
    write_station(table, real, case.sampling, case.interval_s)
    subprocess.run([case.yuragi, "import", table, "-o", log], check=True, capture_output=True)
    command = [case.yuragi, "wind", log, "--rate", str(gw.RATE_HZ), "--seed", str(case.seed), "--sensor-place=0,0", "-o", "-"]
    if case.knows_value:
        command += ["--value", case.sampling]
    command += [f"--place={east},{south}" for east, south in places]
    text = subprocess.run(command, check=True, capture_output=True).stdout
    # The recording begins with its first reading, at the end of the first interval.
    return case.interval_s * gw.RATE_HZ - 1, *parsed(text, len(places))


def standardized(changes, power):
    changes = changes - changes.mean()
    return float(np.mean(changes**power) / np.mean(changes**2) ** (power / 2))


def direction_sigma(wind):
    """Of what is quicker than gw.MEAN_S, rad. Weighted by the speed: in a calm there is no direction."""
    vectors = wind[:, 0] + 1j * wind[:, 1]
    mean = vectors - gw.high_passed(vectors.real) - 1j * gw.high_passed(vectors.imag)
    return float(np.sqrt(np.average(np.angle(vectors * np.conj(mean)) ** 2, weights=np.abs(vectors))))


def change(series, lag_s):
    lag = round(lag_s * gw.RATE_HZ)
    return series[lag:] - series[:-lag]


def figures(case):
    real = case.real()
    windows = [window for window in gw.windows_of(real, 0)
               if window.begin >= SETTLED_S * gw.RATE_HZ and window.turn_deg < MOST_TURN_DEG][:MOST_WINDOWS]
    window_places = []
    for window in windows:
        along = [(0.0, 0.0), (TRAVEL_M, 0.0)]
        span = [(offset, 0.0) for offset in gw.span_offsets()]
        across = [(0.0, float(d)) for d in ACROSS_M]
        window_places.append([window.place(*at) for at in (*along, *span, *across)])
    places = [place for group in window_places for place in group]
    with tempfile.TemporaryDirectory() as folder:
        before, station, elsewhere = made(case, real, places, pathlib.Path(folder))
    real = real[before:]
    length = min(len(real), len(station))
    used = slice(SETTLED_S * gw.RATE_HZ, length)
    ahead = np.mean(real[used], axis=0)
    ahead /= np.hypot(*ahead)
    along = station[used] @ ahead
    result = {
        "variance": gw.variance(station[used]) / gw.variance(real[used]),
        "octaves": np.array([band_power(station[used]), band_power(real[used])]),
        "sigma of direction": direction_sigma(station[used]) / direction_sigma(real[used]),
        "kurtosis": standardized(change(along, 0.2), 4) / standardized(change(real[used] @ ahead, 0.2), 4),
        "skewness": [standardized(change(along, lag), 3) for lag in SKEWNESS_S],
    }
    delay, travel, over, passing, sides = [], [], [], [], []
    for i, window in enumerate(windows):
        window = dataclasses.replace(window, begin=window.begin - before, end=min(window.end - before, length))
        group = elsewhere[len(window_places[i]) * i : len(window_places[i]) * (i + 1)] @ window.ahead
        passed = [gw.high_passed(series[:length]) for series in group]
        own = gw.high_passed(real[:length] @ window.ahead)
        delay.append(gw.correlations(own, passed[0], window, round(gw.RATE_HZ * (2 * case.interval_s + 2))))
        crossing_s = TRAVEL_M / window.speed_m_s
        lags = gw.correlations(passed[0], passed[1], window, gw.most_lag_of(TRAVEL_M, window))
        travel.append(gw.peak(lags, crossing_s)[0] / crossing_s)
        span = group[2 : 2 + gw.SPAN_POINTS, window.begin : window.end]
        over.append(gw.span_variance(span))
        passing.append(gw.passing_variance(real[:length] @ window.ahead, window))
        sides.append([gw.correlations(passed[0], side, window, 0)[0] for side in passed[2 + gw.SPAN_POINTS :]])
    result |= {"delay": gw.peak(np.mean(delay, axis=0))[0], "travel": np.mean(travel), "span": np.sqrt(np.mean(over) / np.mean(passing)),
               "across": np.mean(sides, axis=0)}
    return result


def band_power(wind):
    """Of both components, in octaves."""
    power = density(wind, gw.RATE_HZ)
    frequency = np.arange(len(power)) / SEGMENT_S
    return np.array([np.sum(power[(frequency >= low) & (frequency < 2 * low)]) for low in OCTAVES_HZ[:-1]])


def misses(sampling, interval_s, values, octaves):
    """What of a row is out of its bound."""
    names = []
    least, most = (0.8, 1.25) if interval_s < 60 else (0.7, 1.4)
    if not (np.quantile(values["variance"], 0.05) >= least and np.quantile(values["variance"], 0.95) <= most):
        names.append("variance")
    worst_db = {1: 2.0, 5: 2.5, 14: 2.5 if sampling == "instant" else 4.0}.get(interval_s)
    if worst_db is not None and np.max(np.abs(octaves)) > worst_db:
        names.append("octaves")
    if not 0.85 <= np.median(values["sigma of direction"]) <= 1.2:
        names.append("direction")
    if not 0.85 <= np.median(values["span"]) <= 1.15:
        names.append("sigma over 50 m")
    if not 0.9 <= np.median(values["travel"]) <= 1.1:
        names.append("travel")
    return names


def row(label, sampling, interval_s, wind, found):
    values = {name: np.array([one[name] for one in found]) for name in found[0]}
    powers = np.sum(values["octaves"], axis=0)
    octaves = 10 * np.log10(powers[0] / powers[1])
    median = {name: np.median(values[name], axis=0) for name in values}
    low, high = np.quantile(values["variance"], (0.05, 0.95))
    missed = misses(sampling, interval_s, values, octaves)
    cells = [label, f"{interval_s:g} s {sampling}", wind, f"{median['variance']:.2f}", f"{low:.2f} to {high:.2f}",
             " ".join(f"{level:+.1f}" for level in octaves), f"{median['sigma of direction']:.2f}", f"{median['kurtosis']:.2f}",
             " ".join(f"{one:+.2f}" for one in median["skewness"]), f"{median['delay']:.1f}", f"{median['travel']:.2f}",
             f"{median['span']:.2f}", " ".join(f"{one:.2f}" for one in median["across"]),
             "yes" if not missed else "NO: " + ", ".join(missed)]
    return "| " + " | ".join(cells) + " |"


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("yuragi")
    options.add_argument("--before", metavar="OLD_YURAGI")
    options.add_argument("--seeds", type=int, default=32)
    options.add_argument("--winds", help="some of their names, separated by ;")
    options.add_argument("--intervals", help="s, separated by commas")
    options.add_argument("--records", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[3] / "shared/data/sonic")
    options = options.parse_args()
    records = {}
    for name, file in RECORDS.items():
        path = options.records / f"finse_csat3_10hz_{file}.csv"
        if path.exists():
            records[name] = np.loadtxt(path, delimiter=",", skiprows=2, usecols=(1, 2))
        else:
            print(f"{path} is not here: that record has no rows", file=sys.stderr)
    winds = options.winds.split(";") if options.winds else [*records, *SYNTHETIC]
    intervals = [int(word) for word in options.intervals.split(",")] if options.intervals else INTERVALS_S
    programs = [(name, path) for name, path in (("before", options.before), ("now", options.yuragi)) if path]
    knows_value = {path: b"--value" in subprocess.run([path, "wind", "--help"], check=True, capture_output=True).stdout for _, path in programs}

    keys = [(name, path, sampling, interval_s, wind) for wind in winds for sampling in SAMPLINGS for interval_s in intervals
            for name, path in programs]
    print("| | station | wind | " + " | ".join(COLUMNS) + " | within the bounds |")
    print("| --- " * (len(COLUMNS) + 4) + "|")
    with multiprocessing.Pool(os.cpu_count()) as pool:
        for name, path, sampling, interval_s, wind in keys:
            seeds = range(1, options.seeds + 1)
            cases = [Case(path, knows_value[path], wind, seed, sampling, interval_s, records.get(wind)) for seed in seeds]
            print(row(name, sampling, interval_s, wind, pool.map(figures, cases, chunksize=1)), flush=True)


if __name__ == "__main__":
    main()
