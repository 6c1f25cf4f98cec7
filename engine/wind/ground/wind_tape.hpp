#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/base/state_pass.hpp"
#include "engine/wind/ground/wind_stroke.hpp"

namespace yuragi::wind::ground {

/// The wind that was measured at one place, along the way that it has travelled since: a ring of samples, one per
/// kStep_m of the way. The pen writes at the sensor's place, the mean wind moves the tape, and a place D downwind reads
/// the sample that was written when the way was D shorter: the propagation operator, "read at the place minus the
/// shift" (Chiba, section 2-2), for a measured signal (engine/wind/model.md W25).
///
/// A tick writes as many samples as the way has advanced, linear between this tick's and the last one's. The first
/// fills the tape with the mean, without gusts. Owns its samples (0.4 MB). Thread-safe: no. Realtime-safe: all but
/// construction.
class WindTape {
 public:
  static constexpr double kStep_m = 0.25;
  static constexpr std::int64_t kSamples = 1024;
  static constexpr double kLength_m = kStep_m * static_cast<double>(kSamples);

  WindTape() : samples_(static_cast<std::size_t>(kSamples)) {}

  void write(const WindPen& pen, double way_m) noexcept;

  /// Two samples, and the position of the wind between them this far back along the way (0 or more).
  struct Place {
    const WindSample* first = nullptr;
    const WindSample* second = nullptr;
    double fraction = 0.0;
    double left_m = 0.0;  ///< to the end of the tape; negative: beyond it, where the last sample is used
  };
  Place back(double way_m) const noexcept {
    const double left_m = kLength_m - 2.0 * kStep_m - way_m;
    // Near the pen the present measurement counts, so that nothing jumps when a sample is completed.
    if (way_m < kStep_m) return {&now_, &one_back_, way_m / kStep_m, left_m};
    const double place = std::max((way_m_ - way_m) / kStep_m, static_cast<double>(newest_ - kSamples + 1));
    auto number = static_cast<std::int64_t>(place);  // toward zero
    number -= static_cast<double>(number) > place ? 1 : 0;
    number = std::min(number, newest_ - 1);
    return {&sample(number), &sample(number + 1), std::min(place - static_cast<double>(number), 1.0), left_m};
  }

  void list_state(StatePass& pass) {
    pass(samples_, has_begun_, now_, last_written_, one_back_);
    pass.within(way_m_, 0.0, StatePass::kLargestTotal);
    newest_ = newest_at(way_m_);
  }

 private:
  static std::int64_t newest_at(double way_m) noexcept {
    return static_cast<std::int64_t>(std::floor(way_m / kStep_m));
  }
  const WindSample& sample(std::int64_t number) const noexcept {
    return samples_[static_cast<std::size_t>(number & (kSamples - 1))];
  }
  WindSample& sample(std::int64_t number) noexcept {
    return samples_[static_cast<std::size_t>(number & (kSamples - 1))];
  }

  std::vector<WindSample> samples_;
  bool has_begun_ = false;
  std::int64_t newest_ = 0;  ///< number of the last written sample; it is newest_ kStep_m along the way
  double way_m_ = 0.0;
  WindSample now_, last_written_, one_back_;
};

}  // namespace yuragi::wind::ground
