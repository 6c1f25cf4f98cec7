#pragma once

#include <string>

#include "engine/wire/schema.hpp"
#include "engine/wire/wire.hpp"

// Internal: between decode.cpp, decode_models.cpp and parameter_tables.cpp. Each returns false if the values contradict
// each other or are no numbers.

namespace yuragi::wire {

/// False for NaN.
inline bool is_within(double value, double low, double high) {
  return value >= low && value <= high;
}

/// A text of at most kMaxTextBytes, made printable.
bool read_text(const flatbuffers::String* from, std::string& to);

/// A scene's skeleton, in padded arrays. Of an unknown kind: strands, none of them.
bool read_scene(const fb::Scene& from, SceneModel& to);

/// A scene's pose, in padded arrays. Of an unknown kind, or left out since it is hidden: strands, none of them.
bool read_pose(const fb::ScenePose& from, pose::Pose& pose, float& opacity);

bool read_parameters(const fb::ParameterCommand& from, ParameterCommand& to);
bool read_parameters(const fb::ParameterReport& from, ParameterReport& to);

/// How many strands, joints of cloth and points of surfaces it has, padding included: what kMaxStrands limits.
std::size_t room_of(const pose::Skeleton& skeleton);
std::size_t room_of(const pose::Pose& pose);

/// What padding may add to kMaxStrands.
inline constexpr std::size_t kMaxPadding = kMaxScenes * pose::kMaxTreeLevels * pose::kStrandsPerBlock;

}  // namespace yuragi::wire
