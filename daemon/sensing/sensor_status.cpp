#include "daemon/sensing/sensor_status.hpp"

#include <cstddef>

namespace yuragi::daemon::sensing {
namespace {

/// The part of a status that sensors and the fall-back share.
wire::SensorStatus status_of_source(std::string_view name, std::string_view driver, wind::LinkState link,
                                    const wind::SourceReport& report) {
  wire::SensorStatus status;
  status.name = name;
  status.driver = driver;
  status.link = link;
  status.health = report.health;
  if (report.last) {
    status.speed_m_s = report.last->speed_m_s;
    status.direction_deg = report.last->direction_deg;
    status.gust_m_s = report.last->gust_m_s;
    status.simulated = report.last->quality == wind::ReadingQuality::kSimulated;
  }
  status.age_s = report.age_s;
  status.interval_s = report.interval_s;
  return status;
}

}  // namespace

wire::SensorStatus sensor_status(const SensorFacts& facts) {
  const SensorEvidence& evidence = facts.evidence;
  wire::SensorStatus status = status_of_source(facts.name, facts.driver, evidence.link, evidence.report);
  status.detail = evidence.link_detail;
  if (facts.last_raw) {
    status.raw_speed_m_s = facts.last_raw->speed_m_s;
    status.raw_direction_deg = facts.last_raw->direction_deg;
  }
  const SensorCounts& counts = facts.counts;
  status.readings = counts.readings;
  const auto add_refused = [&status](std::string_view why, std::uint64_t count) {
    if (count > 0) status.refused.emplace_back(why, count);
  };
  for (std::size_t why = 0; why < drivers::decode::kRefusalCount; ++why) {
    add_refused(name_of(static_cast<drivers::decode::Refusal>(why)), counts.refused[why]);
  }
  add_refused("rejected", counts.not_believed);
  add_refused("lost", counts.lost);
  status.frames = counts.frames;
  status.reconnects = counts.reconnects;
  status.replayed = evidence.is_replay;
  status.state = state_of(evidence);
  status.state_reason = reason_of(status.state, evidence);
  status.quantities = facts.quantities;
  status.value = facts.value;
  status.reads_times_group = evidence.reads_times_group;
  return status;
}

wire::SensorStatus fallback_status(std::string_view name, std::string_view driver, const LinkReport& link,
                                   const wind::SourceReport& report, std::uint64_t readings) {
  wire::SensorStatus status = status_of_source(name, driver, link.state, report);
  status.detail = "all sensors are silent: " + link.detail;
  status.readings = readings;
  status.replayed = true;
  status.state = report.health == wind::SourceHealth::kLive ? wind::judging::SensorState::kReplayed
                                                            : wind::judging::SensorState::kConnecting;
  status.state_reason = status.detail;
  return status;
}

}  // namespace yuragi::daemon::sensing
