#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "daemon/animation/animation.hpp"
#include "daemon/sensing/recorded_installation.hpp"
#include "daemon/settings/config.hpp"
#include "drivers/windlog/windlog_player.hpp"

namespace yuragi::daemon::tools::offline {

/// The result of a replay through estimator and scenes.
struct LockstepResult {
  std::uint64_t readings = 0;
  std::uint64_t ticks = 0;
  double log_duration_s = 0.0;
  double reading_mean_m_s = 0.0;  ///< of the readings, as recorded
  double reading_max_m_s = 0.0;
  double wind_mean_m_s = 0.0;  ///< of the wind that moved the scenes, from the first live reading on
  double wind_max_m_s = 0.0;
  std::uint64_t live_ticks = 0;       ///< whose wind was live: those of the means
  std::uint64_t held_back_ticks = 0;  ///< of these, in which the ceiling held the wind back
  double free_wind_mean_m_s = 0.0;    ///< of the wind before the ceiling, over the same ticks as wind_mean_m_s
  double free_wind_max_m_s = 0.0;
  std::uint64_t pose_hash = 0;  ///< over every pose of every tick: the same seed, log and build give the same hash
};

/// A tick of a replay, when its poses have been made.
struct ReplayTick {
  double log_time_s = 0.0;  ///< since the replay began
  UtcTime recorded{};       ///< what the recording's clock showed
  double left_s = 0.0;      ///< log time until the recording's last reading; of a loop, of this round
  const wind::State& wind;
  animation::Animation& animation;
};

/// Called at the end of each tick. What it throws ends the replay.
using UseTick = std::function<void(const ReplayTick& tick)>;

/// Replays in log time, tick by tick, with no clock and no thread, so that every run of the same seed and recording
/// gives the same poses, bit for bit. Log time is that of the playback at rate 1, loops and their seams included.
/// `progress` is called about once a second of work with the log time reached; it can be empty, and so may `use`. Ends
/// after `duration_s` of log time, if above 0. Log time begins where the replay was to begin: in the seconds before, of
/// `options.lead_s`, scenes live in the wind, and neither `use` nor the result sees them. Fails if the recording cannot
/// be read.
///
/// With `states_folder` the poses are those of a replay from the recording's beginning, bit for bit, wherever this one
/// begins: all before is led in. The scenes' states are kept in that folder (KeptStates), so that the scenes need not
/// be stepped from the beginning again; the wind, which costs little, is. Not of a loop. Fails, too, if the folder
/// cannot be written.
Result<LockstepResult, Failure> replay_in_lockstep(const settings::Config& config,
                                                   const std::filesystem::path& recording,
                                                   drivers::windlog::PlayerOptions options, double duration_s,
                                                   const std::function<void(double log_time_s)>& progress,
                                                   const UseTick& use = {},
                                                   const std::filesystem::path& states_folder = {});

/// The same of an installation as it was recorded, with a lead-in of `lead_s`: through the daemon's own SensorHub
/// (calibration, judging, vote, blend) and WindShaper (opening hours by the recorded clock). `result.readings` are
/// those of all sensors before judging.
Result<LockstepResult, Failure> replay_in_lockstep(const sensing::RecordedInstallation& installation, double lead_s,
                                                   double duration_s,
                                                   const std::function<void(double log_time_s)>& progress,
                                                   const UseTick& use = {});

}  // namespace yuragi::daemon::tools::offline
