#include "daemon/sensing/sensor_status.hpp"

namespace yuragi {

wire::SensorStatus status_of(const SensorConfig& sensor, const LinkReport& link, const SourceReport& said) {
  wire::SensorStatus status;
  status.name = sensor.name;
  status.driver = sensor.driver->name;
  status.link = link.state;
  status.health = said.health;
  status.detail = link.detail;
  if (said.last) {
    status.speed_m_s = said.last->speed_m_s;
    status.direction_deg = said.last->direction_deg;
    status.gust_m_s = said.last->gust_m_s;
    status.simulated = said.last->quality == ReadingQuality::kSimulated;
  }
  status.age_s = said.age_s;
  status.interval_s = said.interval_s;
  status.replayed = sensor.driver->plays_recordings;
  return status;
}

void add_counts(wire::SensorStatus& status, const SensorRunner& runner, std::uint64_t not_believed) {
  for (std::size_t why = 0; why < kRefusalCount; ++why) {
    const auto refusal = static_cast<Refusal>(why);
    if (const std::uint64_t count = runner.refused_count(refusal)) status.refused.emplace_back(name_of(refusal), count);
  }
  if (not_believed > 0) status.refused.emplace_back("not believed", not_believed);
  if (const std::uint64_t lost = runner.lost_count()) status.refused.emplace_back("lost", lost);
  status.frames = runner.frame_count();
  status.reconnects = runner.reconnect_count();
}

}  // namespace yuragi
