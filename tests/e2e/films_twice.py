#!/usr/bin/env python3
"""Films of each kind of scene, made twice: the same bit for bit, and a table of their hashes. By hand: it takes many minutes.

usage: films_twice.py DIRECTORY-OF-THE-PROGRAMS [--seconds 20] [--size 320x180] [--fps 25] [--quality low] [--kinds KIND...]

Of a recording that is made here, or of --recording FILE.windlog. Without a display. The exit code is 1 where two films differ.
"""
import argparse
import hashlib
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time


def kinds_of(yuragi):
    text = subprocess.run([yuragi, "describe"], check=True, capture_output=True, text=True).stdout
    return list(dict.fromkeys(re.findall(r'^\[\[scene\]\] .*kind = "(\w+)"', text, re.MULTILINE)))


def make_recording(yuragi, folder, seconds):
    """Gusts from a turning direction, ten readings a second."""
    rows = ["time,speed,direction"]
    for reading in range(10 * seconds):
        at_s = reading / 10
        speed_m_s = 6 + 2.5 * math.sin(0.61 * at_s) + 1.5 * math.sin(1.7 * at_s + 1) + 0.8 * math.sin(4.3 * at_s + 2)
        rows.append(f"2026-05-01T12:{int(at_s) // 60:02}:{at_s % 60:06.3f}Z,{speed_m_s:.3f},{240 + 25 * math.sin(0.23 * at_s):.1f}")
    table, recording = folder / "wind.csv", folder / "wind.windlog"
    table.write_text("\n".join(rows) + "\n")
    subprocess.run([yuragi, "import", table, "-o", recording], check=True, capture_output=True)
    return recording


def hash_of_film(command, environment, picture_bytes):
    """The hash of its pictures, how many there are, and how many differ from the one before."""
    digest, count, changes, last = hashlib.sha256(), 0, 0, b""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment) as film:
        while picture := film.stdout.read(picture_bytes):
            digest.update(picture)
            count += 1
            changes += picture != last
            last = picture
        said = film.stderr.read().decode()
    if film.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{said}")
    return digest.hexdigest(), count, changes


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("programs", type=pathlib.Path)
    options.add_argument("--kinds", nargs="+", metavar="KIND")
    options.add_argument("--seconds", type=int, default=20)
    options.add_argument("--size", default="320x180")
    options.add_argument("--fps", type=int, default=25)
    options.add_argument("--quality", default="low")
    options.add_argument("--recording", type=pathlib.Path)
    asked = options.parse_args()
    yuragi = asked.programs / "yuragi"
    width, height = map(int, asked.size.split("x"))
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    are_all_same = True
    with tempfile.TemporaryDirectory() as kept:
        folder = pathlib.Path(kept)
        recording = asked.recording or make_recording(yuragi, folder, asked.seconds + 5)
        print("| kind | pictures | that differ from the one before | time of both, s | the same twice | SHA-256 |", flush=True)
        print("|---|---|---|---|---|---|", flush=True)
        for kind in asked.kinds or kinds_of(yuragi):
            config = folder / f"{kind}.toml"
            config.write_text(f'[look]\nquality = "{asked.quality}"\n[[scene]]\nkind = "{kind}"\nname = "{kind}"\n')
            command = [asked.programs / "yuragi-viewer", "--render", recording, "--config", config, "--size", asked.size, "--fps",
                       str(asked.fps), "--duration", str(asked.seconds), "--samples", "1", "--out", "-"]
            begun_s = time.monotonic()
            first, second = (hash_of_film(command, environment, 3 * width * height) for _ in range(2))
            is_same = first == second and first[1] == asked.seconds * asked.fps
            are_all_same = are_all_same and is_same
            print(f"| {kind} | {first[1]} | {first[2]} | {time.monotonic() - begun_s:.0f} | {'yes' if is_same else 'NO'} | `{first[0][:16]}` |",
                  flush=True)
    return 0 if are_all_same else 1


if __name__ == "__main__":
    sys.exit(main())
