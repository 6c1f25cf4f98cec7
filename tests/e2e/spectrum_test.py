#!/usr/bin/env python3
"""`yuragi spectrum` against the printed formulas, written down here once more.

usage: spectrum_test.py YURAGI
"""
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

YURAGI = sys.argv.pop(1)


def spectrum(*arguments):
    """{f: S} as it is printed."""
    run = subprocess.run([YURAGI, "spectrum", *arguments], check=True, capture_output=True, text=True)
    lines = [line.split() for line in run.stdout.splitlines() if not line.startswith("#")]
    return {float(f): float(s) for f, s in lines}


class Spectrum(unittest.TestCase):
    def test_prints_one_line_a_frequency_in_full_precision(self):
        values = spectrum("--model", "kaimal", "--speed", "8", "--height", "10", "--ustar", "0.5", "--frequency", "0.01,0.1,1")
        self.assertEqual(list(values), [0.01, 0.1, 1.0])
        for f, s in values.items():
            n = f * 10 / 8
            self.assertAlmostEqual(s * f / 0.25 / (105 * n / (1 + 33 * n) ** (5 / 3)), 1, places=14)

    def test_takes_sigma_and_length(self):
        (s,) = spectrum("--model", "von-karman", "--speed", "12", "--height", "40", "--component", "w", "--sigma", "1.5",
                        "--length", "120", "--frequency", "0.2").values()
        x = 0.2 * 60 / 12
        self.assertAlmostEqual(s * 0.2 / 2.25 / (4 * x * (1 + 755.2 * x * x) / (1 + 283.2 * x * x) ** (11 / 6)), 1, places=14)
        (s,) = spectrum("--model", "iec-kaimal", "--speed", "12", "--height", "40", "--component", "v", "--sigma", "1.5",
                        "--frequency", "0.2").values()
        t = 2.7 * 28 / 12
        self.assertAlmostEqual(s / (4 * 2.25 * t / (1 + 6 * 0.2 * t) ** (5 / 3)), 1, places=14)

    def test_scales_a_friction_model_to_the_sigma_of_the_component(self):
        (s,) = spectrum("--model", "simiu", "--speed", "8", "--height", "10", "--component", "v", "--sigma", "2",
                        "--frequency", "0.1").values()
        n = 0.1 * 10 / 8
        self.assertAlmostEqual(s * 0.1 / (4 / (1.5 * 15 / 9.5) * 15 * n / (1 + 9.5 * n) ** (5 / 3)), 1, places=14)

    def test_draws_png_and_svg(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, head in (("a.png", b"\x89PNG"), ("it's.svg", b"<?xml")):
                file = pathlib.Path(folder, name)
                spectrum("--plot", str(file), "--frequency", "0.1")
                self.assertTrue(file.read_bytes().startswith(head))
                self.assertEqual([path.name for path in file.parent.glob(name + "*")], [name])

    def test_says_what_is_wrong(self):
        for arguments, text in (
            (["--model", "davenport", "--component", "w", "--frequency", "1"], "davenport is defined for component u only"),
            (["--speed", "0", "--frequency", "1"], "mean speed must be above 0"),
            (["--model", "kaimal", "--length", "9", "--frequency", "1"], "only von-karman and iec-kaimal"),
            (["--sigma", "1", "--ustar", "1", "--frequency", "1"], "excludes"),
            ([], "--frequency"),
            (["--plot", "a.pdf"], ".png or .svg"),
            (["--plot", "/no/such/folder/a.png"], "the folder does not exist"),
        ):
            run = subprocess.run([YURAGI, "spectrum", *arguments], capture_output=True, text=True)
            self.assertIn(run.returncode, (64, 73), arguments)
            self.assertIn(text, run.stderr)

    def test_of_itself_is_the_help_that_teaches(self):
        run = subprocess.run([YURAGI, "spectrum", "--help"], check=True, capture_output=True, text=True)
        self.assertIn("Example: yuragi spectrum", run.stdout)

    def test_integrates_to_the_variance(self):
        frequencies = [math.exp(k / 20) for k in range(-400, 401)]
        values = spectrum("--model", "davenport", "--speed", "9", "--ustar", "0.4", "--frequency", ",".join(map(str, frequencies)))
        self.assertAlmostEqual(sum(f * s for f, s in values.items()) / 20 / (6 * 0.16), 1, places=3)


if __name__ == "__main__":
    unittest.main()
