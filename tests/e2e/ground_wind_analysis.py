"""Figures of a wind over the ground: how it varies, and how it travels. numpy alone; what a figure is compared with stands
in ground_wind_test.py, and ground_wind_analysis_test.py tries these functions on winds that are known.

A wind is an array of (time, 2), u east and v north, m/s; a place is (east, south), m from the middle of the scenes; all
series have RATE_HZ samples a second.
"""
import dataclasses

import numpy as np

from wind_record_test import density, octaves

RATE_HZ = 10
WINDOW_S = 300
MEAN_S = 60  # what is slower is taken out of correlations
SPAN_M, SPAN_POINTS = 50.0, 6  # of the wind along a line at one moment


@dataclasses.dataclass(frozen=True)
class Window:
    """A stretch of the record: its samples, the wind's way, its speed, and how far it turns."""

    begin: int
    end: int
    ahead: np.ndarray
    speed_m_s: float
    turn_deg: float

    def place(self, along_m, across_m=0.0):
        """So far downwind of the middle, and so far to the left of that line."""
        east, north = along_m * self.ahead + across_m * np.array([-self.ahead[1], self.ahead[0]])
        return round(float(east), 4), round(float(-north), 4)


def windows_of(record, begin_s):
    """The windows of a record; nothing before `begin_s` is used. It turns as the mean of the last 100 s does."""
    size = WINDOW_S * RATE_HZ
    memory = 100 * RATE_HZ
    sums = np.cumsum(np.vstack([np.zeros((1, 2)), record]), axis=0)
    result = []
    for begin in range(0, len(record) - size + 1, size):
        at = np.arange(max(begin, memory), begin + size, RATE_HZ)
        slow = sums[at] - sums[at - memory]
        turning = np.unwrap(np.arctan2(slow[:, 1], slow[:, 0]))
        first = max(begin, round(begin_s * RATE_HZ))
        mean = np.mean(record[first : begin + size], axis=0)
        speed = float(np.hypot(*mean))
        result.append(Window(first, begin + size, mean / speed, speed, float(np.degrees(np.ptp(turning)))))
    return result


def high_passed(series):
    """The series less its mean of MEAN_S, weighted by a Hann window."""
    half = MEAN_S * RATE_HZ // 2
    weight = np.hanning(2 * half + 3)[1:-1]
    padded = np.pad(series, half, mode="reflect")
    size = len(padded) + len(weight) - 1
    size += -size % 4096  # a length of small factors
    both = np.fft.rfft(padded, size) * np.fft.rfft(weight / weight.sum(), size)
    return series - np.fft.irfft(both, size)[len(weight) - 1 : len(padded)]


def correlations(first, second, window, most_lag):
    """Of `first` in the window with `second` as many samples later as -most_lag to most_lag says; series without mean."""
    lags = np.arange(-most_lag, most_lag + 1)
    found = np.empty(len(lags))
    for i, lag in enumerate(lags):
        begin, end = max(window.begin, -lag), min(window.end, len(second) - lag)
        a, b = first[begin:end], second[begin + lag : end + lag]
        found[i] = np.dot(a, b) / np.sqrt(np.dot(a, a) * np.dot(b, b))
    return found


def most_lag_of(distance_m, window):
    return int(np.ceil(RATE_HZ * (2.0 * distance_m / window.speed_m_s + 1.0)))


def peak(correlation, about_s=None):
    """Lag, s, and height of the largest correlation; a parabola through it and its neighbours. `about_s`: it is looked for from
    0.4 to 1.8 times this lag, as far away from it a correlation of few gusts can be as large by chance."""
    middle = len(correlation) // 2
    first, last = 1, len(correlation) - 2
    if about_s is not None:
        first, last = (int(np.clip(middle + round(part * about_s * RATE_HZ), first, last)) for part in (0.4, 1.8))
    top = first + int(np.argmax(correlation[first : last + 1]))
    before, at, after = correlation[top - 1 : top + 2]
    curve = before - 2 * at + after
    shift = float(np.clip(0.5 * (before - after) / curve, -0.5, 0.5)) if curve < 0 else 0.0
    return (top - middle + shift) / RATE_HZ, at - 0.25 * (before - after) * shift


def own_correlation(series, window, lag_s):
    """Of a series with itself so much later; between samples, linearly."""
    lag = lag_s * RATE_HZ
    both = correlations(series, series, window, int(lag) + 1)[int(lag) + 1 :]
    return float(np.interp(lag, np.arange(len(both)), both))


def variance(wind):
    return float(np.sum(np.var(wind, axis=0)))


def octave_power(wind):
    return octaves(density(wind, RATE_HZ))


def span_offsets():
    return np.linspace(-SPAN_M / 2, SPAN_M / 2, SPAN_POINTS)


def span_variance(series):
    """Mean over moments of the variance among places; `series`: (place, time)."""
    return float(np.mean(np.var(series, axis=0)))


def passing_variance(series, window):
    """The same of what passes one place while the wind goes SPAN_M."""
    delays = np.round((span_offsets() + SPAN_M / 2) / window.speed_m_s * RATE_HZ).astype(int)
    begin = max(window.begin, delays[-1])
    return span_variance(np.stack([series[begin - delay : window.end - delay] for delay in delays]))


def cross_spectra(first, second, window, delay_s):
    """Sums of |A|^2, |B|^2 and A B* over stretches of MEAN_S (Hann, half over another), `second` taken `delay_s` later."""
    size = MEAN_S * RATE_HZ
    delay = round(delay_s * RATE_HZ)
    weight = np.hanning(size + 1)[:-1]
    total = np.zeros((3, size // 2 + 1), complex)
    for begin in range(max(window.begin, -delay), min(window.end, len(second) - delay) - size + 1, size // 2):
        a, b = first[begin : begin + size], second[begin + delay : begin + delay + size]
        a, b = (np.fft.rfft((part - part.mean()) * weight) for part in (a, b))
        total += [np.abs(a) ** 2, np.abs(b) ** 2, a * np.conj(b)]
    return total


def root_coherence(spectra, frequency_hz):
    """In the octave about a frequency, of the sums of cross_spectra()."""
    frequency = np.arange(spectra.shape[1]) / MEAN_S
    octave = (frequency >= frequency_hz / np.sqrt(2)) & (frequency < frequency_hz * np.sqrt(2))
    a, b, both = np.sum(spectra[:, octave], axis=1)
    return float(np.abs(both) / np.sqrt(a.real * b.real))
