#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/settings/config.hpp"
#include "drivers/windlog/windlog_player.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::sensing {

/// An installation as a session of a recording describes it.
struct RecordedInstallation {
  settings::Config config;
  UtcTime begin{};                   ///< what its clock showed where the replay begins
  std::vector<std::string> remarks;  ///< sentences for the log: differences from the recorded installation
};

/// Reads the configuration of the session in which the replay begins. Each of its sensors is played from the recording
/// by its own name, with its own calibration, judging and place in the blend; one without a reading from there on is
/// silent. What was outside the recording is left out: the fall-back recording, and the file of the site's wind.
/// `options`: where it begins, rate, seam, paused; it neither loops nor begins at a time of day.
///
/// Fails if the recording cannot be read, or its session holds no configuration, as one that was imported. Throws
/// ConfigError if this version does not understand the configuration; each line names a key.
Result<RecordedInstallation, Failure> recorded_installation(const std::filesystem::path& recording,
                                                            const drivers::windlog::PlayerOptions& options);

}  // namespace yuragi::daemon::sensing
