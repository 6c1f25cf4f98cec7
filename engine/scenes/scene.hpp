#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "engine/base/parameter.hpp"
#include "engine/base/part.hpp"
#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/pose/skeleton.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::scenes {

/// The limit of the wind that moves scenes. (The strongest gust of a typhoon over a town is about 70 m/s, and all
/// scenes are saturated long before.)
inline constexpr double kStrongestSceneWind_m_s = 60.0;

/// Something that the wind moves: a model, and the three kinds of operator that move it, in the paper's order (Chiba,
/// section 2-2): shift the noise, sample it, project it onto the skeleton.
///
/// Thread-safe: no. Realtime-safe: a tick neither allocates nor locks nor throws.
class Scene {
 public:
  virtual ~Scene() = default;

  /// Advances by dt_s (above 0) under `wind` (finite).
  void tick(const wind::ground::Wind& wind, double dt_s) noexcept {
    shift(wind, dt_s);
    sample();
    project(dt_s);
  }

  // The three steps of a tick, in this order, one by one: for benchmarks, and for work that threads share.
  virtual void shift(const wind::ground::Wind& wind,
                     double dt_s) noexcept = 0;    ///< the wind carries the noise on
  virtual void sample() noexcept = 0;              ///< each element reads it
  virtual void project(double dt_s) noexcept = 0;  ///< and is moved: the pose

  // The same in parts that different threads can run at the same time: all parts of sample, then all of project. The
  // pose is the same, bit for bit. A small scene does everything in its first part.
  virtual void sample_part(Part part) noexcept {
    if (part.index == 0) sample();
  }
  virtual void project_part(Part part, double dt_s) noexcept {
    if (part.index == 0) project(dt_s);
  }

  /// The constant part. Valid for the scene's life.
  virtual const pose::Skeleton& skeleton() const noexcept = 0;

  /// The maximum movement of a joint in one tick of dt_s, for any wind: steps, gaps, turns. The bound is derived in the
  /// scene's file.
  virtual double largest_joint_step_m(double dt_s) const noexcept = 0;

  /// The pose after the last tick; the rest pose before the first.
  virtual const pose::Pose& pose() const noexcept = 0;

  /// The moving state: all that the poses of later ticks depend on, besides what the scene was made of and the wind.
  /// For save_snapshot() and load_snapshot(), with made_of(). A loaded scene keeps its pose until its next tick. The
  /// state is the same on every SIMD row.
  virtual void list_state(StatePass& pass) = 0;
};

/// A scene's placement in the world: its origin, and its north.
struct Placement {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double heading_deg = 0.0;  ///< direction of the scene's north, clockwise from the world's
};

/// Further inputs for making a scene, besides its parameters.
struct Setup {
  std::uint64_t seed = 0;  ///< determines everything random in the model and its noises
  Placement placement = {};
  SimdRow row = best_simd_row();
  /// The gusts of the wind that the scene will be given, shared with all other scenes and with the wind's source.
  /// If null, the wind is uniform, and the scene's own noise varies it from place to place.
  std::shared_ptr<const wind::turbulence::GustNoise> gusts = nullptr;
};

/// A hash of what a scene was made of: its kind, all values, its seed, its place, and the noise of the wind's gusts;
/// not the SIMD row. Of a snapshot it is `made_of`.
std::uint64_t made_of(std::string_view kind, const ParameterValues& values, const Setup& setup);

/// A former parameter of a scene.
struct RetiredParameter {
  std::string_view name;
  std::string_view now;  ///< its replacement, or why nothing is needed: "is now strokes, ..."
};

/// A kind of scene: one constant `kXScene` in its own file, listed in engine/scenes/CMakeLists.txt.
struct Description {
  std::string_view name;
  std::string_view summary;
  std::span<const Parameter> parameters;
  /// Makes the scene, with its model at its place.
  std::unique_ptr<Scene> (*make)(const ParameterValues& values, const Setup& setup);
  /// Calm air from the start keeps it in its rest pose, bit for bit. Fire is not still.
  bool is_still_in_calm = true;
  std::span<const RetiredParameter> retired = {};
};

/// Every kind of scene (generated).
std::span<const Description* const> scene_table();

}  // namespace yuragi::scenes
