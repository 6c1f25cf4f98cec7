#include "drivers/decode/mic_gain_watch.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi {
namespace {

constexpr double kGainMemory_s = 300.0;
constexpr double kBeforeSuspicion_s = 120.0;
constexpr double kOpposite = -0.6;   // correlation of the two bands from which on they go against each other
constexpr double kMovesAt_db = 1.5;  // standard deviation of the upper band that is more than its own scatter
constexpr double kTooEven_db = 1.0;  // a wind of 10 % turbulence scatters by 1.7 dB at n = 2
constexpr double kLoud_db = -30.0;

}  // namespace

void MicGainWatch::add(double level_db, std::optional<double> high_db, double duration_s) noexcept {
  // Means and (co)variances with a memory; plain ones until that is full (West 1979, "Updating mean and variance
  // estimates: an improved method").
  heard_s_ += duration_s;
  const double weight = duration_s / std::min(heard_s_, kGainMemory_s);
  const double level_step = level_db - level_mean_;
  level_mean_ += weight * level_step;
  level_variance_ = (1.0 - weight) * (level_variance_ + weight * level_step * level_step);
  if (high_db) {
    const double high_step = *high_db - high_mean_;
    high_mean_ += weight * high_step;
    high_variance_ = (1.0 - weight) * (high_variance_ + weight * high_step * high_step);
    covariance_ = (1.0 - weight) * (covariance_ + weight * level_step * high_step);
  }

  const double both = std::sqrt(level_variance_ * high_variance_);
  const bool goes_against = high_variance_ > kMovesAt_db * kMovesAt_db && both > 0.0 && covariance_ < kOpposite * both;
  const bool is_too_even = level_mean_ > kLoud_db && level_variance_ < kTooEven_db * kTooEven_db;
  suspects_ = heard_s_ >= kBeforeSuspicion_s && (goes_against || is_too_even);
}

}  // namespace yuragi
