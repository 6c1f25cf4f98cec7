#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/sensor/sensor.hpp"
#include "engine/wind/judging/reading_judge.hpp"
#include "engine/wind/judging/sensor_state.hpp"
#include "engine/wind/judging/sensor_vote.hpp"
#include "engine/wind/source_report.hpp"

namespace yuragi {

/// Everything that is known of how a sensor does, at one moment.
struct SensorEvidence {
  LinkState link = LinkState::kConnecting;
  std::string_view link_detail;              ///< the last thing that happened to the link
  SourceReport report;                       ///< of all its readings, believed or not
  bool is_replay = false;                    ///< its driver plays recordings
  ReadingFault fault = ReadingFault::kNone;  ///< what the judge holds of its readings
  Vote vote = Vote::kNone;                   ///< what the other sensors do

  // What the reasons tell.
  std::size_t same_count = 0;
  double same_for_s = 0.0;
  double still_for_s = 0.0;
  double bad_share = 0.0;
  double mean_m_s = 0.0;  ///< over some minutes; of the others, too
  std::optional<double> others_m_s{};
};

/// The one state that the evidence comes to. A device that has gone outweighs what it said before; a silent one is not
/// judged by its last words; what is wrong outweighs where it comes from. Pure.
SensorState state_of(const SensorEvidence& evidence);

/// Why it is in this state and what to do about it, for a person to read. Pure.
std::string reason_of(SensorState state, const SensorEvidence& evidence);

}  // namespace yuragi
