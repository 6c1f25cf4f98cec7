#!/usr/bin/env python3
"""Do the gusts that a sensor measured travel over the ground? `yuragi wind --place` over real recordings, checked with
numpy alone.

usage: ground_wind_test.py YURAGI [--seeds N] [--table] [--records FOLDER]

Two half hours of a sonic anemometer (13:30: 4 m/s, the wind turns round half-way; 14:00: 7 m/s, steady) are heard as
sensors of 0.1, 1 and 14 s would have told them. Meadows of 7 and 60 m: their middle and corners, and lines along and
across the wind. Each figure and its bound is a row; --table prints them as Markdown. The recordings stand in
../shared/data/sonic beside the project; without them the test is skipped (77).
"""
import argparse
import multiprocessing
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import ground_wind_analysis as gw

RECORDS = ("20180720T133000", "20180720T140000")
GUSTY, STEADY = RECORDS
INTERVALS_S = (0.1, 1, 14)
MEADOWS_M = (7, 60)
BEGIN_S = 60  # before that the scenes have not yet had the wind that was measured
MOST_TURN_DEG = 40  # of a window of which the way of gusts is asked
PAIRS_M = {7: (2, 4, 6.5), 60: (7, 20, 60)}
ACROSS_M = {7: (1, 3, 7), 60: (1, 3, 7, 20)}
BEHIND_M, BESIDE_M, BEFORE_M = (2, 4, 7, 20, 60), (1, 3, 7), (2, 7, 20)
OCTAVES_HZ = (0.05, 0.1, 0.2, 0.4, 0.8)
LENGTH_M = 57.0
SILENCES_S = tuple((begin, begin + 100) for begin in (320, 1250, 1600))  # while neither record turns
SILENCE_INTERVAL_S = 1
TOLD_INTERVAL_S = 0.1  # of the sensor whose coherence with other places is compared with the law
BOUND_SEEDS = 5
SILENCE_SEEDS = 3  # for each of the others: what noise does in 100 s scatters
SILENCES_OF_ONE_SEED = ((GUSTY, 7), (STEADY, 60))  # each record and each meadow once; with more seeds all four

# The figures are those of gusts as the climate has them, and of no site.
CONFIG = f"""[wind]
default_length = {LENGTH_M}
gustiness = 0.0
[[sensor]]
driver = "synthetic"
"""
# A wind that never changes: no sensor would be believed, and the climate is not to put gusts in.
CONFIG_OF_STILLNESS = CONFIG.replace("[[", "default_turbulence = 0.0\n[[") + "[sensor.judge]\nenabled = false\n"
LEAST_CHANGE_M_S = 0.01  # what the fit takes for turbulence where there is none


class Bench:
    """The program, the recordings as it reads them, and where it works."""

    def __init__(self, yuragi, folder, records):
        self.yuragi, self.folder = yuragi, pathlib.Path(folder)
        self.record = {}
        for name, table in records.items():
            self.import_table(name, table)
            self.record[name] = np.loadtxt(table, delimiter=",", skiprows=2, usecols=(1, 2))
        self.windows = {name: gw.windows_of(record, BEGIN_S) for name, record in self.record.items()}
        for name, text in (("wall", CONFIG), ("still", CONFIG_OF_STILLNESS)):
            (self.folder / f"{name}.toml").write_text(text, encoding="ascii")

    def log(self, name):
        return self.folder / f"{name}.windlog"

    def import_table(self, name, table):
        subprocess.run([self.yuragi, "import", table, "-o", self.log(name)], check=True, capture_output=True)

    def steady_windows(self, name):
        return [window for window in self.windows[name] if window.turn_deg < MOST_TURN_DEG]

    def wind(self, name, places, *options, config="wall"):
        """Of the sensor, and of the places: (time, 2) and (place, time, 2)."""
        command = [self.yuragi, "wind", self.log(name), "--config", self.folder / f"{config}.toml", "--rate",
                   gw.RATE_HZ, "-o", "-", *options]
        command += [f"--place={east},{south}" for east, south in places]
        text = subprocess.run(list(map(str, command)), check=True, capture_output=True).stdout
        return parsed(text, len(places))


