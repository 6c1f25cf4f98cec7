#pragma once

#include <memory>
#include <utility>

#include "engine/wind/ground_wind.hpp"

namespace yuragi::bench {

inline constexpr double kBenchTick_s = 1.0 / 60.0;

/// The wind that all rows are measured in: a steady breeze, with gusts that differ from place to place where there is a
/// noise for them. What the daemon's wind has besides belongs here and nowhere else.
class BenchWind {
 public:
  static constexpr WindVector kBreeze = {6.0, 3.0};

  /// With `gusts`: every octave that a tile holds has a strength, and is carried and turned as the daemon does it.
  explicit BenchWind(std::shared_ptr<const GustNoise> gusts = nullptr) : gusts_(std::move(gusts)) {
    if (!gusts_) return;
    wind_.gusts.ahead = (1.0 / speed_of(kBreeze)) * kBreeze;
    wind_.gusts.along_m_s.fill(kOctave_m_s);
    wind_.gusts.across_m_s.fill(kOctave_m_s);
  }

  /// The wind of the next tick.
  const GroundWind& next() noexcept {
    if (gusts_) gusts_->carry(wind_.gusts.carried, kBreeze.u_m_s, -kBreeze.v_m_s, kBenchTick_s, kTurnover_m23_s);
    return wind_;
  }

 private:
  static constexpr float kOctave_m_s = 0.3F;
  static constexpr double kTurnover_m23_s = 0.3;

  std::shared_ptr<const GustNoise> gusts_;
  GroundWind wind_ = kBreeze;
};

}  // namespace yuragi::bench
