#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"

namespace yuragi::daemon::settings {

/// More than any installation needs.
inline constexpr std::size_t kMaxAlerts = 64;

/// The condition of an [[alert]].
enum class AlertCondition : std::uint8_t {
  kSensorSilent,  ///< a sensor's readings are not used, for any reason
  kWindAbove,     ///< the wind that the sensors make together, before it is shaped for the scenes
  kDiskBelow,     ///< the free space on the disk of the recording
  kNoFrame,       ///< the animation has made no frame
  kNotRecording,  ///< readings are to be recorded, and cannot be written
};
inline constexpr std::array<std::string_view, 5> kAlertConditionNames = {"sensor_silent", "wind_above", "disk_below",
                                                                         "no_frame", "not_recording"};

/// An [[alert]]: what is reported, when, and how. Its beginning is reported once and its end once.
struct AlertConfig {
  std::string name;
  ParameterValues values{};  ///< of alert_parameters(), from which the members below were made
  AlertCondition when = AlertCondition::kSensorSilent;
  std::string sensor = {};   ///< kSensorSilent: the sensor's name; empty: each one by itself
  double speed_m_s = 0.0;    ///< kWindAbove
  double free_bytes = 0.0;   ///< kDiskBelow
  double after_s = 0.0;      ///< it begins when the condition has lasted this long
  double end_after_s = 0.0;  ///< it ends when the condition has been absent this long
  std::string command = {};  ///< for /bin/sh; empty: none
  Secret webhook = {};       ///< http or https; empty: none
};

/// The keys of an [[alert]], except for its name.
std::span<const Parameter> alert_parameters();

/// From values of alert_parameters(). An error names the key.
Result<AlertConfig, ParameterError> alert_config_of(std::string name, const ParameterValues& values);

}  // namespace yuragi::daemon::settings
