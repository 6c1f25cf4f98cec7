#include "daemon/web/wind_memory.hpp"

#include "engine/wind/judging/sensor_state.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::web {

std::optional<double> measured_speed_m_s(const wire::Sensors& sensors) {
  using wind::judging::SensorState;
  for (const SensorState state : {SensorState::kLive, SensorState::kReplayed, SensorState::kSimulated}) {
    for (const wire::SensorStatus& sensor : sensors.sensors) {
      if (sensor.state == state && sensor.speed_m_s) return sensor.speed_m_s;
    }
  }
  return std::nullopt;
}

void WindMemory::add(double mono_s, const wire::Sensors& sensors) {
  // A little less, so that a status each second is not kept every other second only.
  if (!moments_.empty() && mono_s - moments_.back().mono_s < 0.9 * kInterval_s) return;
  moments_.push_back({.mono_s = mono_s,
                      .measured_m_s = measured_speed_m_s(sensors),
                      .blended_m_s = speed_of(sensors.wind.wind),
                      .noise_share = 1.0 - sensors.wind.live_weight});
  while (mono_s - moments_.front().mono_s > kLength_s) moments_.pop_front();
}

}  // namespace yuragi::daemon::web
