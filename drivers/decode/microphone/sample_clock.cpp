#include "drivers/decode/microphone/sample_clock.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace yuragi::drivers::decode::microphone {
namespace {

constexpr double kWideBand_hz = 1.0;
constexpr double kNarrowBand_hz = 0.05;
constexpr double kNarrowing_s = 5.0;
constexpr double kGap_ns = 0.5e9;
/// No converter is off by more.
constexpr double kRateTolerance = 0.01;

}  // namespace

std::int64_t SampleClock::add(std::uint64_t end_sample, std::int64_t time_ns) noexcept {
  const double samples = static_cast<double>(end_sample) - static_cast<double>(last_sample_);
  const double step_ns = samples * sample_ns_ + fraction_ns_;
  const double error_ns = static_cast<double>(time_ns - last_ns_) - step_ns;
  if (!is_locked_ || samples <= 0.0 || !(std::abs(error_ns) < kGap_ns)) {
    is_locked_ = true;
    sample_ns_ = nominal_ns_;
    last_sample_ = end_sample;
    last_ns_ = time_ns;
    fraction_ns_ = 0.0;
    locked_s_ = 0.0;
    return last_ns_;
  }

  // Critically damped loop (Adriaensen's b and c), whose coefficients follow the buffer's length.
  const double period_s = samples * nominal_ns_ * 1e-9;
  locked_s_ += period_s;
  const double band_hz = std::max(kNarrowBand_hz, kWideBand_hz / (1.0 + locked_s_ / kNarrowing_s));
  const double omega = std::min(0.5, 2.0 * std::numbers::pi * band_hz * period_s);
  const double exact_ns = step_ns + std::numbers::sqrt2 * omega * error_ns;
  sample_ns_ = std::clamp(sample_ns_ + omega * omega * error_ns / samples, (1.0 - kRateTolerance) * nominal_ns_,
                          (1.0 + kRateTolerance) * nominal_ns_);
  const double whole_ns = std::floor(exact_ns);
  last_ns_ += static_cast<std::int64_t>(whole_ns);
  fraction_ns_ = exact_ns - whole_ns;
  last_sample_ = end_sample;
  return last_ns_;
}

}  // namespace yuragi::drivers::decode::microphone
