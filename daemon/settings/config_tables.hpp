#pragma once

#include <span>
#include <string_view>

#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings {

// The keys of a configuration, except those of drivers and scenes, each with unit, range, default and help.

/// A table that occurs once in the file, with its keys.
struct ConfigTable {
  std::string_view name;
  std::string_view summary;
  std::span<const Parameter> parameters;
};
std::span<const ConfigTable> config_tables();

std::span<const Parameter> general_parameters();  ///< at the top of the file
std::span<const Parameter> stream_parameters();
std::span<const Parameter> http_parameters();
std::span<const Parameter> recording_parameters();
std::span<const Parameter> animation_parameters();
std::span<const Parameter> wind_parameters();
std::span<const Parameter> log_parameters();

/// The keys of [sensor.calibration] and of [sensor.judge].
std::span<const Parameter> calibration_parameters();
std::span<const Parameter> judge_parameters();

/// The keys that scenes of every kind have: place, gain, whether it is shown.
std::span<const Parameter> common_scene_parameters();

}  // namespace yuragi::daemon::settings
