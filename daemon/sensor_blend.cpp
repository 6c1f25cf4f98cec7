#include "daemon/sensor_blend.hpp"

#include <array>

namespace yuragi {
namespace {

constexpr std::string_view kOfDriver = "auto";
constexpr std::string_view kRelative = "relative";
constexpr std::array<std::string_view, 3> kRoles = {kOfDriver, "absolute", kRelative};

const std::array kSensorBlendParameters = {
    Parameter{.name = "role",
              .unit = "",
              .default_value = std::string(kOfDriver),
              .help =
                  "relative: only its rise and fall is believed; it gives the gusts that the absolute sensors are too "
                  "slow for, as strong as theirs. auto: a microphone is relative, all else absolute",
              .choices = kRoles},
    Parameter{
        .name = "priority",
        .unit = "",
        .default_value = std::int64_t{0},
        .min = 0,
        .max = 1000,
        .help = "the lowest of those that speak has the word, equal ones share it; 0: its place in the file, from 1"},
    Parameter{.name = "weight",
              .unit = "",
              .default_value = 1.0,
              .min = 0.01,
              .max = 100.0,
              .help = "how much it counts among those of the same priority"},
    Parameter{.name = "x",
              .unit = "m",
              .default_value = 0.0,
              .min = -1000.0,
              .max = 1000.0,
              .help = "where it stands, to the east: between sensors of the same priority the wind is interpolated"},
    Parameter{.name = "z", .unit = "m", .default_value = 0.0, .min = -1000.0, .max = 1000.0, .help = "to the south"},
    Parameter{.name = "averaging",
              .unit = "s",
              .default_value = 0.0,
              .min = 0.0,
              .max = 3600.0,
              .help = "each reading is a mean over so long; 0: over the time between two, which is measured"},
    Parameter{.name = "direction_step",
              .unit = "deg",
              .default_value = 0.0,
              .min = 0.0,
              .max = 90.0,
              .help = "of a vane that knows few directions (16: 22.5, 8: 45); 0: found out from its readings"},
};

}  // namespace

std::span<const Parameter> sensor_blend_parameters() {
  return kSensorBlendParameters;
}

ParameterValues default_sensor_blend() {
  return ParameterValues::resolve(kSensorBlendParameters, {}).value();
}

BlendSourceSettings blend_source_of(const ParameterValues& values, const DriverDescription& driver) {
  const std::string& role = values.text("role");
  return {.is_relative = role == kRelative || (role == kOfDriver && driver.is_relative),
          .priority = static_cast<int>(values.integer("priority")),
          .weight = values.number("weight"),
          .east_m = values.number("x"),
          .south_m = values.number("z"),
          .averaging_s = values.number("averaging"),
          .direction_step_deg = values.number("direction_step")};
}

}  // namespace yuragi
