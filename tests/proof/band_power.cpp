#include "tests/proof/band_power.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace yuragi::proof {

Welch::Welch(double rate_hz, double segment_s, double top_hz)
    : step_hz_(1.0 / segment_s),
      window_(static_cast<std::size_t>(std::lround(rate_hz * segment_s))),
      fft_(1, window_.size()) {
  const auto size = static_cast<double>(window_.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < window_.size(); ++i) {
    window_[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / size);
    squares += window_[i] * window_[i];
  }
  scale_ = std::sqrt(2.0 / (rate_hz * squares));
  kept_ = std::min(static_cast<std::size_t>(top_hz / step_hz_) + 1, fft_.row_modes());
}

/// The samples of the transform, less their straight line by least squares, under the window.
Welch::Bins Welch::transform() {
  const std::span<double> samples = fft_.samples();
  const auto size = static_cast<double>(samples.size());
  const double middle = 0.5 * (size - 1.0);
  double mean = 0.0;
  double slope = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    mean += samples[i] / size;
    slope += samples[i] * (static_cast<double>(i) - middle);
  }
  slope *= 12.0 / (size * (size * size - 1.0));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = window_[i] * (samples[i] - mean - slope * (static_cast<double>(i) - middle));
  }
  fft_.forward();
  const std::span<const std::complex<double>> spectrum = fft_.spectrum();
  Bins bins(spectrum.begin(), spectrum.begin() + static_cast<std::ptrdiff_t>(kept_));
  for (std::complex<double>& bin : bins) bin *= scale_;
  return bins;
}

/// Where the segments begin.
std::vector<std::size_t> Welch::starts(std::size_t samples) const {
  if (samples < window_.size()) throw std::invalid_argument("a wind that is shorter than a segment");
  const std::size_t spare = samples - window_.size();
  const std::size_t gaps = (2 * spare + window_.size() - 1) / window_.size();
  std::vector<std::size_t> result = {0};
  for (std::size_t segment = 1; segment <= gaps; ++segment) result.push_back(segment * spare / gaps);
  return result;
}

Welch::Segments Welch::segments(std::span<const wind::Vector> samples) {
  Segments result;
  for (const auto component : {&wind::Vector::u_m_s, &wind::Vector::v_m_s}) {
    for (const std::size_t from : starts(samples.size())) {
      for (std::size_t i = 0; i < window_.size(); ++i) fft_.samples()[i] = samples[from + i].*component;
      result.push_back(transform());
    }
  }
  return result;
}

std::vector<double> Welch::weights(std::size_t samples) const {
  std::vector<double> result(samples);
  double sum = 0.0;
  for (const std::size_t from : starts(samples)) {
    for (std::size_t i = 0; i < window_.size(); ++i) {
      result[from + i] += window_[i] * window_[i];
      sum += window_[i] * window_[i];
    }
  }
  for (double& weight : result) weight *= static_cast<double>(samples) / sum;
  return result;
}

std::vector<double> Welch::density(const Segments& segments) {
  std::vector<double> density(segments.front().size());
  // Both components of one segment add up; segments are averaged.
  const double part = 2.0 / static_cast<double>(segments.size());
  for (const Bins& bins : segments) {
    for (std::size_t k = 0; k < bins.size(); ++k) density[k] += part * std::norm(bins[k]);
  }
  return density;
}

std::vector<Band> octaves_down(double top_hz, double bottom_hz) {
  std::vector<Band> bands;
  double to_hz = top_hz;
  while (to_hz > bottom_hz) {
    bands.push_back({std::max(0.5 * to_hz, bottom_hz), to_hz});
    to_hz *= 0.5;
  }
  std::ranges::reverse(bands);
  return bands;
}

double power_in(const std::vector<double>& density, double step_hz, Band band) {
  double power = 0.0;
  for (std::size_t k = 1; k < density.size(); ++k) {
    const double frequency_hz = static_cast<double>(k) * step_hz;
    if (frequency_hz >= band.from_hz && frequency_hz < band.to_hz) power += density[k] * step_hz;
  }
  return power;
}

WindMoments moments_of(std::span<const wind::Vector> samples) {
  WindMoments moments;
  const double part = 1.0 / static_cast<double>(samples.size());
  for (const wind::Vector& wind : samples) {
    moments.mean = moments.mean + part * wind;
    moments.mean_speed_m_s += part * speed_of(wind);
  }
  for (const wind::Vector& wind : samples) {
    const wind::Vector off = wind - moments.mean;
    moments.variance_m2_s2 += part * (off.u_m_s * off.u_m_s + off.v_m_s * off.v_m_s);
  }
  return moments;
}

}  // namespace yuragi::proof
