#pragma once

#include <span>
#include <string_view>

#include "engine/base/parameter.hpp"

namespace yuragi {

// What a configuration may hold besides what drivers and scenes hold of their own: every key with its unit, range,
// default and help.

/// The tables of the file that are there once, with what each may hold.
struct ConfigTable {
  std::string_view name;
  std::string_view summary;
  std::span<const Parameter> parameters;
};
std::span<const ConfigTable> config_tables();

std::span<const Parameter> general_parameters();  ///< at the top of the file
std::span<const Parameter> stream_parameters();
std::span<const Parameter> animation_parameters();
std::span<const Parameter> wind_parameters();

/// What the tables [sensor.calibration] and [sensor.judge] of a sensor may hold.
std::span<const Parameter> calibration_parameters();
std::span<const Parameter> judge_parameters();

/// What a scene of any kind may hold besides: where it stands, its gain, whether it is shown.
std::span<const Parameter> common_scene_parameters();

}  // namespace yuragi
