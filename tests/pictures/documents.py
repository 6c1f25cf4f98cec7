#!/usr/bin/env python3
"""Draws the pictures and the film that documents show, and checks that they show today's drawing.

    tests/pictures/documents.py BIN [PICTURE]...     draws them by the programs in BIN (build/test/bin), without a display
    tests/pictures/documents.py --check [SOURCES]    exit code 1 if a picture is older than the shaders; draws nothing

documents.txt holds for each picture the hash of the shaders that drew it (without comments and white space) and that of the
file. PICTURE is a path as it stands there; without any, all are drawn. Look at them before you commit them.
"""
import argparse
import hashlib
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

SOURCES = pathlib.Path(__file__).resolve().parents[2]
RECORD = "tests/pictures/documents.txt"
COMMAND = "tests/pictures/documents.py build/test/bin"
SHADERS = "viewer/gl/shaders"
GAP_PX = 4

WINDS_M_S = (0.9, 4.4, 9.4, 15.5)  # Beaufort 1, 3, 5 and 7
ANSWERING = (("flag", ""), ("curtain", ""), ("banner", ""), ("tree", 'species = "cherry"'), ("grass", ""), ("fur", ""), ("flame", ""), ("ripple", ""))
ONE = ("--duration", "0.01")  # s: one picture
FROM = ("--from", "20")
WALL = "viewer/wall/pictures"

# What no shader draws: plots of figures. The README that shows one has its command.
PLOTS = ("engine/wind/blend.png", "engine/wind/field.png", "engine/wind/ground.png", "engine/wind/station.png")


class Drawing:
    """The programs, and a folder for what they need."""

    def __init__(self, programs, folder):
        self.programs, self.folder = programs, folder

    def wind(self, speed_m_s):
        recording = self.folder / f"{speed_m_s}.windlog"
        if not recording.exists():
            subprocess.run([self.programs / "yuragi-sim", "recording", "-o", recording, "--speed", str(speed_m_s), "--duration", "60", "--seed", "5"],
                           check=True, stdout=subprocess.DEVNULL)
        return recording

    def scene(self, kind, more=""):
        config = self.folder / f"{kind}.toml"
        config.write_text(f'[[scene]]\nkind = "{kind}"\n{more}\n')
        return config

    def film(self, width_px, height_px, speed_m_s, *words):
        """The pictures of a film: rows of RGB each."""
        command = [self.programs / "yuragi-viewer", "--render", self.wind(speed_m_s), "--size", f"{width_px}x{height_px}", "--look", "quality=high",
                   *FROM, *words, "--out", "-"]
        rgb = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
        line, size = 3 * width_px, 3 * width_px * height_px
        return [[rgb[at + line * y:at + line * (y + 1)] for y in range(height_px)] for at in range(0, len(rgb), size)]


def sheet(pictures, columns):
    """Pictures of one size side by side, on black, row by row."""
    rows, gap = [], bytes(3 * GAP_PX)
    for first in range(0, len(pictures), columns):
        lines = [gap.join(parts) for parts in zip(*pictures[first:first + columns])]
        rows += [bytes(len(lines[0]))] * (GAP_PX if rows else 0) + lines
    return rows


