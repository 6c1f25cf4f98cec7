#include "engine/scenes/cloth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/base/units.hpp"
#include "engine/operators/follow_job.hpp"
#include "engine/operators/propagation_job.hpp"
#include "engine/pose/pose_arrays.hpp"

// The bound of largest_joint_step_m, for any wind whatever. A sway that stays within S changes by at most 2 S w / e in
// a second (follow_job.hpp), a wave that stays within W by 2 W w / e; what is read from its history does not change
// faster (propagation_history.hpp), and link i takes growth_i of it. A lean that changes by d turns its link by at most
// 2 d (lean.hpp), and a joint moves by no more than the links before it together: length * 2 * dt * (2 w / e) * (S + W
// mean growth). And never by more than from one end of its reach to the other, twice the length.

namespace yuragi {
namespace {

/// Links in a band: its leans take about 27 kB of 200 columns, which the nearest cache holds.
constexpr std::size_t kBandLinks = 16;

GridSkeleton cloth_skeleton(const ClothSpec& spec, const ClothEdge& edge, const ClothThreads& threads) {
  GridSkeleton grid;
  grid.columns = edge.columns;
  grid.rows = spec.rows;
  grid.is_first_column_fixed = spec.is_first_column_fixed;
  const std::size_t stride = threads.stride;
  for (auto* rest_m : {&grid.rest_x_m, &grid.rest_y_m, &grid.rest_z_m}) rest_m->resize(spec.rows * stride);
  for (std::size_t row = 0; row < spec.rows; ++row) {
    const auto links = static_cast<double>(row);
    for (std::size_t column = 0; column < stride; ++column) {
      const auto along = [&](float from_m, double link_m) {
        return static_cast<float>(static_cast<double>(from_m) + links * link_m);
      };
      const auto end_m = [&](std::size_t part) {
        return static_cast<double>(threads.rest_end_m[part * stride + column]);
      };
      const std::size_t joint = row * stride + column;
      grid.rest_x_m[joint] = along(edge.x_m[column], end_m(0));
      grid.rest_y_m[joint] = along(edge.y_m[column], static_cast<double>(threads.link_length_m) - end_m(1));
      grid.rest_z_m[joint] = along(edge.z_m[column], end_m(2));
    }
  }
  return grid;
}

ClothThreads cloth_threads(const ClothSpec& spec, const ClothEdge& edge) {
  std::vector<float> lean = edge.lean_east;
  lean.insert(lean.end(), edge.lean_south.begin(), edge.lean_south.end());
  const std::size_t links = spec.rows - 1;
  return make_threads(links, static_cast<float>(spec.length_m / static_cast<double>(links)), lean);
}

std::vector<float> growth_of(const ClothSpec& spec) {
  std::vector<float> growth(spec.rows - 1);
  const double last = std::max(static_cast<double>(growth.size()) - 1.0, 1.0);
  for (std::size_t link = 0; link < growth.size(); ++link) {
    growth[link] = static_cast<float>(std::pow(static_cast<double>(link) / last, spec.growth_exponent));
  }
  return growth;
}

}  // namespace

ClothEdge::ClothEdge(std::size_t column_count)
    : columns(column_count),
      x_m(padded_to_blocks(column_count)),
      y_m(x_m.size()),
      z_m(x_m.size()),
      lean_east(x_m.size()),
      lean_south(x_m.size()) {}

Cloth::Cloth(const ClothSpec& spec, const ClothEdge& edge, SimdRow row)
    : spec_(spec),
      row_(row),
      threads_(cloth_threads(spec, edge)),
      growth_(growth_of(spec)),
      target_(4 * threads_.stride, 0.0F),
      value_(target_.size(), 0.0F),
      rate_(target_.size(), 0.0F),
      history_(2 * threads_.stride, spec.travel_time_s),
      base_(threads_.rest_lean),
      lean_(kBandLinks * 2 * threads_.stride, 0.0F),
      skeleton_(cloth_skeleton(spec, edge, threads_)) {
  pose_ = rest_pose(skeleton_);
}

void Cloth::project(double dt_s) noexcept {
  const std::size_t width = history_.width();
  FollowJob{.target = target_,
            .omega_rad_s = spec_.quickness_rad_s,
            .dt_s = dt_s,
            .row = row_,
            .value = value_,
            .rate_per_s = rate_}
      .run();
  history_.push(std::span(value_).last(width), dt_s);

  // Rest and sway are the base of all links; rest alone is what the projection knows as rest, to the bit.
  for (std::size_t i = 0; i < width; ++i) base_[i] = threads_.rest_lean[i] + value_[i];

  // From the fixed edge on, band by band.
  for (std::size_t link = 0; link < threads_.links; link += kBandLinks) {
    const std::span band = std::span(lean_).first(std::min(kBandLinks, threads_.links - link) * width);
    PropagationJob{.history = &history_,
                   .base = base_,
                   .growth = growth_,
                   .travel_time_s = spec_.travel_time_s,
                   .first_link = link,
                   .row = row_,
                   .out = band}
        .run();
    ClothProjectionJob{
        .threads = &threads_, .first_link = link, .lean = band, .row = row_, .pose = std::get_if<GridPose>(&pose_)}
        .run();
  }
}

double Cloth::largest_joint_step_m(double dt_s) const noexcept {
  const double mean_growth = std::accumulate(growth_.begin(), growth_.end(), 0.0) / static_cast<double>(growth_.size());
  const double lean_per_s =
      2.0 * spec_.quickness_rad_s / std::numbers::e * (spec_.largest_sway + spec_.largest_wave * mean_growth);
  constexpr double kRounding_m = 1e-5;
  return 2.0 * spec_.length_m * std::min(lean_per_s * dt_s, 1.0) + kRounding_m;
}

Turned turned(const ScenePlacement& placement, double east, double south) noexcept {
  const double heading_rad = placement.heading_deg * kRadPerDeg;
  const double cosine = std::cos(heading_rad);
  const double sine = std::sin(heading_rad);
  return {east * cosine - south * sine, east * sine + south * cosine};
}

double lean_of_deg(double angle_deg) noexcept {
  return std::tan(0.5 * angle_deg * kRadPerDeg);
}

}  // namespace yuragi