def parsed(text, places):
    """A table of `yuragi wind` with so many places."""
    rows = text[text.index(b"\n", text.index(b"time_s")) + 1 :]
    for word in (b"default", b"handover", b"live"):
        rows = rows.replace(word, b"0")
    table = np.fromstring(rows.replace(b"\n", b","), sep=",").reshape(-1, 7 + 2 * places)
    return table[:, 1:3], np.moveaxis(table[:, 7:].reshape(len(table), places, 2), 0, 1)


class Places:
    """Places on the ground, each once."""

    def __init__(self):
        self.numbers = {}

    def add(self, place):
        return self.numbers.setdefault(place, len(self.numbers))

    def __iter__(self):
        return iter(self.numbers)

    def __len__(self):
        return len(self.numbers)


def meadow_places(size):
    half = size / 2
    return [(0.0, 0.0)] + [(east, south) for east in (-half, half) for south in (-half, half)]


def reach_of(size):
    return size / np.sqrt(2)


def meadow_figures(bench, name, interval, size, seed):
    """What a run over a meadow shows, sensor at its windward edge."""
    steady = bench.steady_windows(name)
    places = Places()
    ground = [places.add(place) for place in meadow_places(size)]
    pairs = {(i, d): [places.add(w.place(along)) for along in (-d / 2, d / 2)]
             for i, w in enumerate(steady) for d in PAIRS_M[size]}
    across = {(i, d): [places.add(w.place(0.0, left)) for left in (-d / 2, d / 2)]
              for i, w in enumerate(steady) for d in ACROSS_M[size] if name == STEADY and interval == 0.1}
    spans = [[places.add(w.place(along)) for along in gw.span_offsets()] for w in steady if size > gw.SPAN_M]
    sensor, winds = bench.wind(name, places, "--sensor-interval", interval, "--scene-size", size, "--seed", seed)
    used = slice(BEGIN_S * gw.RATE_HZ, len(bench.record[name]))

    def high_passed(number, window):
        return gw.high_passed(winds[number] @ window.ahead)

    figures = {
        "variance": np.array([gw.variance(wind[used]) for wind in (sensor, *winds[ground])]),
        "octaves": np.array([gw.octave_power(wind[used]) for wind in (sensor, *winds[ground])]),
        "speed": np.array([np.mean(np.hypot(*wind[used].T)) for wind in winds[ground]]),
    }
    for (i, d), (first, second) in pairs.items():
        window = steady[i]
        figures["pair", i, d] = gw.correlations(high_passed(first, window), high_passed(second, window), window,
                                                gw.most_lag_of(d, window))
    for (i, d), (first, second) in across.items():
        window = steady[i]
        figures["across", i, d] = gw.correlations(high_passed(first, window), high_passed(second, window), window, 0)
    for i, numbers in enumerate(spans):
        window = steady[i]
        figures["span", i] = gw.span_variance((winds[numbers] @ window.ahead)[:, window.begin : window.end])
    if interval == SILENCE_INTERVAL_S:
        figures["at silences"] = silence_variances(bench, name, size, sensor, winds[ground])
    return figures


def told_figures(bench, interval, seed):
    """A sensor in the middle that is told to stand there: places before, behind and beside it."""
    whole = gw.Window(0, 0, *direction_of(bench.record[STEADY]), 0.0)
    windows = bench.windows[STEADY]
    places = Places()
    before = [places.add(whole.place(-d)) for d in BEFORE_M]
    others = [(*lag_and_law, places.add(window.place(*at)), window)
              for window in windows for *lag_and_law, at in told_places() if interval == TOLD_INTERVAL_S]
    sensor, winds = bench.wind(STEADY, places, "--sensor-interval", interval, "--sensor-place=0,0", "--seed", seed)
    used = slice(BEGIN_S * gw.RATE_HZ, len(bench.record[STEADY]))
    figures = {
        "variance": np.array([gw.variance(wind[used]) for wind in (sensor, *winds[before])]),
        "octaves": np.array([gw.octave_power(wind[used]) for wind in (sensor, *winds[before])]),
    }
    for label, behind_m, number, window in others:
        spectra = gw.cross_spectra(sensor @ window.ahead, winds[number] @ window.ahead, window,
                                   behind_m / window.speed_m_s)
        figures["coherence", label] = figures.get(("coherence", label), 0) + spectra
    return figures


def told_places():
    """Name, metres behind, and (along, across)."""
    yield from ((f"{d} m behind", d, (d, 0.0)) for d in BEHIND_M)
    yield from ((f"{d} m beside", 0.0, (0.0, d)) for d in BESIDE_M)


