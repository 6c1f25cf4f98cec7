#include "drivers/decode/microphone/mic_gain_watch.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::drivers::decode::microphone {
namespace {

constexpr double kGainMemory_s = 300.0;
constexpr double kBeforeSuspicion_s = 120.0;
// Tried on gusts through amplifiers with releases of 0.3 to 5 s, with and without a voice: late ones make -0.5 to -0.8,
// and what has none -0.1 to 0.1.
constexpr double kOpposite = -0.6;
constexpr double kLateOpposite = -0.35;
constexpr double kMovesAt_db = 1.5;  // standard deviation of the upper band that is more than its own scatter
constexpr double kTooEven_db = 1.0;  // a wind of 10 % turbulence scatters by 1.7 dB at n = 2
constexpr double kLoud_db = -30.0;

}  // namespace

void RunningPair::add(double a, double b, double duration_s, double memory_s) noexcept {
  measured_s += duration_s;
  if (!(measured_s > 0.0)) return;
  const double weight = std::min(1.0, duration_s / std::min(measured_s, memory_s));
  const double step_a = a - mean_a;
  const double step_b = b - mean_b;
  mean_a += weight * step_a;
  mean_b += weight * step_b;
  const double keep = 1.0 - weight;
  variance_a = keep * (variance_a + weight * step_a * step_a);
  variance_b = keep * (variance_b + weight * step_b * step_b);
  covariance = keep * (covariance + weight * step_a * step_b);
}

double RunningPair::correlation() const noexcept {
  const double both = std::sqrt(variance_a * variance_b);
  return both > 0.0 ? covariance / both : 0.0;
}

void MicGainWatch::add(double level_db, std::optional<double> high_db, double duration_s) noexcept {
  now_.add(level_db, high_db.value_or(0.0), duration_s, kGainMemory_s);

  // The upper band before and after the block in the middle.
  std::shift_left(recent_.begin(), recent_.end(), 1);
  recent_.back() = {level_db, high_db.value_or(0.0)};
  count_ = std::min(count_ + 1, recent_.size());
  if (count_ == recent_.size()) {
    after_.add(recent_[kBefore].level_db, recent_.back().high_db - recent_.front().high_db, duration_s, kGainMemory_s);
  }

  constexpr double kMoves = kMovesAt_db * kMovesAt_db;
  const bool goes_against = now_.variance_b > kMoves && now_.correlation() < kOpposite;
  const bool follows_late = after_.variance_b > kMoves && after_.correlation() < kLateOpposite;
  const bool is_too_even = now_.mean_a > kLoud_db && now_.variance_a < kTooEven_db * kTooEven_db;
  suspects_ = now_.measured_s >= kBeforeSuspicion_s && (goes_against || follows_late || is_too_even);
}

}  // namespace yuragi::drivers::decode::microphone
