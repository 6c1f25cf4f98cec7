#!/usr/bin/env python3
"""How flag, tree and grass answer the wind, measured again by an outsider: from the stream of a running daemon, in numpy.

usage: answer_stream_test.py YURAGI YURAGI_ANSWER FOLDER_OF_SCHEMA_MODULES [--beaufort N] [--duration S]

yuragi-answer writes the wind of its record as a table, which the daemon plays in real time (yuragi import, yuragi replay) while
this program reads its frames. The figures are computed by their definitions, with none of the code of tests/answer, and compared
with those that yuragi-answer comes to in the same wind. They are not the same to the last digit: the daemon hears the wind ten
times a second and fills in what is quicker, gusts reach it at the edge of the scenes, and its models and noises begin elsewhere.
TOLERANCE says how near they are to be.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

import pose_client
from programs import Program

RATE_HZ = 60.0
START_S = 30.0
SEGMENT = 1200  # samples of a spectrum's segment: 20 s

# Of a figure, as a part of it, and what may be added to that.
TOLERANCE = {
    "flag": {
        "lift, mean": (0.08, 0.0),
        "lift, sd": (0.35, 0.0),
        "tip across, sd / L": (0.3, 0.0),
        "growth: L/4": (0.25, 0.0),
        "growth: L/2": (0.2, 0.0),
        "tip across > 0.3 Hz, centroid": (0.2, 0.0),
        "phase speed / U": (0.2, 0.0),
        "correlation at that lag": (0.0, 0.1),
        "free corner, speed": (0.3, 0.0),
    },
    "tree": {
        "limb, mean": (0.2, 0.0),
        "limb, sd": (0.35, 0.0),
        "limb > 0.5 Hz, sd": (0.35, 0.0),
        "twig, mean": (0.2, 0.0),
        "twig, sd": (0.35, 0.0),
        "leaf, sd": (0.25, 0.0),
        "leaf > 0.5 Hz, centroid": (0.2, 0.0),
    },
    "grass": {
        "bend along, mean": (0.15, 0.0),
        "bend along, sd": (0.3, 0.0),
        "differences at one moment": (0.3, 0.0),
        "phase speed / U": (0.2, 0.0),
    },
}

SCENES = """
[[scene]]
kind = "flag"
name = "flag"
columns = 48
rows = 76

[[scene]]
kind = "tree"
name = "tree"
leaves = 1600
branch_links = 32