def silence_figures(bench, name, size, seed, more):
    """Variance in silences of 100 s and of the same times without: of the sensor's wind and of the meadow's."""
    places = meadow_places(size)
    gaps = [word for begin, end in SILENCES_S for word in ("--gap", f"{begin},{end}")]
    options = ("--sensor-interval", SILENCE_INTERVAL_S, "--scene-size", size, "--seed", seed + 1000 * more)
    figures = {"silent": silence_variances(bench, name, size, *bench.wind(name, places, *options, *gaps))}
    if more > 0:  # else it is the run of meadow_figures()
        figures["usual"] = silence_variances(bench, name, size, *bench.wind(name, places, *options))
    return figures


def silence_variances(bench, name, size, sensor, winds):
    """The variance of the sensor's wind and of a meadow's at the times of the silences, added up."""
    places = meadow_places(size)
    totals = np.zeros(1 + len(places))
    for begin, end in SILENCES_S:
        mean = np.mean(bench.record[name][(begin - 100) * gw.RATE_HZ : begin * gw.RATE_HZ], axis=0)
        speed = np.hypot(*mean)
        for i, wind in enumerate((sensor, *winds)):
            way = 0.0 if i == 0 else reach_of(size) + np.dot(places[i - 1], mean * (1, -1)) / speed
            delay = round(way / speed * gw.RATE_HZ)
            totals[i] += gw.variance(wind[begin * gw.RATE_HZ + delay : end * gw.RATE_HZ + delay])
    return totals


def direction_of(wind):
    mean = np.mean(wind, axis=0)
    speed = float(np.hypot(*mean))
    return mean / speed, speed


class Report:
    """Rows of what was found, and whether it is within its bound. Bounds are of the mean of BOUND_SEEDS seeds; the mean of fewer
    scatters further, by the root of their number."""

    def __init__(self, seeds):
        self.rows = []
        self.scatter = max(1.0, np.sqrt(BOUND_SEEDS / seeds))

    def add(self, what, values, least, most, show="{:.3f}"):
        if np.isfinite(least) and np.isfinite(most):
            middle, half = (least + most) / 2, self.scatter * (most - least) / 2
            least, most = middle - half, middle + half
        self.add_exact(what, values, least, most, show)

    def add_exact(self, what, values, least, most, show="{:.3f}"):
        """The same for what does not depend on seeds."""
        low, high = float(np.min(values)), float(np.max(values))
        holds = bool(np.all(np.isfinite(values)) and least <= low and high <= most)
        found = show.format(low) + ("" if low == high else " to " + show.format(high))
        bound = " to ".join(show.format(edge) for edge in (least, most) if np.isfinite(edge))
        bound = bound if np.isfinite(least) and np.isfinite(most) else ("at most " if np.isfinite(most) else "at least ") + bound
        self.rows.append((what, found, bound, holds))

    def holds(self):
        return all(row[-1] for row in self.rows)

    def print(self, as_table):
        if as_table:
            print("| what | found | bound | holds |\n| --- | --- | --- | --- |")
        for what, found, bound, holds in self.rows:
            verdict = "yes" if holds else "NO"
            print(f"| {what} | {found} | {bound} | {verdict} |" if as_table
                  else f"{what}: {found} ({bound}){'' if holds else '  DOES NOT HOLD'}")


