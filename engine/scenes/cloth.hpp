#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/operators/cloth_dynamics.hpp"
#include "engine/operators/cloth_projection_job.hpp"
#include "engine/operators/cloth_spline.hpp"
#include "engine/pose/skeleton.hpp"
#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {

/// A cloth as it hangs at rest: the joints of its fixed edge, in the world, and the lean of the thread from each. All
/// vectors have a value per column, in whole blocks.
struct ClothEdge {
  explicit ClothEdge(std::size_t columns);

  std::size_t columns;  ///< of the cloth, without padding
  std::vector<float> x_m, y_m, z_m;
  std::vector<float> lean_east, lean_south;  ///< lean.hpp

  std::size_t stride() const { return x_m.size(); }
};

/// The constants of a whole cloth.
struct ClothSpec {
  std::size_t rows = 2;   ///< of joints, including the fixed edge
  double length_m = 1.0;  ///< of a thread
  bool is_first_column_fixed = false;
  double knots_across_m = 0.25;    ///< maximum distance of the columns of knots
  double knots_along_m = 0.05;     ///< and approximate length of their links
  double hybrid = 0.0;             ///< 0: the noise alone, bit for bit; 1: dynamics, with the noise as detail
  double normal_drag_per_m = 0.4;  ///< ClothDynamicsJob's, like the next
  double skin_drag_per_m = 0.02;
  double across_stiffness_s2 = 2000.0;
};

/// A turn about the vertical, clockwise seen from above.
struct ClothTurn {
  double sine = 0.0;
  double cosine = 1.0;
};

/// A cloth that hangs by an edge: the paper's 2-D links (Chiba, section 3.2). A scene sets the leans of
/// the links on a coarse grid, from the wind and its noise, and the cloth projects them:
///
///   spread a spline interpolates the knots' leans              ClothSpline, ClothLineJob
///   project   links turn by their lean, and add up to offsets     ClothProjectionJob
///
/// If `hybrid` is above 0, a coarse cloth moves by weight, inertia and air (ClothDynamicsJob); its leans replace the
/// sway, and the wave remains as fine detail.
///
/// Leans of 0 from the start give exactly the rest pose. Allocates when it is made. Thread-safe: no. Realtime-safe:
/// project(), yes.
class Cloth {
 public:
  Cloth(const ClothSpec& spec, const ClothEdge& edge, SimdRow row);

  const pose::Skeleton& skeleton() const noexcept { return skeleton_; }
  const pose::Pose& pose() const noexcept { return pose_; }

  /// The coarse grid.
  const operators::ClothKnots& knots() const noexcept { return knots_; }
  /// The position on the fixed edge of a column of the grid: 0 at the first thread, 1 at the last; ghosts are beyond.
  /// For all columns of the stride.
  double across(std::size_t knot_column) const noexcept {
    return (static_cast<double>(knot_column) - 1.0) / static_cast<double>(knots_.columns - 1);
  }
  /// The position on a thread of the middle of a link of the grid: 0 at the fixed edge, 1 at the free one.
  double along(std::size_t knot_link) const noexcept {
    return (static_cast<double>(knot_link) + 0.5) / static_cast<double>(knots_.links);
  }

  /// Weights of the scene's leans: of the cloth's sway as a whole, which the hybrid's dynamics replace, and of its
  /// waves, which remain as detail. Both 1 without the hybrid.
  float sway_share() const noexcept { return static_cast<float>(1.0 - spec_.hybrid); }
  float wave_share() const noexcept;

  /// The lean of each knot's link beyond rest, weighted: write it before project(). In the cloth's own frame, before it
  /// is turned.
  std::span<float> lean() noexcept { return lean_; }

  /// The air that the hybrid's cloth is in, m/s: the wind, stronger or weaker and from a slightly different direction
  /// by `gusts` (-1 to 1; a value per column of the knots, stride in total). Does nothing if hybrid is 0.
  void blow(double wind_east_m_s, double wind_south_m_s, std::span<const float> gusts) noexcept;

  /// Advances by dt_s. `rest_kept`: the share of its rest lean that the cloth keeps (the wind smooths folds), 0 to 1.
  /// `turn`: of the whole cloth about its first column, if that is fixed.
  void project(double dt_s, double rest_kept = 1.0, ClothTurn turn = {}) noexcept;

  /// The bound of a tick in which no knot's lean, nor the kept rest lean, changes by more than `lean_step` together,
  /// and the cloth is turned by no more than `turn_step_rad`. Derived in cloth.cpp.
  double largest_joint_step_m(double dt_s, double lean_step, double turn_step_rad = 0.0) const noexcept;

  void list_state(StatePass& pass) { pass(coarse_); }

 private:
  void turn_edge(ClothTurn turn) noexcept;
  std::span<const float> turned(std::span<const float> leans, std::size_t stride, ClothTurn turn) noexcept;

  ClothSpec spec_;
  SimdRow row_;
  operators::ClothThreads threads_;
  operators::ClothKnots knots_;
  std::vector<float> lean_;  ///< of the knots
  operators::ClothSpline spline_;
  std::vector<float> turned_;               ///< leans of a coarse grid, in the world
  std::vector<float> base_;                 ///< the kept part of the rest lean
  std::vector<float> links_;                ///< the leans of a band of links
  std::vector<float> from_x_m_, from_z_m_;  ///< the fixed edge at rest, from its first joint on
  std::vector<float> edge_m_;               ///< the fixed edge's offset, if it can turn
  operators::CoarseCloth coarse_;
  operators::ClothSpline dynamics_;
  std::vector<float> air_east_m_s_, air_south_m_s_;
  pose::Pose pose_;
  pose::Skeleton skeleton_;
};

/// A place or direction in a scene's coordinates, in metres east and south of its origin, turned by its heading.
struct EastSouth {
  double east;
  double south;
};
EastSouth turned_by_heading(const Placement& placement, double east, double south) noexcept;

/// The lean of a link that is turned by this angle from straight down.
double lean_of_deg(double angle_deg) noexcept;

/// The drag that holds a hanging cloth half way up, at 45 degrees, in a wind of this speed.
double drag_per_m(double half_speed_m_s) noexcept;

}  // namespace yuragi::scenes
