#include "viewer/app/wind_trace.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace yuragi::viewer::app {
namespace {

constexpr std::size_t kFewest = 64;  // for a spectrum
constexpr double kBandRatio = 1.25;  // of a band's ends
constexpr double kTwoPi = 2.0 * std::numbers::pi;

}  // namespace

WindTrace::WindTrace() {
  speeds_.reserve(kSamples + 1);
  measured_.reserve(kSamples + 1);
}

void WindTrace::hear(double time_s, double speed_m_s, std::optional<double> measured_m_s) {
  constexpr double kAll_s = static_cast<double>(kSamples) * kInterval_s;
  if (ends_s_ && (time_s < *ends_s_ - 2.0 * kInterval_s || time_s > *ends_s_ + kAll_s)) {
    speeds_.clear();
    measured_.clear();
    ends_s_.reset();
  }
  if (!ends_s_) {
    ends_s_ = time_s + kInterval_s;
    sum_ = 0.0;
    count_ = 0;
  }
  for (; time_s >= *ends_s_; *ends_s_ += kInterval_s) {
    const double before = speeds_.empty() ? speed_m_s : static_cast<double>(speeds_.back());
    put(count_ > 0 ? sum_ / count_ : before, measured_now_);
    sum_ = 0.0;
    count_ = 0;
  }
  sum_ += speed_m_s;
  ++count_;
  measured_now_ = measured_m_s.value_or(0.0);
}

void WindTrace::put(double speed_m_s, double measured_m_s) {
  speeds_.push_back(static_cast<float>(speed_m_s));
  measured_.push_back(static_cast<float>(measured_m_s));
  if (speeds_.size() <= kSamples) return;
  speeds_.erase(speeds_.begin());
  measured_.erase(measured_.begin());
}

std::vector<SpectrumBand> spectrum_of(const std::vector<float>& speeds_m_s) {
  const std::size_t size = speeds_m_s.size();
  if (size < kFewest) return {};
  const auto count = static_cast<double>(size);
  const double mean = std::accumulate(speeds_m_s.begin(), speeds_m_s.end(), 0.0) / count;
  std::vector<double> windowed(size);
  double window_power = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    const double window = 0.5 - 0.5 * std::cos(kTwoPi * static_cast<double>(i) / count);
    window_power += window * window;
    windowed[i] = window * (static_cast<double>(speeds_m_s[i]) - mean);
  }
  std::vector<SpectrumBand> bands;
  double sum = 0.0;
  std::size_t first = 1;
  for (std::size_t k = 1; k < size / 2; ++k) {
    std::complex<double> amplitude = 0.0;
    std::complex<double> phase = 1.0;
    const std::complex<double> step = std::polar(1.0, -kTwoPi * static_cast<double>(k) / count);
    for (const double value : windowed) {
      amplitude += value * phase;
      phase *= step;
    }
    sum += 2.0 * std::norm(amplitude) * WindTrace::kInterval_s / window_power;
    if (static_cast<double>(k + 1) < kBandRatio * static_cast<double>(first)) continue;
    const double middle = std::sqrt(static_cast<double>(first) * static_cast<double>(k));
    bands.push_back({middle / (count * WindTrace::kInterval_s), sum / static_cast<double>(k + 1 - first)});
    sum = 0.0;
    first = k + 1;
  }
  return bands;
}

}  // namespace yuragi::viewer::app
