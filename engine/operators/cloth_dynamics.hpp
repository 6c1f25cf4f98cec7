#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/operators/cloth_projection_job.hpp"
#include "engine/operators/cloth_spline.hpp"

namespace yuragi::operators {

/// A cloth of few points, with their positions and speeds: the state of ClothDynamicsJob.
///
/// Points stand in rows of stride() (whole blocks), from the fixed edge on; a row begins and ends with a ghost that
/// copies its neighbour, so that every point has one on either side. Threads are straight at rest, as in ClothThreads.
/// Allocates when it is made. Thread-safe: no.
class CoarseCloth {
 public:
  static constexpr std::size_t kMaxColumns = 30;
  static constexpr std::size_t kMaxRows = 38;

  /// The coarse version of a cloth of `columns` threads and `threads.links` links, whose fixed joints are at these
  /// places (a value a column, metres): at most kMaxColumns x kMaxRows points, about as far apart in both directions.
  CoarseCloth(const ClothThreads& threads, std::size_t columns, std::span<const float> edge_x_m,
              std::span<const float> edge_y_m, std::span<const float> edge_z_m, bool is_first_column_fixed);

  std::size_t columns() const noexcept { return columns_; }  ///< without ghosts
  std::size_t rows() const noexcept { return rows_; }
  std::size_t links() const noexcept { return rows_ - 1; }
  std::size_t stride() const noexcept { return stride_; }
  ClothKnots knots() const noexcept { return {.columns = columns_, .links = links(), .stride = stride_}; }
  bool is_first_column_fixed() const noexcept { return is_first_column_fixed_; }

  /// The lean of each link beyond rest (lean.hpp): a row per link, east of all columns, then south, stride() each. The
  /// ghosts' are such that a spline through them is 0 on a fixed column. 0 at rest, exactly.
  std::span<const float> lean() const noexcept { return lean_; }

  /// A point's offset from rest, metres; column from 0, ghosts not counted.
  struct Offset {
    float x_m, y_m, z_m;
  };
  Offset offset(std::size_t column, std::size_t row) const noexcept {
    const std::size_t at = row * stride_ + column + 1;
    const std::size_t count = rows_ * stride_;
    return {offset_m_[at], offset_m_[count + at], offset_m_[2 * count + at]};
  }
  float link_length_m() const noexcept { return link_length_m_; }
  std::span<const float> rest_link_m() const noexcept { return rest_link_m_; }  ///< x, y, z of each column's links

  void list_state(StatePass& pass) { pass(offset_m_, speed_m_s_, lean_); }

 private:
  friend struct ClothDynamicsJob;

  std::size_t rows_, columns_, stride_;
  bool is_first_column_fixed_;
  float link_length_m_;
  std::vector<float> rest_link_m_;                 ///< x of all columns, then y, z
  std::vector<float> across_m_, across_growth_m_;  ///< from the previous to the next column, at the edge; one row
  std::vector<float> rest_length_m_;               ///< of each column's links
  std::vector<float> skin_share_;                  ///< of each column, in a substep
  std::vector<float> mobility_;                    ///< of each column: 0 if it is fixed
  std::vector<float> offset_m_, predicted_m_, speed_m_s_;  ///< x of all points, then y, z
  std::vector<float> lean_;
};

/// The hybrid's dynamics (engine/METHOD.md M26): position-based dynamics of a coarse cloth (XPBD; Mueller et al. 2007,
/// "Position based dynamics"; Macklin et al. 2019, "Small steps in physics simulation"), which adds what noise lacks:
/// weight, inertia, overshoot.
///
/// Substeps of at most 1/600 s, ten in a tick at 60 Hz. Threads do not stretch: a distance constraint per link
/// (compliance 0), from the fixed edge on, and long-range attachments of each point to its own fixed joint (Kim,
/// Chentanez and Mueller 2012, "Long range attachments"). Across threads the cloth is elastic. The air drags along the
/// cloth's normal and, less, along its skin, both implicit in the speed, so that no wind makes it overshoot.
///
/// Weight is the tension that it gives a thread, times how far each link is turned from rest: K_j (u_{j+1} - u_j) with
/// K_j = g * links below / link length. On links that do not stretch its energy, the sum of K_j L^2 (1 - cos angle), is
/// exactly that of the weights lifted; and rest is an equilibrium to the bit, from which nothing creeps. Speeds are
/// limited, so it is finite for any input. World metres, m/s. Owns nothing. Thread-safe: jobs of different cloths, yes.
/// Realtime-safe: yes. Every SIMD row computes the same bits. Cost: about 70 us a tick of 30 x 38 points (x86-64-v3).
struct ClothDynamicsJob {
  std::span<const float> air_east_m_s;   ///< at each column, ghosts included: stride() values, finite
  std::span<const float> air_south_m_s;  ///< as many
  double dt_s = 0.0;
  double normal_drag_per_m = 0.4;     ///< speed lost in a metre of air that blows straight at the cloth; at least 0
  double skin_drag_per_m = 0.02;      ///< along it
  double across_stiffness_s2 = 2000;  ///< per point's mass and metre, between neighbouring threads; 0 to 20000
  double damping_per_s = 0.6;         ///< at least 0
  double largest_speed_m_s = 15.0;    ///< above 0
  double largest_lean_per_s = 8.0;    ///< maximum rate of lean(); above 0
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  CoarseCloth* cloth = nullptr;

  enum class Problem : std::uint8_t {
    kNone,
    kNoCloth,
    kStepNotPositive,  ///< dt_s is not a finite number above 0
    kParameter,        ///< one is out of its range
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate(). A tick longer than 0.1 s is
  /// simulated for 0.1 s.
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
