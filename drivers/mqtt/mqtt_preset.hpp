#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "drivers/mqtt/mqtt_payload.hpp"
#include "engine/wind/station_quantities.hpp"

namespace yuragi::drivers::mqtt {

/// One place in the messages of a publisher where a quantity can stand.
struct PresetPlace {
  std::string_view pointer;  ///< a JSON pointer
  std::string_view unit;     ///< of a speed, by its key; empty: as in Preset::unit
};

/// What is known of a publisher: where its messages have the wind, and in which unit. Of several places for one
/// quantity the first that a message has counts.
struct Preset {
  std::string_view name;
  std::string_view topic;  ///< empty: it is up to the user
  std::span<const PresetPlace> speed = {};
  std::span<const PresetPlace> direction = {};
  std::span<const PresetPlace> gust = {};
  std::string_view unit;               ///< of speed and gust, if neither their key nor the message has it
  std::string_view unit_pointer = {};  ///< where a message has the unit; empty: nowhere
  bool names_stations = false;         ///< a message names which of several stations sent it (StationIdentity)
  /// Returns the other quantities in a message; nullptr: none are known.
  std::optional<wind::StationQuantities> (*quantities)(const Payload& payload) = nullptr;
};

inline constexpr std::array<std::string_view, 4> kMqttPresetNames = {"number", "tasmota", "rtl_433", "windnerd"};

/// The preset of one of kMqttPresetNames.
const Preset& mqtt_preset_of(std::string_view name) noexcept;

/// The one of sensor::kSpeedUnitNames that publishers write so: mi/h for mph, kt for kn, and the like; empty for any
/// other word. Thread-safe and realtime-safe: yes.
std::string_view speed_unit_of_word(std::string_view word) noexcept;

}  // namespace yuragi::drivers::mqtt
