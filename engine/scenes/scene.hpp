#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "engine/base/parameter.hpp"
#include "engine/pose/skeleton.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi {

/// Something that the wind moves: a model and the operators that move it (shift, sample, project).
///
/// Thread-safe: no. tick() is realtime-safe: it neither allocates nor locks nor throws.
class Scene {
 public:
  virtual ~Scene() = default;

  /// What never changes. Valid for the scene's life.
  virtual const Skeleton& skeleton() const noexcept = 0;

  /// Goes on by dt_s (above 0) under `wind` (finite).
  virtual void tick(WindVector wind, double dt_s) noexcept = 0;

  /// The pose after the last tick; the rest pose before the first.
  virtual const Pose& pose() const noexcept = 0;
};

/// A kind of scene: one constant `kXScene` in its own file, listed in engine/scenes/CMakeLists.txt.
struct SceneDescription {
  std::string_view name;
  std::string_view summary;
  std::span<const Parameter> parameters;
  /// Lays the model out. Everything random in it comes from `seed`.
  std::unique_ptr<Scene> (*make)(const ParameterValues& values, std::uint64_t seed);
};

/// Every kind of scene (generated).
std::span<const SceneDescription* const> scene_table();

}  // namespace yuragi
