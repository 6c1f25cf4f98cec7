#pragma once

#include <string>

#include "engine/wire/schema.hpp"
#include "engine/wire/wire.hpp"

// Internal: between decode.cpp, decode_models.cpp and parameter_tables.cpp. Each returns false if the values contradict
// each other or are not numbers.

namespace yuragi::wire {

/// False for NaN.
inline bool is_within(double value, double low, double high) {
  return value >= low && value <= high;
}

/// A text of at most kMaxTextBytes, made printable.
bool read_text(const flatbuffers::String* from, std::string& to);

/// A scene's skeleton, in padded arrays. An unknown kind becomes zero strands.
bool read_scene(const fb::Scene& from, SceneModel& to);

/// A scene's pose, in padded arrays. An unknown kind, or a hidden scene's omitted pose, becomes zero strands.
bool read_pose(const fb::ScenePose& from, pose::Pose& pose, float& opacity);

bool read_parameters(const fb::ParameterCommand& from, ParameterCommand& to);
bool read_parameters(const fb::ParameterReport& from, ParameterReport& to);

/// The number of strands, joints of cloth and points of surfaces, including padding, which kMaxStrands limits.
std::size_t room_of(const pose::Skeleton& skeleton);
std::size_t room_of(const pose::Pose& pose);

/// The maximum padding beyond kMaxStrands.
inline constexpr std::size_t kMaxPadding = kMaxScenes * pose::kMaxTreeLevels * pose::kStrandsPerBlock;

}  // namespace yuragi::wire
