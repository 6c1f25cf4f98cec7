#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/wind/blend/blended_estimator.hpp"

namespace yuragi {

/// A wind as anemometers that stand somewhere measure it: a mean with gusts of many lengths, read every so often, and
/// what the estimator makes of it at each tick of 1/60 s.
class MeasuredWind {
 public:
  static constexpr double kTick_s = 1.0 / 60.0;

  MeasuredWind(std::shared_ptr<const wind::turbulence::GustNoise> noise, wind::Vector mean,
               std::vector<wind::blend::SourceSettings> sources = {wind::blend::SourceSettings()},
               int ticks_a_reading = 6)
      : mean_(mean),
        source_count_(sources.size()),
        ticks_a_reading_(ticks_a_reading),
        estimator_(source_count_, settings(std::move(sources)), std::move(noise)) {}

  /// Goes on by a tick.
  wind::ground::DrivingWind step() {
    now_ += from_seconds(kTick_s);
    for (std::size_t source = 0; source < source_count_ && tick_ % ticks_a_reading_ == 0; ++source) {
      estimator_.accept(source, reading(source));
    }
    ++tick_;
    const wind::State state = estimator_.advance(now_);
    wind::ground::DrivingWind wind{state, estimator_.ground(), estimator_.stroke()};
    wind.ground.tick = static_cast<std::uint64_t>(tick_);
    return wind;
  }

 private:
  static wind::blend::Settings settings(std::vector<wind::blend::SourceSettings> sources) {
    wind::blend::Settings settings;
    settings.sources = std::move(sources);
    return settings;
  }
  wind::Reading reading(std::size_t source) const {
    // A sine in each octave from 0.02 to 2.6 Hz, weaker by k^(-1/3); other sources have other phases.
    wind::Vector wind = mean_;
    for (int octave = 0; octave < 8; ++octave) {
      const double phase_rad = 0.04 * std::numbers::pi * std::exp2(octave) * kTick_s * static_cast<double>(tick_) +
                               2.4 * octave + static_cast<double>(source);
      const double height_m_s = 0.08 * speed_of(mean_) * std::exp2(-octave / 3.0);
      wind = wind + height_m_s * wind::Vector{std::sin(phase_rad), std::cos(1.3 * phase_rad)};
    }
    wind::Reading reading;
    reading.time.mono = now_;
    reading.speed_m_s = speed_of(wind);
    reading.direction_deg = wind::direction_from_deg(wind);
    return reading;
  }

  wind::Vector mean_;
  std::size_t source_count_;
  int ticks_a_reading_;
  wind::blend::BlendedEstimator estimator_;
  MonoTime now_{std::chrono::hours(1)};
  int tick_ = 0;
};

}  // namespace yuragi
