#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/scenes/gust_nodes.hpp"
#include "engine/scenes/reading_schedule.hpp"
#include "engine/scenes/scene_wind.hpp"
#include "engine/scenes/tape_nodes.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::scenes {

/// The wind at each place of a scene: a grid over the scene whose nodes each process the wind like Wind (limited
/// to kStrongestSceneWind_m_s, smoothed by 0.1 s), including the gusts of the place; places between nodes are
/// interpolated bilinearly.
///
/// Reading the wind at a node costs most, and 12 times a second is enough (ReadingSchedule): at each tick a part of the
/// lines of nodes is read, as the wind will be at their next turn. That is already known, because the mean wind carries
/// gusts and tapes there; other changes (a slope of the mean, a wind without tapes) are late by the same 1/12 s. Until
/// then a node's target moves there linearly, and the smoothing is faster to compensate for this. A wind without a
/// tick's number is read everywhere at once.
///
/// The bound of a tick holds for this, too: a target goes from one end of its range to the other in 1/12 s at the
/// soonest, so that the value's rate is at most twice the strongest wind times the mean of the filter's impulse
/// response over the 1/12 s of its peak, 7.31 a second; of Wind it is the peak itself, 7.36.
///
/// So a place's wind is never stronger than kStrongestSceneWind_m_s, and changes in a tick by at most
/// Wind::largest_step_m_s, for any input. Nodes are half a metre apart in scenes of up to 31 m; in larger ones the
/// longer side has 63. Waves too short for them are omitted (GustNodes). Allocates when it is made, never afterwards.
/// Thread-safe: sampling, yes. Realtime-safe: all but construction. Cost: 1.3 ns a node that is read and layer, which
/// makes 24 us for all nodes of a meadow of 7 m (256) and 0.34 ms for one of 60 m, three fifths of it if nothing
/// evolves; a fifth of these each tick at 60 Hz; and 4 ns a place.
class WindGrid {
 public:
  /// Places: metres east and south of the middle of all scenes, as many of x as of z.
  /// `finest_cell_m`: minimum distance of nodes. `columns`: the number of places in a row, if they are the rows of a
  /// grid: if those are along x, all of them together are read faster (GridSampleJob), with the same bits.
  WindGrid(std::shared_ptr<const wind::turbulence::GustNoise> gusts, std::span<const float> x_m,
           std::span<const float> z_m, SimdRow row, double finest_cell_m = 0.5, std::size_t columns = 0);

  /// Advances by dt_s toward `wind`. Calm from the beginning stays calm, exactly.
  void step(const wind::ground::Wind& wind, double dt_s) noexcept;

  /// The wind at the places from `first` on; the outputs set the number.
  void sample(std::size_t first, std::span<float> east_m_s, std::span<float> south_m_s) const noexcept;

  void list_state(StatePass& pass) { pass(east_, south_, schedule_, due_in_s_, has_targets_); }

 private:
  /// The nodes, and the positions of the places between them.
  struct Layout {
    Layout(std::span<const float> x_m, std::span<const float> z_m, double finest_cell_m);
    GroundNodes nodes;
    std::size_t torus_nodes = 2;                  ///< nodes per edge of the torus on which places read them
    std::vector<std::uint32_t> place_x, place_z;  ///< on it
  };
  /// One component of the wind at the nodes: its value, target and rate.
  struct Component {
    std::vector<float> value, target, rate_per_s;
    std::vector<float> next_target;  ///< where the target goes
    noise::Tile2 on_torus;           ///< the values, for reading between the nodes

    void list_state(StatePass& pass) { pass(value, target, rate_per_s, next_target); }
  };

  void approach_targets(double dt_s) noexcept;
  void read(const wind::ground::Wind& wind, const ReadingSchedule::Due& due) noexcept;
  void read_lines(const wind::ground::Wind& wind, const NodeRange& lines, double lead_s) noexcept;
  void follow(Component& component, double rate_rad_s, double dt_s) const noexcept;
  void read(const Component& component, std::size_t first, std::span<float> out) const noexcept;

  SimdRow row_;
  Layout layout_;
  GustNodes gusts_;
  TapeNodes tape_nodes_;
  std::vector<std::uint32_t> column_x_, row_z_;  ///< of the places, if they are a grid along the axes; otherwise empty
  Component east_, south_;
  ReadingSchedule schedule_;
  std::vector<double> due_in_s_;  ///< for each line: the time until its next targets are due
  bool has_targets_ = false;
};

}  // namespace yuragi::scenes