[[scene]]
kind = "grass"
name = "grass"
blades_across = 50
blades_deep = 50
"""


# ---- Figures of series: time runs along the first axis ----


def spectrum(series):
    """Welch's: the variance in each line, and the lines' frequencies."""
    window = np.hanning(SEGMENT + 1)[:-1].reshape((-1,) + (1,) * (series.ndim - 1))
    parts = []
    for begin in range(0, len(series) - SEGMENT + 1, SEGMENT // 2):
        part = series[begin : begin + SEGMENT]
        parts.append(np.abs(np.fft.rfft((part - part.mean(axis=0)) * window, axis=0)) ** 2)
    power = np.mean(parts, axis=0) / (SEGMENT * np.sum(window**2))
    power[1:-1] *= 2.0
    return power, np.fft.rfftfreq(SEGMENT, 1.0 / RATE_HZ)


def deviation_above(series, from_hz):
    power, frequency_hz = spectrum(series)
    return np.sqrt(np.sum(power[frequency_hz >= from_hz - 1e-9], axis=0))


def centroid_hz(power, frequency_hz, from_hz):
    band = frequency_hz >= from_hz - 1e-9
    return np.tensordot(frequency_hz[band], power[band], axes=(0, 0)) / np.sum(power[band], axis=0)


def quick(series, from_hz):
    """What is at a frequency or above it."""
    lines = np.fft.rfft(series, axis=0)
    lines[np.fft.rfftfreq(len(series), 1.0 / RATE_HZ) < from_hz - 1e-9] = 0.0
    return np.fft.irfft(lines, len(series), axis=0)


def correlations(first, second, most_s):
    """Of `first` with `second` as much later as `lags_s` says; series without mean."""
    most = round(most_s * RATE_HZ)
    lags = np.arange(-most, most + 1)
    found = []
    for lag in lags:
        a, b = (first[: len(first) - lag], second[lag:]) if lag >= 0 else (first[-lag:], second[:lag])
        found.append(np.sum(a * b, axis=0) / np.sqrt(np.sum(a * a, axis=0) * np.sum(b * b, axis=0)))
    return lags / RATE_HZ, np.array(found)


def best_lag(lags_s, correlation):
    """Where it is largest, by a parabola, and how large."""
    top = int(np.clip(np.argmax(correlation), 1, len(correlation) - 2))
    before, at, after = correlation[top - 1 : top + 2]
    shift = 0.5 * (before - after) / (before - 2.0 * at + after)
    return lags_s[top] + shift / RATE_HZ, at - 0.25 * (before - after) * shift


def unit(vector):
    return vector / np.linalg.norm(vector)


# ---- Figures of scenes. Horizontal vectors are (east, south) ----


def flag_figures(joints_m, wind_m_s):
    """joints_m: (time, row, column, 3)."""
    rows = joints_m.shape[1]
    way_m = joints_m - joints_m[:, :1]
    length_m = np.mean(np.sum(np.linalg.norm(np.diff(joints_m[0], axis=0), axis=-1), axis=0))
    row = {part: round(part * (rows - 1)) for part in (0.25, 0.5, 0.9)}
    middle = way_m[:, -1, joints_m.shape[2] // 2]
    lift_deg = np.degrees(np.arctan2(np.hypot(middle[:, 0], middle[:, 2]), -middle[:, 1]))
    tips, quarters, halves, centroids, speeds, alike = [], [], [], [], [], []
    for column in range(joints_m.shape[2]):
        chord = unit(np.mean(way_m[:, -1, column][:, [0, 2]], axis=0))
        across_m = way_m[:, :, column][..., [0, 2]] @ np.array([-chord[1], chord[0]])
        tip, quarter, half = (deviation_above(across_m[:, at], 0.3) for at in (-1, row[0.25], row[0.5]))
        tips.append(tip)
        quarters.append(quarter / tip)
        halves.append(half / tip)
        centroids.append(centroid_hz(*spectrum(across_m[:, -1]), 0.3))
        slopes = [quick(across_m[:, row[part] + 1] - across_m[:, row[part]], 0.3) for part in (0.5, 0.9)]
        lag_s, correlation = best_lag(*correlations(*slopes, 1.5))
        speeds.append(0.4 * length_m / lag_s if lag_s > 0 else np.inf)
        alike.append(correlation)
    corners = joints_m[:, -1, [0, -1]]
    corner_m_s = RATE_HZ * np.sqrt(np.mean(np.sum(np.diff(corners, axis=0) ** 2, axis=-1)))
    return {
        "lift, mean": np.mean(lift_deg),
        "lift, sd": np.std(lift_deg),
        "tip across, sd / L": np.median(tips) / length_m,
        "growth: L/4": np.median(quarters),
        "growth: L/2": np.median(halves),
        "tip across > 0.3 Hz, centroid": np.median(centroids),
        "phase speed / U": np.median(speeds) / np.mean(np.hypot(*wind_m_s.T)),
        "correlation at that lag": np.median(alike),
        "free corner, speed": corner_m_s,
    }


def tree_figures(limb_deg, twig_deg, leaf_deg, wind_m_s):
    """Bends: (time, strand, 2)."""
    downwind = unit(np.mean(wind_m_s, axis=0))
    limb, twig = limb_deg @ downwind, twig_deg @ downwind
    power, frequency_hz = spectrum(leaf_deg)
    return {
        "limb, mean": np.median(np.mean(limb, axis=0)),
        "limb, sd": np.median(np.std(limb, axis=0)),
        "limb > 0.5 Hz, sd": np.median(deviation_above(limb, 0.5)),
        "twig, mean": np.median(np.mean(twig, axis=0)),
        "twig, sd": np.median(np.std(twig, axis=0)),
        "leaf, sd": np.median(np.sqrt(np.sum(np.var(leaf_deg, axis=0), axis=-1))),
        "leaf > 0.5 Hz, centroid": np.median(centroid_hz(np.sum(power, axis=-1), frequency_hz, 0.5)),
    }


def grass_figures(bend_deg, root_m, wind_m_s):
    """Bends: (time, blade, 2); roots: (blade, 2)."""
    downwind = unit(np.mean(wind_m_s, axis=0))
    speed_m_s = np.mean(np.hypot(*wind_m_s.T))
    along = bend_deg @ downwind
    off = along - along.mean(axis=0)
    fast = quick(along, 0.5)
    place_m = np.stack([root_m @ downwind, root_m @ np.array([-downwind[1], downwind[0]])], axis=1)
    speeds = []
    for distance_m in (1.0, 2.0, 3.0):
        apart_m = place_m[None] - place_m[:, None]
        first, second = np.nonzero((np.abs(apart_m[..., 0] - distance_m) < 0.1) & (np.abs(apart_m[..., 1]) < 0.1))
        some = np.linspace(0, len(first) - 1, min(len(first), 24)).astype(int)
        first, second = first[some], second[some]
        lags_s, found = correlations(fast[:, first], fast[:, second], distance_m / (0.25 * speed_m_s))
        lag_s, _ = best_lag(lags_s, np.mean(found, axis=1))
        speeds.append(np.mean(apart_m[first, second, 0]) / lag_s if lag_s > 0 else np.inf)
    return {
        "bend along, mean": np.median(np.mean(along, axis=0)),
        "bend along, sd": np.median(np.std(along, axis=0)),
        "differences at one moment": np.sqrt(np.mean(np.var(off, axis=1))),
        "phase speed / U": np.median(speeds) / speed_m_s,
    }


# ---- The daemon and its stream ----


def some(count, most):
    return np.linspace(0, count - 1, min(count, most)).astype(int)


class Recorder:
    """What is kept of each frame."""

    def __init__(self, scenes):
        self.models = {name: model for name, _, model in scenes}
        self.order = [name for name, _, _ in scenes]
        flag = self.models["flag"]
        self.columns = some(flag.columns, 9)
        self.strands = [some(level.strands.count, most) for level, most in zip(self.models["tree"].levels, (1, 15, 60, 100))]
        # At random, so that some pairs stand in line with any wind.
        self.blades = np.random.default_rng(1).permutation(self.models["grass"].count)[:600]
        self.time_s, self.wind, self.flag, self.tree, self.grass = [], [], [], [[], [], [], []], []

    def take(self, frame):
        poses = {name: pose_client.read_pose(frame.Scenes(i)) for i, name in enumerate(self.order)}
        flag = self.models["flag"]
        points_m = flag.joints_m(poses["flag"]).reshape(flag.rows, flag.columns, 3)
        self.time_s.append(frame.TimeS())
        self.wind.append((frame.Wind().UMS(), -frame.Wind().VMS()))
        self.flag.append(points_m[:, self.columns].astype(np.float32))
        for kept, bends, strands in zip(self.tree, poses["tree"].levels, self.strands):
            kept.append(bends_deg(bends, strands))
        self.grass.append(bends_deg(poses["grass"], self.blades))

    def evenly(self, series):
        """At the ticks of the rate, those that were missed filled in linearly."""
        series = np.asarray(series, dtype=float)
        time_s = np.asarray(self.time_s)
        at_s = np.arange(time_s[0], time_s[-1], 1.0 / RATE_HZ)
        after = np.clip(np.searchsorted(time_s, at_s), 1, len(time_s) - 1)
        part = (at_s - time_s[after - 1]) / (time_s[after] - time_s[after - 1])
        part = part.reshape((-1,) + (1,) * (series.ndim - 1))
        return (1.0 - part) * series[after - 1] + part * series[after]

    def figures(self):
        wind = self.evenly(self.wind)
        _, limbs, twigs, leaves = (self.evenly(level) for level in self.tree)
        roots = self.models["grass"].root_m[self.blades][:, [0, 2]]
        return {
            "flag": flag_figures(self.evenly(self.flag), wind),
            "tree": tree_figures(limbs, twigs, leaves, wind),
            "grass": grass_figures(self.evenly(self.grass), roots, wind),
        }


def bends_deg(bends, strands):
    return np.degrees(np.stack([bends.east_rad[strands], bends.south_rad[strands]], axis=1)).astype(np.float32)


def record(address, duration_s):
    source = pose_client.SocketBytes(address, 20.0)
    with source.socket:
        source.send(pose_client.subscribe_message(client="answer_stream_test.py"))
        recorder, first_s = None, None
        for message, _ in pose_client.messages(source):
            kind, table = pose_client.body_of(message)
            if kind == "Scenes":
                recorder = Recorder(pose_client.read_scenes(table))
            if kind != "Frame":
                continue
            first_s = table.TimeS() if first_s is None else first_s
            if table.TimeS() - first_s >= START_S + duration_s:
                return recorder
            if table.TimeS() - first_s >= START_S:
                recorder.take(table)
    raise EOFError("the stream ended before the record was whole")


def measured_by_yuragi_answer(program, beaufort, duration_s):
    command = [program, "--beaufort", str(beaufort), "--duration", str(duration_s), "--json"]
    for scene in TOLERANCE:
        command += ["--scene", scene]
    found = subprocess.run(command, capture_output=True, text=True, check=False)  # it may judge as it likes
    return {scene["scene"]: scene["measured"][str(beaufort)] for scene in json.loads(found.stdout)}


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("yuragi")
    options.add_argument("yuragi_answer")
    options.add_argument("schema")
    options.add_argument("--beaufort", type=int, default=3, choices=(1, 3, 5, 7))
    options.add_argument("--duration", type=float, default=90.0, help="of the record, s (90); it is made in real time")
    options = options.parse_args()
    pose_client.load_schema(os.path.abspath(options.schema))

    with tempfile.TemporaryDirectory() as folder:
        table, log, config = (os.path.join(folder, name) for name in ("wind.csv", "wind.windlog", "scenes.toml"))
        # Longer than the record: the daemon ends with it.
        subprocess.run([options.yuragi_answer, "--beaufort", str(options.beaufort), "--write-wind", table,
                        "--duration", str(options.duration + 60.0)], check=True)
        subprocess.run([options.yuragi, "import", table, "-o", log, "--u", "u_m_s", "--v", "v_m_s"], check=True,
                       capture_output=True)
        with open(config, "w", encoding="ascii") as file:
            file.write(SCENES)
        with Program(options.yuragi, "replay", log, "--config", config, "--listen", "127.0.0.1:0") as daemon:
            recorder = record(daemon.address(), options.duration)
    found = recorder.figures()
    expected = measured_by_yuragi_answer(options.yuragi_answer, options.beaufort, options.duration)

    wind = np.hypot(*np.asarray(recorder.wind).T)
    print(f"Beaufort {options.beaufort}, {len(wind)} frames, mean wind {wind.mean():.2f} m/s, "
          f"deviation of its speed {wind.std() / wind.mean():.3f}")
    failed = 0
    for scene, tolerances in TOLERANCE.items():
        for figure, (part, more) in tolerances.items():
            value, reference = found[scene][figure], expected[scene][figure]
            allowed = part * abs(reference) + more
            is_near = abs(value - reference) <= allowed
            failed += not is_near
            print(f"{scene:6} {figure:32} stream {value:8.3f}   yuragi-answer {reference:8.3f} +- {allowed:.3f}   "
                  f"{'ok' if is_near else 'DIFFERS'}")
    print("the figures agree" if failed == 0 else f"{failed} figures differ")
    return 0 if failed == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
