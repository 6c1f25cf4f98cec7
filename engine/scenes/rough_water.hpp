#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/noise/noise_tile.hpp"

namespace yuragi::scenes {

/// The variance of the slope of open water in a wind of at least 0 m/s: 0.003 + 0.00512 u, from the sun's glitter on
/// the sea (Cox and Munk 1954, Measurement of the roughness of the sea surface from photographs of the sun's glitter),
/// above the onset of ripples, near 1 m/s: times 1 - exp(-(u / onset)^4), the exponential being exp(-y) = (1 + y /
/// 8)^-8. 0 in calm air. No library function affects its bits. Thread-safe and realtime-safe: yes.
double water_slope_variance(double wind_m_s, double onset_m_s) noexcept;

/// The layout of a RoughWater.
struct RoughWaterSpec {
  std::size_t columns = 2, rows = 2;  ///< points of the surface, 2 or more each
  double width_m = 8.0, depth_m = 8.0;
  double finest_cell_m = 0.5;  ///< minimum distance of nodes
  double part = 0.6;           ///< share of the natural variance
  double onset_m_s = 1.2;
};

/// The steepness of water under the wind: at nodes over the surface its slope follows the wind there, at the rate at
/// which waves build up and die away (critically damped, 1.5 rad/s), with bilinear interpolation between the nodes.
///
/// A slope is a standard deviation, without unit. Calm from the beginning stays 0, exactly, and after a calm it returns
/// there. In a tick no slope changes by more than largest_slope() 1.5 dt / e: its target is never above that. Allocates
/// when it is made, never afterwards. Thread-safe: no. Realtime-safe: all but construction.
class RoughWater {
 public:
  explicit RoughWater(const RoughWaterSpec& spec);

  static constexpr double kBuildUp_rad_s = 1.5;

  /// The nodes: rows of node_columns(), over the whole surface to its edges.
  std::size_t node_columns() const noexcept { return node_columns_; }
  std::size_t node_rows() const noexcept { return node_rows_; }

  /// Advances by dt_s under these winds (m/s, at least 0; limited to kStrongestSceneWind_m_s), one per node.
  void step(std::span<const float> wind_m_s, double dt_s) noexcept;

  /// The slope at each point, columns * rows of them.
  void sample(SimdRow row, std::span<float> slope) const noexcept;

  double largest_slope() const noexcept;

  void list_state(StatePass& pass) { pass(value_, rate_per_s_); }

 private:
  RoughWaterSpec spec_;
  std::size_t node_columns_, node_rows_;
  std::vector<float> value_, rate_per_s_;
  noise::Tile2 on_torus_;                        ///< the values, for reading between the nodes
  std::vector<std::uint32_t> column_x_, row_z_;  ///< of the points, on it
};

}  // namespace yuragi::scenes