def report_meadows(report, bench, found):
    """`found`: the seeds' mean of meadow_figures() for each (record, interval, meadow)."""
    short = {name: name[-6:-2] for name in RECORDS}
    for size, least, most in ((7, 0.93, 1.07), (60, 0.88, 1.10)):
        ratios = [figures["variance"][1:] / figures["variance"][0] for (_, _, at), figures in found.items() if at == size]
        report.add(f"variance over that at the sensor, {size} m", ratios, least, most)
    for name, size, most in ((STEADY, 7, 1.6), (STEADY, 60, 3.5), (GUSTY, 7, 3.3), (GUSTY, 60, 4.0)):
        decibels = [10 * np.log10(found[name, t, size]["octaves"][1:] / found[name, t, size]["octaves"][0]) for t in INTERVALS_S]
        report.add(f"octaves against the sensor's, {short[name]}, {size} m, dB", decibels, -most, most, "{:+.2f}")
    for name, most in ((STEADY, 0.02), (GUSTY, 0.08)):
        record = np.mean(np.hypot(*bench.record[name][BEGIN_S * gw.RATE_HZ :].T))
        ratios = [figures["speed"] / record for (at, _, _), figures in found.items() if at == name]
        report.add(f"mean speed over the record's, {short[name]}", ratios, 1 - most, 1 + most)

    steady = {name: bench.steady_windows(name) for name in RECORDS}
    for name, least, most in ((STEADY, 0.95, 1.06), (GUSTY, 0.80, 1.10)):
        for size in MEADOWS_M:
            for d in PAIRS_M[size]:
                travel = [np.mean([gw.peak(found[name, t, size]["pair", i, d], d / window.speed_m_s)[0] * window.speed_m_s / d
                                   for i, window in enumerate(steady[name])]) for t in INTERVALS_S]
                report.add(f"travel over {d} m at the speed of the wind, {short[name]}, {size} m", travel, least, most)
    for d, size, least in ((6.5, 7, 0.88), (20, 60, 0.8), (60, 60, 0.55)):
        height = np.mean([gw.peak(found[STEADY, 0.1, size]["pair", i, d])[1] for i in range(len(steady[STEADY]))])
        report.add(f"largest correlation over {d} m, 0.1 s", height, least, np.inf)
    for intervals, most in (((0.1, 1), 0.13), ((14,), 0.25)):
        differences = []
        for name in RECORDS:
            for d, size in ((2, 7), (4, 7), (6.5, 7), (7, 60), (20, 60)):
                own = np.mean([gw.own_correlation(gw.high_passed(bench.record[name] @ window.ahead), window,
                                                  d / window.speed_m_s) for window in steady[name]])
                for t in intervals:
                    at_once = [found[name, t, size]["pair", i, d] for i in range(len(steady[name]))]
                    differences.append(np.mean([both[len(both) // 2] for both in at_once]) - own)
        report.add(f"correlation at lag 0 less the record's own, {' and '.join(map(str, intervals))} s", differences, -most, most)
    for d, most in ((1, 0.97), (3, 0.85), (7, 0.70), (20, 0.45)):
        values = [np.mean([found[STEADY, 0.1, size]["across", i, d] for i in range(len(steady[STEADY]))])
                  for size in MEADOWS_M if d in ACROSS_M[size]]
        report.add(f"correlation {d} m across, 0.1 s", values, -np.inf, most)
    for t, least, most in ((0.1, 0.9, 1.12), (1, 0.85, 1.12), (14, 0.65, 1.15)):
        ratios = []
        for name in RECORDS:
            over = [found[name, t, 60]["span", i] for i in range(len(steady[name]))]
            passing = [gw.passing_variance(bench.record[name] @ window.ahead, window) for window in steady[name]]
            ratios.append(np.sqrt(np.mean(over) / np.mean(passing)))
        report.add(f"sigma over 50 m at a moment over the record's, {t:g} s", ratios, least, most)


def report_told(report, bench, found):
    """`found`: the seeds' mean of told_figures() for each interval."""
    report.add("told place: variance 2, 7, 20 m before it",
               [figures["variance"][1:] / figures["variance"][0] for figures in found.values()], 0.9, 1.1)
    report.add("told place: octaves 2, 7, 20 m before it, dB",
               [10 * np.log10(figures["octaves"][1:] / figures["octaves"][0]) for figures in found.values()], -2.0, 2.0, "{:+.2f}")
    record = bench.record[STEADY]
    ahead, speed = direction_of(record)
    intensity = np.std(record @ ahead) / speed
    along = np.clip(0.025 + 5.7 * intensity, 0.5, 10.0)
    strong, weak = [], []
    for label, behind_m, (_, beside_m) in told_places():
        for frequency in OCTAVES_HZ:
            wave = np.hypot(2 * np.pi * frequency / speed, 1 / (1.339 * LENGTH_M))
            law = np.exp(-(along * behind_m + 12.0 * beside_m) / (2 * np.pi) * wave)
            more = gw.root_coherence(found[TOLD_INTERVAL_S]["coherence", label], frequency) - law
            (strong if law >= 0.5 else weak).append(more)
    report.add("root coherence less the law, where that is 0.5 or more, 0.1 s", strong, -0.12, 0.27, "{:+.2f}")
    report.add("the same below", weak, -0.12, 0.37, "{:+.2f}")


def report_silence(report, found):
    """`found`: the seeds' mean of silence_figures() for each (record, meadow)."""
    ratios = []
    for figures in found.values():
        left = figures["silent"] / figures["usual"]
        ratios.append(left[1:] / left[0])
    report.add("variance left in a silence of 100 s, over that at the sensor, 1 s", ratios, 0.75, 1.25)


def report_simple_winds(report, bench):
    """A wind that never changes, calm, and two anemometers at one place."""
    places = meadow_places(60)
    for name, speed, text in (("constant", 6.0, "a constant wind: change after 20 minutes, m/s"),
                              ("calm", 0.0, "calm: speed after 20 minutes, m/s")):
        table = bench.folder / f"{name}.csv"
        table.write_text("time_s,speed_m_s,direction_deg\n" + "".join(f"{i},{speed},200\n" for i in range(1800)), encoding="ascii")
        bench.import_table(name, table)
        sensor, winds = bench.wind(name, places, "--scene-size", 60, config="still")
        settled = np.concatenate([sensor[None], winds])[:, 1200 * gw.RATE_HZ :]
        if speed:
            report.add_exact(text, np.ptp(settled, axis=1), 0.0, LEAST_CHANGE_M_S, "{:.2g}")
        else:
            report.add_exact(text, np.abs(settled), 0.0, 0.0, "{:g}")
    alone, there = bench.wind(STEADY, places, "--sensor-interval", 1, "--sensor-place=5,2")
    both, also_there = bench.wind(STEADY, places, "--sensor-interval", 1, "--sensor-place=5,2", "--also", f"{bench.log(STEADY)}@5,2")
    for one, two in ((alone, both), (there[0], also_there[0])):
        report.add_exact("two sensors at one place over one: variance", gw.variance(two) / gw.variance(one), 0.95, 1.05)


def work(job):
    function, key, arguments = job
    return function, key, function(*arguments)


def mean_of(results):
    keys = {key for result in results for key in result}
    return {key: np.mean([result[key] for result in results if key in result], axis=0) for key in keys}


def all_figures(bench, seeds):
    """Runs everything, a process a core; the seeds' means, by function and key."""
    jobs = []
    for seed in range(1, seeds + 1):
        for name in RECORDS:
            for size in reversed(MEADOWS_M):
                jobs += [(meadow_figures, (name, t, size), (bench, name, t, size, seed)) for t in INTERVALS_S]
                if seeds > 1 or (name, size) in SILENCES_OF_ONE_SEED:
                    jobs += [(silence_figures, (name, size), (bench, name, size, seed, more)) for more in range(SILENCE_SEEDS)]
        jobs += [(told_figures, t, (bench, t, seed)) for t in INTERVALS_S]
    found = {}
    with multiprocessing.Pool() as pool:
        for function, key, figures in pool.imap_unordered(work, jobs):
            found.setdefault(function, {}).setdefault(key, []).append(figures)
    for (name, size), results in found[silence_figures].items():
        for figures in found[meadow_figures][name, SILENCE_INTERVAL_S, size]:
            results.append({"usual": figures.pop("at silences")})
    return {function: {key: mean_of(results) for key, results in by_key.items()} for function, by_key in found.items()}


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("yuragi")
    options.add_argument("--seeds", type=int, default=BOUND_SEEDS)
    options.add_argument("--table", action="store_true")
    options.add_argument("--records", type=pathlib.Path,
                         default=pathlib.Path(__file__).resolve().parents[3] / "shared/data/sonic")
    options = options.parse_args()
    tables = {name: options.records / f"finse_csat3_10hz_{name}.csv" for name in RECORDS}
    for table in tables.values():
        if not table.exists():
            print(f"skipped: {table} is not here")
            return 77
    report = Report(options.seeds)
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.yuragi, folder, tables)
        found = all_figures(bench, options.seeds)
        report_meadows(report, bench, found[meadow_figures])
        report_told(report, bench, found[told_figures])
        report_silence(report, found[silence_figures])
        report_simple_winds(report, bench)
    report.print(options.table)
    print("holds" if report.holds() else "does not hold")
    return 0 if report.holds() else 1


if __name__ == "__main__":
    sys.exit(main())
