#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/operators/cloth_dynamics.hpp"
#include "engine/operators/cloth_projection_job.hpp"
#include "engine/operators/cloth_spline.hpp"
#include "engine/operators/propagation_history.hpp"
#include "engine/pose/skeleton.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi {

/// A cloth as it hangs at rest: the joints of its fixed edge, in the world, and how the thread from each leans. All
/// vectors have a value a column, whole blocks of them.
struct ClothEdge {
  explicit ClothEdge(std::size_t columns);

  std::size_t columns;  ///< of the cloth, without padding
  std::vector<float> x_m, y_m, z_m;
  std::vector<float> lean_east, lean_south;  ///< lean.hpp

  std::size_t stride() const { return x_m.size(); }
};

/// What is the same for all of a cloth.
struct ClothSpec {
  std::size_t rows = 150;  ///< of joints, 2 or more
  double length_m = 2.0;   ///< of a thread
  bool is_first_column_fixed = false;
  double travel_time_s = 1.0;      ///< of the noise, from the fixed edge to the free one
  double growth_exponent = 1.0;    ///< it grows as the way from the fixed edge to this power
  double quickness_rad_s = 8.0;    ///< how soon the cloth follows: FollowJob's omega
  double largest_sway = 0.0;       ///< the longest lean that sway() will ever hold
  double largest_wave = 0.0;       ///< and wave()
  double hybrid = 0.0;             ///< 0: the noise alone, bit for bit; 1: dynamics, with the noise as detail
  double normal_drag_per_m = 0.4;  ///< ClothDynamicsJob's, like the next
  double skin_drag_per_m = 0.02;
  double across_stiffness_s2 = 2000.0;
};

/// A cloth that sways as a whole and that noise runs along, from the fixed edge to the free one: the paper's 2-D links
/// (Chiba, section 3.2). A scene says what the wind makes of each column, and the cloth projects it:
///
///   follow     sway and wave have inertia                                      FollowJob
///   propagate  the wave's history runs along the links, growing, on the sway   PropagationJob
///   project    links turn by their lean, and add up to offsets                 ClothProjectionJob
///
/// And where `hybrid` is above 0, a coarse cloth moves as weight, inertia and air have it (ClothDynamicsJob); its leans
/// (ClothSplineJob) take the place of the sway, and the wave stays as fine detail.
///
/// Targets of 0 from the start give exactly the rest pose. Allocates when it is made. Thread-safe: no. Realtime-safe:
/// project(), yes.
class Cloth {
 public:
  Cloth(const ClothSpec& spec, const ClothEdge& edge, SimdRow row);

  const Skeleton& skeleton() const noexcept { return skeleton_; }
  const Pose& pose() const noexcept { return pose_; }

  /// Where each column shall lean to beyond rest: east of all columns, then south, 2 * stride values each. `sway` is
  /// for a whole thread at once, `wave` starts at the fixed edge and runs along it.
  std::span<float> sway() noexcept { return std::span(target_).first(target_.size() / 2); }
  std::span<float> wave() noexcept { return std::span(target_).last(target_.size() / 2); }

  /// The air that the hybrid's cloth is in, m/s: the wind, stronger or weaker and from a little aside where `gusts` (a
  /// value a column, -1 to 1) are. Does nothing where hybrid is 0.
  void blow(double wind_east_m_s, double wind_south_m_s, std::span<const float> gusts) noexcept;

  /// Goes on by dt_s toward sway() and wave(), and in the air.
  void project(double dt_s) noexcept;

  /// Derived in cloth.cpp.
  double largest_joint_step_m(double dt_s) const noexcept;

 private:
  ClothSpec spec_;
  SimdRow row_;
  ClothThreads threads_;
  std::vector<float> growth_;        ///< of the noise, for each link
  std::vector<float> target_;        ///< sway, then wave
  std::vector<float> value_, rate_;  ///< what follows them
  PropagationHistory history_;
  std::vector<float> base_;  ///< of the leans: rest and sway
  std::vector<float> lean_;  ///< of a band of links
  CoarseCloth coarse_;
  ClothSpline spline_;
  std::vector<float> air_east_m_s_, air_south_m_s_;
  Pose pose_;
  Skeleton skeleton_;
};

/// A place or direction of a scene's own, in metres east and south of its origin, turned by its heading.
struct Turned {
  double east;
  double south;
};
Turned turned(const ScenePlacement& placement, double east, double south) noexcept;

/// The lean of a link that is turned by so much from straight down.
double lean_of_deg(double angle_deg) noexcept;

/// The drag that holds a hanging cloth half way up, at 45 degrees, in a wind of this speed.
double drag_per_m(double half_speed_m_s) noexcept;

}  // namespace yuragi
