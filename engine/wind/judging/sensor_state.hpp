#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace yuragi::wind::judging {

/// The state of a sensor, one word for a person. The stream (pose.fbs) has the same in the same order.
enum class SensorState : std::uint8_t {
  kConnecting,    ///< its device is searched for, or has sent no reading yet
  kLive,          ///< readings arrive and are accepted
  kStale,         ///< its device is connected, but silent for longer than its own interval explains
  kFrozen,        ///< its value does not change
  kSeized,        ///< it reads 0 for hours in a wind
  kImplausible,   ///< many impossible readings, or it contradicts the other sensors
  kDisconnected,  ///< it sent readings, and its device is disconnected
  kSimulated,     ///< as live, but a simulation
  kReplayed,      ///< as live, but a recording
};
inline constexpr std::array<std::string_view, 9> kSensorStateNames = {
    "connecting", "live", "stale", "frozen", "seized", "implausible", "disconnected", "simulated", "replayed"};

constexpr std::string_view name_of(SensorState state) {
  const auto number = static_cast<std::size_t>(state);
  return number < kSensorStateNames.size() ? kSensorStateNames[number] : "?";
}

/// Are the sensor's readings used for the wind?
constexpr bool is_believed(SensorState state) {
  return state == SensorState::kLive || state == SensorState::kSimulated || state == SensorState::kReplayed;
}

}  // namespace yuragi::wind::judging
