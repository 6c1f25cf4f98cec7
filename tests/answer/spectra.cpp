#include "tests/answer/spectra.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace yuragi::answer {
namespace {

/// Lines are at whole multiples of the step: what is asked for from 0.5 Hz on begins with the line at 0.5 Hz.
std::size_t line_at(double frequency_hz, double step_hz) {
  return static_cast<std::size_t>(std::max(std::ceil(frequency_hz / step_hz - 1e-6), 0.0));
}

}  // namespace

double Spectrum::variance(double from_hz, double to_hz) const {
  double sum = 0.0;
  for (std::size_t i = line_at(from_hz, step_hz); i < power.size(); ++i) {
    if (static_cast<double>(i) * step_hz > to_hz + 1e-6) break;
    sum += power[i];
  }
  return sum;
}

double Spectrum::deviation_above(double from_hz) const {
  return std::sqrt(variance(from_hz, static_cast<double>(power.size()) * step_hz));
}

double Spectrum::peak_hz(double from_hz, double to_hz) const {
  std::size_t top = line_at(from_hz, step_hz);
  for (std::size_t i = top; i < power.size() && static_cast<double>(i) * step_hz <= to_hz + 1e-6; ++i) {
    if (power[i] > power[top]) top = i;
  }
  return static_cast<double>(top) * step_hz;
}

double Spectrum::centroid_hz(double from_hz) const {
  double sum = 0.0;
  double weighted_hz = 0.0;
  for (std::size_t i = line_at(from_hz, step_hz); i < power.size(); ++i) {
    sum += power[i];
    weighted_hz += power[i] * static_cast<double>(i) * step_hz;
  }
  return sum > 0.0 ? weighted_hz / sum : 0.0;
}

Spectrum& Spectrum::operator+=(const Spectrum& other) {
  if (power.empty()) return *this = other;
  for (std::size_t i = 0; i < std::min(power.size(), other.power.size()); ++i) power[i] += other.power[i];
  return *this;
}

Welch::Welch(double rate_hz, double segment_s)
    : fft_(1, static_cast<std::size_t>(std::lround(segment_s * rate_hz))),
      step_hz_(rate_hz / static_cast<double>(fft_.size())) {
  for (std::size_t i = 0; i < fft_.size(); ++i) {
    const double turn_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(fft_.size());
    window_.push_back(0.5 * (1.0 - std::cos(turn_rad)));
    window_power_ += window_.back() * window_.back();
  }
}

Spectrum Welch::of(std::span<const float> series) {
  const std::size_t size = fft_.size();
  Spectrum spectrum{std::vector<double>(fft_.row_modes(), 0.0), step_hz_};
  std::size_t segments = 0;
  for (std::size_t begin = 0; begin + size <= series.size(); begin += size / 2) {
    const std::span<const float> segment = series.subspan(begin, size);
    const double middle = mean(segment);
    for (std::size_t i = 0; i < size; ++i) {
      fft_.samples()[i] = (static_cast<double>(segment[i]) - middle) * window_[i];
    }
    fft_.forward();
    for (std::size_t i = 0; i < spectrum.power.size(); ++i) {
      const double sides = i == 0 || 2 * i == size ? 1.0 : 2.0;  // a line stands for its mirror image too
      spectrum.power[i] += sides * std::norm(fft_.spectrum()[i]);
    }
    ++segments;
  }
  const double scale = 1.0 / (static_cast<double>(size) * window_power_ * std::max(static_cast<double>(segments), 1.0));
  for (double& power : spectrum.power) power *= scale;
  return spectrum;
}

Series high_passed(std::span<const float> series, double rate_hz, double from_hz) {
  // Whole seconds: a length that the transform is quick with.
  const auto second = static_cast<std::size_t>(std::lround(rate_hz));
  const std::size_t size = series.size() / second * second;
  if (size == 0) return {};
  fft::RealFft fft(1, size);
  for (std::size_t i = 0; i < size; ++i) fft.samples()[i] = static_cast<double>(series[i]);
  fft.forward();
  const std::size_t first = std::min(line_at(from_hz, rate_hz / static_cast<double>(size)), fft.row_modes());
  for (std::size_t i = 0; i < first; ++i) fft.spectrum()[i] = 0.0;
  fft.inverse();
  Series high(size);
  for (std::size_t i = 0; i < size; ++i) high[i] = static_cast<float>(fft.samples()[i] / static_cast<double>(size));
  return high;
}

}  // namespace yuragi::answer
