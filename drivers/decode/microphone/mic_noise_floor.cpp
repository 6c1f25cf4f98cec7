#include "drivers/decode/microphone/mic_noise_floor.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::drivers::decode::microphone {
namespace {

constexpr double kPercentile = 0.02;
/// How far that percentile lies below the mean of a steady noise: the level of one second scatters by about half a dB.
constexpr double kBias_db = 0.9;
constexpr double kBeforeBelief_s = 3600.0;

}  // namespace

void MicNoiseFloor::add(double level_db, double duration_s) noexcept {
  const double keep = std::exp(-duration_s / memory_s_);
  for (double& weight_s : weight_s_) weight_s *= keep;
  const double bin = std::clamp((level_db - kLowest_db) / kBin_db, 0.0, static_cast<double>(kBins - 1));
  weight_s_[static_cast<std::size_t>(bin)] += duration_s;
  total_s_ = total_s_ * keep + duration_s;
  measured_s_ += duration_s;
}

std::optional<double> MicNoiseFloor::floor_db() const noexcept {
  if (measured_s_ < std::min(kBeforeBelief_s, 0.5 * memory_s_)) return std::nullopt;
  double below_s = 0.0;
  std::size_t bin = 0;
  while (bin + 1 < kBins && below_s + weight_s_[bin] < kPercentile * total_s_) below_s += weight_s_[bin++];
  return kLowest_db + (static_cast<double>(bin) + 0.5) * kBin_db + kBias_db;
}

}  // namespace yuragi::drivers::decode::microphone
