#include "daemon/tools/report/welch_spectrum.hpp"

#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

namespace yuragi::daemon::tools::report {
namespace {

/// Subtracts the best straight line from evenly spaced values.
void detrend(std::span<double> values) {
  const auto count = static_cast<double>(values.size());
  const double middle = 0.5 * (count - 1.0);
  double mean = 0.0;
  double slope = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    mean += values[i];
    slope += (static_cast<double>(i) - middle) * values[i];
  }
  mean /= count;
  slope /= count * (count * count - 1.0) / 12.0;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= mean + slope * (static_cast<double>(i) - middle);
}

}  // namespace

WelchSpectrum::WelchSpectrum(std::size_t segment, double step_s, bool is_of_speed)
    : fft_(1, segment), window_(segment), step_s_(step_s), is_of_speed_(is_of_speed), power_sum_(segment / 2 + 1) {
  for (std::size_t i = 0; i < segment; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(segment);
    window_[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * turn);
    window_power_ += window_[i] * window_[i];
  }
  samples_.reserve(segment);
}

void WelchSpectrum::add(const EvenSample& sample) {
  samples_.push_back(sample);
  if (samples_.size() < window_.size()) return;
  take_segment();
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(window_.size() / 2));
}

void WelchSpectrum::take_segment() {
  const std::span<double> values = fft_.samples();
  wind::Vector mean{};
  double mean_speed_m_s = 0.0;
  for (const EvenSample& sample : samples_) {
    mean = mean + sample.wind.value_or(wind::Vector{});
    mean_speed_m_s += sample.speed_m_s;
  }
  const auto count = static_cast<double>(samples_.size());
  mean_speed_m_s /= count;

  // Along the segment's own mean wind; without directions, of the speed.
  const double length = speed_of(mean);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const wind::Vector wind = samples_[i].wind.value_or(wind::Vector{});
    values[i] = is_of_speed_ || length == 0.0 ? samples_[i].speed_m_s
                                              : (wind.u_m_s * mean.u_m_s + wind.v_m_s * mean.v_m_s) / length;
  }
  const double along_m_s = is_of_speed_ ? mean_speed_m_s : length / count;
  squared_speed_sum_m2_s2_ += along_m_s * along_m_s;

  detrend(values);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= window_[i];
  fft_.forward();
  const double scale = step_s_ / window_power_;
  for (std::size_t k = 0; k < power_sum_.size(); ++k) {
    const bool is_single = k == 0 || k + 1 == power_sum_.size();
    power_sum_[k] += (is_single ? 1.0 : 2.0) * scale * std::norm(fft_.spectrum()[k]);
  }
  ++segments_;
}

std::optional<SpectrumNumbers> WelchSpectrum::numbers() const {
  if (segments_ == 0) return std::nullopt;
  SpectrumNumbers numbers;
  numbers.is_of_speed = is_of_speed_;
  numbers.segment_readings = window_.size();
  numbers.segments = segments_;
  numbers.step_s = step_s_;
  numbers.density_m2_s2_hz = power_sum_;
  const auto count = static_cast<double>(segments_);
  for (double& density : numbers.density_m2_s2_hz) density /= count;
  fit_spectrum(numbers, squared_speed_sum_m2_s2_ / count);
  return numbers;
}

IntegralTime::IntegralTime(std::size_t block, double step_s)
    : block_(block), step_s_(step_s), fft_(1, std::bit_ceil(2 * block)), sum_(block) {
  samples_.reserve(block);
}

void IntegralTime::add(double speed_m_s) {
  samples_.push_back(speed_m_s);
  if (samples_.size() < block_) return;

  // By the Wiener-Khinchin theorem; zero padding prevents circular correlation.
  double mean = 0.0;
  for (const double value : samples_) mean += value;
  mean /= static_cast<double>(block_);
  const std::span<double> values = fft_.samples();
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i < block_ ? samples_[i] - mean : 0.0;
  fft_.forward();
  for (std::complex<double>& mode : fft_.spectrum()) mode = std::norm(mode);
  fft_.inverse();
  for (std::size_t lag = 0; lag < block_; ++lag) sum_[lag] += fft_.samples()[lag];
  samples_.clear();
}

std::optional<double> IntegralTime::seconds() const {
  if (sum_.empty() || !(sum_[0] > 0.0)) return std::nullopt;
  double total = -0.5 * sum_[0];
  for (const double value : sum_) {
    if (value <= 0.0) break;
    total += value;
  }
  return step_s_ * total / sum_[0];
}

}  // namespace yuragi::daemon::tools::report
