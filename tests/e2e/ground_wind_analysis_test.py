#!/usr/bin/env python3
"""The figures of ground_wind_analysis.py, of winds in which they are known: one that travels unchanged (Taylor 1938), and
one that is the same everywhere at once. Needs no program and no recording.

usage: ground_wind_analysis_test.py
"""
import unittest

import numpy as np

import ground_wind_analysis as gw

SPEED_M_S = 6.0
AHEAD = np.array([0.8, 0.6])
SIZE = 1800 * gw.RATE_HZ


def made_record():
    """Steady on average; gusts whose spectrum falls as white noise does behind two low passes (1 Hz and 0.05 Hz)."""
    gusts = np.random.default_rng(7).standard_normal((SIZE, 2))
    for hz in (1.0, 0.05):
        part = 1 - np.exp(-2 * np.pi * hz / gw.RATE_HZ)
        for i in range(1, SIZE):
            gusts[i] = gusts[i - 1] + part * (gusts[i] - gusts[i - 1])
    return SPEED_M_S * AHEAD + (gusts - gusts.mean(axis=0)) / gusts.std(axis=0)


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.record = made_record()
        cls.windows = gw.windows_of(cls.record, 60)
        cls.at = np.arange(SIZE) / gw.RATE_HZ

    def later(self, way_m):
        """The record as it comes by so far downwind."""
        return np.stack([np.interp(self.at - way_m / SPEED_M_S, self.at, part) for part in self.record.T], axis=1)

    def test_windows_are_those_of_the_record(self):
        self.assertEqual([(w.begin, w.end) for w in self.windows[:2]], [(600, 3000), (3000, 6000)])
        for window in self.windows:
            self.assertAlmostEqual(window.speed_m_s, SPEED_M_S, delta=0.5)
            self.assertLess(window.turn_deg, 20)
            east, south = window.place(10.0, 1.0)
            self.assertAlmostEqual(east * window.ahead[0] - south * window.ahead[1], 10.0, places=3)
        self.assertGreater(gw.Window(0, 1, np.array([1.0, 0.0]), 1.0, 0.0).place(0.0, 1.0)[1], -1.01)
        self.assertEqual(gw.Window(0, 1, np.array([1.0, 0.0]), 1.0, 0.0).place(0.0, 1.0)[1], -1.0, "left is north")

    def test_a_wind_that_travels_is_found_to_travel(self):
        for distance_m in (2.0, 6.5, 20.0, 60.0):
            for window in self.windows[1:]:
                first, second = (gw.high_passed(wind @ window.ahead) for wind in (self.record, self.later(distance_m)))
                found = gw.correlations(first, second, window, gw.most_lag_of(distance_m, window))
                lag_s, height = gw.peak(found)
                self.assertAlmostEqual(lag_s * SPEED_M_S / distance_m, 1.0, delta=0.02)
                self.assertGreater(height, 0.98)
                own = gw.own_correlation(first, window, distance_m / SPEED_M_S)
                self.assertAlmostEqual(found[len(found) // 2], own, delta=0.05)  # a window loses what has left it

    def test_a_wind_that_is_everywhere_at_once_is_found_out(self):
        window = self.windows[2]
        series = gw.high_passed(self.record @ window.ahead)
        lag_s, height = gw.peak(gw.correlations(series, series, window, gw.most_lag_of(6.5, window)))
        self.assertAlmostEqual(lag_s, 0.0, places=3)
        self.assertAlmostEqual(height, 1.0, places=3)
        self.assertLess(gw.own_correlation(series, window, 6.5 / SPEED_M_S), 0.9)

    def test_what_stands_over_the_ground_is_what_comes_by(self):
        window = self.windows[3]
        places = [(self.later(way_m + 30) @ window.ahead)[window.begin : window.end] for way_m in gw.span_offsets()]
        passing = gw.passing_variance(self.record @ window.ahead, window)
        self.assertAlmostEqual(np.sqrt(gw.span_variance(np.stack(places)) / passing), 1.0, delta=0.1)
        self.assertLess(gw.span_variance(np.stack([places[0]] * 6)), 1e-20)

    def test_coherence_is_that_which_was_put_in(self):
        # Of two series with a common part the coherence is the share of its power.
        noise = np.random.default_rng(8).standard_normal((3, SIZE))
        common, first, second = noise
        sums = sum(gw.cross_spectra(common + first, np.roll(common, 35) + second, window, 3.5) for window in self.windows)
        for hz in (0.1, 0.4, 1.6):
            self.assertAlmostEqual(gw.root_coherence(sums, hz), 0.5, delta=0.12)
        alike = sum(gw.cross_spectra(common, np.roll(common, 35), window, 3.5) for window in self.windows)
        self.assertAlmostEqual(gw.root_coherence(alike, 0.4), 1.0, places=6)

    def test_octaves_have_the_power(self):
        self.assertAlmostEqual(np.sum(gw.octave_power(self.record)) / gw.variance(self.record), 0.95, delta=0.1)


if __name__ == "__main__":
    unittest.main()
