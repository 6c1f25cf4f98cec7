#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/sensor/sensor.hpp"
#include "engine/wind/judging/quantity_watch.hpp"
#include "engine/wind/judging/reading_judge.hpp"
#include "engine/wind/judging/sensor_state.hpp"
#include "engine/wind/judging/sensor_vote.hpp"
#include "engine/wind/source_report.hpp"

namespace yuragi::daemon::sensing {

/// The facts from which a sensor's state is derived, at one moment.
struct SensorEvidence {
  wind::LinkState link = wind::LinkState::kConnecting;
  std::string_view link_detail;                                            ///< the last event of the link
  wind::SourceReport report;                                               ///< of all its readings, believed or not
  bool is_replay = false;                                                  ///< its driver plays recordings
  wind::judging::ReadingFault fault = wind::judging::ReadingFault::kNone;  ///< the judge's finding
  wind::judging::Vote vote = wind::judging::Vote::kNone;  ///< the result of comparing it with other sensors

  bool makes_wind = true;  ///< wind::makes_wind() of what its speeds are

  // Figures for reason_of().
  std::size_t same_count = 0;
  double same_for_s = 0.0;
  double still_for_s = 0.0;
  double bad_share = 0.0;
  double mean_m_s = 0.0;  ///< mean over some minutes; likewise others_m_s
  std::optional<double> others_m_s{};
  double reads_times_group = 1.0;  ///< SensorJury::reads_times_group()
  bool is_levelled_at_most = false;
};

/// What replaces a missing direction.
enum class DirectionStandIn : std::uint8_t {
  kOtherSensor,  ///< another sensor's
  kLast,         ///< the last one of this sensor
  kConfigured,   ///< the default of the configuration
};

/// Why a quantity is missing, for a person: since when, its replacement, and what to do. `age_s`: of the last one;
/// nullopt: never received. Pure.
std::string missing_text(wind::judging::Quantity quantity, std::optional<double> age_s, DirectionStandIn stand_in);

/// The state. While readings arrive, a fault takes precedence over the kind of source (simulated, replayed). Once they
/// are stale, a lost link takes precedence over faults, and only implausible readings count as one. A station that has
/// sent one reading is not stale before two minutes: its interval is not known yet. Pure.
wind::judging::SensorState state_of(const SensorEvidence& evidence);

/// Why it is in this state and what to do about it, for a person. Pure.
std::string reason_of(wind::judging::SensorState state, const SensorEvidence& evidence);

}  // namespace yuragi::daemon::sensing