def write_png(file, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    def differences(line):  # from the pixel on the left: PNG's filter 1
        return bytes(value - before & 0xFF for value, before in zip(line, bytes(3) + line))

    head = struct.pack(">IIBBBBB", len(rows[0]) // 3, len(rows), 8, 2, 0, 0, 0)
    data = zlib.compress(b"".join(b"\1" + differences(line) for line in rows), 9)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def draw_meadow(drawing, file):
    write_png(file, drawing.film(1280, 720, 9.4, *ONE)[0])


def draw_garden_film(drawing, file):
    """Six seconds, again and again, by img2webp (Debian's package webp)."""
    frames = drawing.folder / "frames"
    subprocess.run([drawing.programs / "yuragi-viewer", "--render", drawing.wind(9.4), "--size", "640x360", "--look", "quality=high", *FROM,
                    "--config", SOURCES / "config/garden.toml", "--camera", "evening", "--look", "time=17:40", "--fps", "12.5", "--duration", "6",
                    "--out", frames], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    subprocess.run(["img2webp", "-loop", "0", "-mixed", "-q", "50", "-m", "6", "-d", "80", *sorted(frames.glob("*.png")), "-o", file],
                   check=True, stdout=subprocess.DEVNULL)


def draw_gust(drawing, file):
    """A meadow, twelve moments 1/3 s apart: from the side, and from above."""
    moments = ("--config", drawing.scene("grass"), "--fps", "3", "--duration", "4", "--look", "clouds=0", "--camera")
    write_png(file, sheet(drawing.film(230, 150, 9.4, *moments, "330,14,20") + drawing.film(230, 150, 9.4, *moments, "60,89,26"), 4))


def draw_answer(drawing, file):
    """A row for each scene, a column for each wind."""
    write_png(file, sheet([drawing.film(240, 136, wind, "--config", drawing.scene(*scene), *ONE)[0] for scene in ANSWERING for wind in WINDS_M_S], 4))


def draw_wall(drawing, file):
    """On virtual monitors, by draw_outputs (the target of that name)."""
    subprocess.run([drawing.programs.parent / "tests/viewer/draw_outputs", drawing.folder, file.name], check=True, stdout=subprocess.DEVNULL)
    shutil.copyfile(drawing.folder / file.name, file)


PICTURES = {"viewer/meadow.png": draw_meadow, "viewer/garden.webp": draw_garden_film, "engine/wind/gust.png": draw_gust, "tests/answer/answer.png": draw_answer,
            **{f"{WALL}/{name}.jpg": draw_wall for name in ("blend-canvas", "corners", "crop", "gamma", "monitor", "screen", "size")}}


def hash_of_shaders(sources):
    """Of all shaders, without comments and white space."""
    digest = hashlib.sha256()
    for shader in sorted((sources / SHADERS).rglob("*.glsl"), key=lambda shader: shader.name):
        code = re.sub(r"/\*.*?\*/|//[^\n]*", "", shader.read_text(), flags=re.DOTALL)
        digest.update(f"{shader.name}\n{''.join(code.split())}\n".encode())
    return digest.hexdigest()[:16]


def hash_of(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()[:16]


def read_record(sources):
    """Picture: hash of its shaders, hash of its file."""
    file = sources / RECORD
    lines = file.read_text().splitlines() if file.exists() else []
    return {picture: (shaders, of_file) for shaders, of_file, picture in (line.split() for line in lines if not line.startswith("#"))}


def write_record(sources, record):
    lines = [f"{shaders} {of_file} {picture}\n" for picture, (shaders, of_file) in sorted(record.items())]
    (sources / RECORD).write_text("# Hash of the shaders, hash of the file, picture. Written by documents.py.\n" + "".join(lines))


def shown_pictures(sources):
    """Each picture that a document shows, and the document."""
    files = subprocess.run(["git", "-C", sources, "ls-files", "*.md"], check=True, capture_output=True, text=True).stdout.split()
    for document in map(pathlib.PurePosixPath, files):
        for link in re.findall(r"\]\(([^():]+\.(?:png|jpe?g|webp))\)", (sources / document).read_text()):
            yield str(document.parent / link), str(document)


def faults_in(sources):
    """What is wrong, a line each."""
    shaders, record = hash_of_shaders(sources), read_record(sources)
    for picture, document in shown_pictures(sources):
        if picture not in PICTURES and picture not in PLOTS:
            yield f"{document} shows {picture}, which no command draws: add it to tests/pictures/documents.py"
    for picture in PICTURES:
        drawn_by, of_file = record.get(picture, ("", ""))
        if not (sources / picture).exists():
            yield f"{picture} is missing: run {COMMAND} {picture}"
        elif drawn_by != shaders:
            yield f"{picture} was drawn by other shaders than those in {SHADERS}: run {COMMAND} {picture}, look at it and commit it"
        elif of_file != hash_of(sources / picture):
            yield f"{picture} was not drawn by tests/pictures/documents.py: run {COMMAND} {picture}"


def draw(programs, pictures):
    with tempfile.TemporaryDirectory() as folder:
        drawing, shaders = Drawing(programs.resolve(), pathlib.Path(folder)), hash_of_shaders(SOURCES)
        for picture in pictures or PICTURES:
            if picture not in PICTURES:
                sys.exit(f"documents.py: {picture} is no picture that it draws; it draws: {', '.join(PICTURES)}")
            print(picture, flush=True)
            PICTURES[picture](drawing, SOURCES / picture)
            write_record(SOURCES, {**read_record(SOURCES), picture: (shaders, hash_of(SOURCES / picture))})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare with the shaders; the folder is that of the sources")
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=SOURCES, help="of the programs")
    parser.add_argument("pictures", nargs="*", help="which; default: all")
    options = parser.parse_args()
    if not options.check:
        return draw(options.folder, options.pictures)
    faults = list(faults_in(options.folder))
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
