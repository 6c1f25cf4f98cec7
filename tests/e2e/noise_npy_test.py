#!/usr/bin/env python3
"""`yuragi noise` as a user meets it: the program is run, and NumPy reads what it wrote.

usage: noise_npy_test.py PATH/TO/yuragi
"""
import os
import resource
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy

YURAGI = os.path.abspath(sys.argv.pop(1))


def slope(power, first, last):
    """The exponent b of power[k] ~ k^-b, least squares in log-log."""
    k = numpy.arange(first, last + 1)
    return -numpy.polyfit(numpy.log(k), numpy.log(power[k]), 1)[0]


class Noise(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.file = os.path.join(self.folder, "tile.npy")

    def run_noise(self, *arguments, **options):
        return subprocess.run([YURAGI, "noise", "--out", self.file, *arguments],
                              capture_output=True, text=True, timeout=60, **options)

    def load(self, *arguments):
        done = self.run_noise(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(done.stdout.splitlines()), 1)
        tile = numpy.load(self.file)
        self.assertEqual(tile.dtype, numpy.dtype("<f4"))
        self.assertTrue(tile.flags.c_contiguous)
        self.assertAlmostEqual(tile.mean(dtype=float), 0.0, places=5)
        self.assertAlmostEqual(tile.var(dtype=float), 1.0, places=5)
        return tile

    def test_a_line_has_its_shape_and_its_slope(self):
        tile = self.load("--dims", "1", "--size", "4096", "--beta", "2", "--seed", "5")
        self.assertEqual(tile.shape, (4096,))
        power = abs(numpy.fft.rfft(tile)) ** 2
        self.assertAlmostEqual(slope(power, 4, 512), 2.0, delta=0.2)  # one seed scatters by 0.06

    def test_a_radial_square_has_its_slope_around_the_origin(self):
        tile = self.load("--dims", "2", "--size", "512", "--meaning", "radial", "--seed", "5")
        self.assertEqual(tile.shape, (512, 512))
        power = abs(numpy.fft.fft2(tile)) ** 2
        wave = numpy.fft.fftfreq(512, 1 / 512)
        ring = numpy.rint(numpy.hypot(wave[:, None], wave[None, :])).astype(int)
        mean = numpy.bincount(ring.ravel(), power.ravel()) / numpy.bincount(ring.ravel())
        self.assertAlmostEqual(slope(mean, 4, 128), 5 / 3, delta=0.1)

    def test_a_transect_square_has_its_slope_along_rows_and_columns(self):
        tile = self.load("--dims", "2", "--size", "512", "--meaning", "transect", "--seed", "5")
        for axis in (0, 1):
            power = (abs(numpy.fft.fft(tile, axis=axis)) ** 2).mean(axis=1 - axis)
            self.assertAlmostEqual(slope(power, 4, 32), 5 / 3, delta=0.25)

    def test_a_transect_cube_has_its_slope_along_each_axis(self):
        tile = self.load("--dims", "3", "--size", "128", "--seed", "5")
        self.assertEqual(tile.shape, (128, 128, 128))
        for axis in (0, 1, 2):
            others = tuple({0, 1, 2} - {axis})
            power = (abs(numpy.fft.fft(tile, axis=axis)) ** 2).mean(axis=others)
            self.assertAlmostEqual(slope(power, 4, 16), 5 / 3, delta=0.25)

    def test_an_integral_scale_takes_the_power_out_of_long_waves(self):
        endless = self.load("--dims", "1", "--size", "4096", "--seed", "5")
        gusts = self.load("--dims", "1", "--size", "4096", "--seed", "5", "--integral-scale", "0.01")
        share = [(abs(numpy.fft.rfft(tile)[1:5]) ** 2).sum() / (abs(numpy.fft.rfft(tile)) ** 2).sum()
                 for tile in (endless, gusts)]
        self.assertGreater(share[0], 0.5)
        self.assertLess(share[1], 0.3)

    def test_the_help_says_what_the_integral_scale_is(self):
        done = self.run_noise("--help")
        self.assertEqual(done.returncode, 0)
        self.assertIn("--integral-scale", done.stdout)
        self.assertIn("part of the edge", done.stdout)

    def test_an_integral_scale_that_is_not_allowed_says_what_is(self):
        for scale in ("-1", "nan", "1e-9"):
            done = self.run_noise("--size", "64", "--integral-scale=" + scale)
            self.assertEqual(done.returncode, 64)
            self.assertIn("integral scale must be 0", done.stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_cube_has_a_smaller_largest_size(self):
        done = self.run_noise("--dims", "3", "--size", "512")
        self.assertEqual(done.returncode, 64)
        self.assertIn("8 to 256 in three", done.stderr)

    def test_the_seed_decides_every_bit(self):
        first = self.load("--size", "64", "--seed", "1")
        again = self.load("--size", "64", "--seed", "1")
        other = self.load("--size", "64", "--seed", "2")
        self.assertEqual(first.tobytes(), again.tobytes())
        self.assertNotEqual(first.tobytes(), other.tobytes())

    def test_a_size_that_is_not_allowed_says_what_is(self):
        done = self.run_noise("--size", "100")
        self.assertEqual(done.returncode, 64)
        self.assertIn("power of two", done.stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_disk_that_fills_leaves_the_old_file_and_nothing_beside_it(self):
        old = self.load("--size", "8").tobytes()

        def fill_disk():
            """A stand-in: no file may grow above 10000 bytes, and trying is an error as on a full disk."""
            resource.setrlimit(resource.RLIMIT_FSIZE, (10000, 10000))
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

        done = self.run_noise("--size", "64", preexec_fn=fill_disk)
        self.assertEqual(done.returncode, 73, done.stderr)
        self.assertIn("cannot write", done.stderr)
        self.assertEqual(os.listdir(self.folder), ["tile.npy"])
        self.assertEqual(numpy.load(self.file).tobytes(), old)


if __name__ == "__main__":
    unittest.main()
