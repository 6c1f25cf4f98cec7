#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/parameter.hpp"
#include "engine/pose/kinematics.hpp"
#include "engine/pose/skeleton.hpp"
#include "tests/answer/figures.hpp"
#include "tests/answer/series.hpp"
#include "tests/answer/wind_record.hpp"

namespace yuragi::answer {

/// A series to be drawn.
struct Trace {
  std::string name, unit;
  Series values;  ///< one a tick
};

/// What looks at a scene while it is recorded, and says afterwards how it has moved. It is given poses, and joints that
/// come from them by the one forward kinematics, and knows nothing else of how the scene works.
class Meter {
 public:
  virtual ~Meter() = default;

  /// Are the joints asked for at this tick? Those of a tree cost as much as its motion.
  virtual bool needs_joints(std::size_t /*tick*/) const { return true; }

  virtual void take(std::size_t tick, const pose::Pose& pose, const pose::Kinematics& joints) = 0;

  /// Where the scene is bent to at this moment, east and south: of any length.
  virtual Horizontal direction(const pose::Pose& pose, const pose::Kinematics& joints) const = 0;

  virtual Figures figures(const WindRecord& wind) const = 0;
  virtual std::vector<Trace> traces(const WindRecord& wind) const = 0;

  /// How far a joint that is followed has moved at most in a tick.
  virtual double largest_step_m() const = 0;
};

/// A table: a kind of scene, how it is made for the record, and what its figures may be.
struct SceneTable {
  std::string_view name;
  std::string_view scene;           ///< in scene_table()
  ParameterValues::Map parameters;  ///< that differ from the defaults: only how finely it is drawn, or its kind
  std::vector<Bound> bounds;
  std::unique_ptr<Meter> (*make_meter)(const pose::Skeleton& skeleton);
  /// Figures of records of their own (a step to calm, say), by Beaufort number; none: null.
  std::array<Figures, kBeauforts> (*further)(const SceneTable& table, std::uint64_t seed) = nullptr;
  /// Adds to the figures of a Beaufort number, further ones among them, what follows from several; none: null.
  void (*derive)(Figures& figures) = nullptr;
  /// How far from downwind it may point; 0: its direction is not asked for.
  double largest_turn_deg = 15.0;
  /// How much of the wind along east it gives way to: less than 1 for what hangs along a rail from west to east.
  double gives_way_along_east = 1.0;
};

/// All tables.
const std::vector<SceneTable>& scene_tables();

// One a file.
SceneTable flag_table();
SceneTable curtain_table();
SceneTable banner_table();
SceneTable tree_table();
SceneTable zelkova_table();
SceneTable poplar_table();
SceneTable grass_table();
SceneTable short_grass_table();
SceneTable tall_grass_table();
SceneTable fur_table();
SceneTable flame_table();
SceneTable ripple_table();

}  // namespace yuragi::answer
