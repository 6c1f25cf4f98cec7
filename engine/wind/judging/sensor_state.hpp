#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace yuragi {

/// How a sensor is, in one word for a person. The stream (pose.fbs) has the same in the same order.
enum class SensorState : std::uint8_t {
  kConnecting,    ///< its device is looked for, or has not said a reading yet
  kLive,          ///< it speaks, and is believed
  kStale,         ///< its device is there, but silent for longer than its own interval explains
  kFrozen,        ///< it says exactly the same again and again
  kSeized,        ///< it stands still for hours where a wind blows
  kImplausible,   ///< it says what cannot be, again and again, or what the other sensors deny
  kDisconnected,  ///< it spoke, and its device has gone
  kSimulated,     ///< as live, but a simulation
  kReplayed,      ///< as live, but a recording
};
inline constexpr std::array<std::string_view, 9> kSensorStateNames = {
    "connecting", "live", "stale", "frozen", "seized", "implausible", "disconnected", "simulated", "replayed"};

constexpr std::string_view name_of(SensorState state) {
  const auto number = static_cast<std::size_t>(state);
  return number < kSensorStateNames.size() ? kSensorStateNames[number] : "?";
}

/// Does what the sensor says make the wind?
constexpr bool is_believed(SensorState state) {
  return state == SensorState::kLive || state == SensorState::kSimulated || state == SensorState::kReplayed;
}

}  // namespace yuragi
