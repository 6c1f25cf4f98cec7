#pragma once

#include <cstdint>
#include <memory>

#include "engine/wind/blend/blended_estimator.hpp"
#include "tests/support/scripted_wind.hpp"

namespace yuragi {

/// The noise of its gusts.
inline const std::shared_ptr<const wind::turbulence::GustNoise>& station_gusts() {
  static const auto kGusts = std::make_shared<const wind::turbulence::GustNoise>(
      wind::turbulence::GustNoiseSettings{.samples = 128, .seed = 3, .evolves = true});
  return kGusts;
}

/// The wind of a station that reads the scripted wind once a second, as the daemon makes it: with gusts over the
/// ground.
class StationWind {
 public:
  static constexpr double kTick_s = 1.0 / 60.0;

  explicit StationWind(SimdRow row) : estimator_(1, settings(), station_gusts()), tapes_(1, row) {}

  wind::ground::Wind at(std::uint64_t tick) {
    const MonoTime now(from_seconds(static_cast<double>(tick) * kTick_s));
    if (tick % 60 == 0) {
      const wind::Vector wind = scripted_wind(tick);
      wind::Reading reading;
      reading.speed_m_s = wind::speed_of(wind);
      reading.direction_deg = wind::direction_from_deg(wind);
      reading.time.mono = now;
      estimator_.accept(0, reading);
    }
    wind::ground::DrivingWind driving;
    driving.state = estimator_.advance(now);
    driving.ground = estimator_.ground();
    driving.stroke = estimator_.stroke();
    driving.ground.tick = tick;
    return written_to(tapes_, driving);
  }

 private:
  static wind::blend::Settings settings() {
    wind::blend::Settings settings;
    settings.gustiness = 0.3;
    settings.reach_m = 10.0;
    return settings;
  }

  wind::blend::BlendedEstimator estimator_;
  wind::ground::WindTapes tapes_;
};

}  // namespace yuragi
