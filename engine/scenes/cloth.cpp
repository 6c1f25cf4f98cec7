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
// faster (propagation_history.hpp), and link i takes growth_i of it. The hybrid's leans are two numbers that change by
// at most R a second each (cloth_dynamics.hpp), and a spline through them does not change faster; they count by h, and
// the sway then by 1 - h. A lean that changes by d turns its link by at most 2 d (lean.hpp), and a joint moves by no
// more than the links before it together:
//   2 length dt ((2 w / e) ((1 - h) S + W mean growth) + h sqrt(2) R).
// And never by more than from one end of its reach to the other, twice the length.

namespace yuragi {
namespace {

/// Links in a band: its leans take about 27 kB of 200 columns, which the nearest cache holds.
constexpr std::size_t kBandLinks = 16;

/// How fast the hybrid's leans may go: some four times as fast as a swinging curtain's do.
constexpr double kLargestLean_per_s = 8.0;

/// What is left of the wave as detail where the cloth is all dynamics.
constexpr double kDetail = 0.4;

/// How much stronger than the wind, and how far aside of it, the strongest gusts blow.
constexpr double kGustAlong = 0.4;
constexpr double kGustAside = 0.5;

double wave_share(const ClothSpec& spec) {
  return 1.0 - (1.0 - kDetail) * spec.hybrid;
}

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
    growth[link] =
        static_cast<float>(wave_share(spec) * std::pow(static_cast<double>(link) / last, spec.growth_exponent));
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
      coarse_(threads_, edge.columns, edge.x_m, edge.y_m, edge.z_m, spec.is_first_column_fixed),
      spline_(coarse_, edge.columns, threads_.links),
      air_east_m_s_(coarse_.stride(), 0.0F),
      air_south_m_s_(coarse_.stride(), 0.0F),
      skeleton_(cloth_skeleton(spec, edge, threads_)) {
  pose_ = rest_pose(skeleton_);
}

void Cloth::blow(double wind_east_m_s, double wind_south_m_s, std::span<const float> gusts) noexcept {
  if (!(spec_.hybrid > 0.0)) return;
  const std::size_t columns = std::get_if<GridSkeleton>(&skeleton_)->columns;
  const std::size_t last = std::max<std::size_t>(coarse_.columns(), 2) - 1;
  for (std::size_t i = 0; i < air_east_m_s_.size(); ++i) {
    const std::size_t column = std::min(i, last) * (columns - 1) / last;
    const auto gust = static_cast<double>(gusts[column]);
    const double along = 1.0 + kGustAlong * gust;
    const double aside = kGustAside * gust;
    air_east_m_s_[i] = static_cast<float>(along * wind_east_m_s - aside * wind_south_m_s);
    air_south_m_s_[i] = static_cast<float>(along * wind_south_m_s + aside * wind_east_m_s);
  }
}

void Cloth::project(double dt_s) noexcept {
  const std::size_t width = history_.width();
  const bool is_hybrid = spec_.hybrid > 0.0;
  if (is_hybrid) {
    ClothDynamicsJob{.air_east_m_s = air_east_m_s_,
                     .air_south_m_s = air_south_m_s_,
                     .dt_s = dt_s,
                     .normal_drag_per_m = spec_.normal_drag_per_m,
                     .skin_drag_per_m = spec_.skin_drag_per_m,
                     .across_stiffness_s2 = spec_.across_stiffness_s2,
                     .largest_lean_per_s = kLargestLean_per_s,
                     .row = row_,
                     .cloth = &coarse_}
        .run();
    spline_.spread(coarse_, row_);
  }
  FollowJob{.target = target_,
            .omega_rad_s = spec_.quickness_rad_s,
            .dt_s = dt_s,
            .row = row_,
            .value = value_,
            .rate_per_s = rate_}
      .run();
  history_.push(std::span(value_).last(width), dt_s);

  // Rest and sway are the base of all links; rest alone is what the projection knows as rest, to the bit.
  const auto sway_share = static_cast<float>(1.0 - spec_.hybrid);
  for (std::size_t i = 0; i < width; ++i) base_[i] = threads_.rest_lean[i] + sway_share * value_[i];

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
    if (is_hybrid) {
      ClothSplineJob{
          .spline = &spline_, .share = static_cast<float>(spec_.hybrid), .first_link = link, .row = row_, .out = band}
          .run();
    }
    ClothProjectionJob{
        .threads = &threads_, .first_link = link, .lean = band, .row = row_, .pose = std::get_if<GridPose>(&pose_)}
        .run();
  }
}

double Cloth::largest_joint_step_m(double dt_s) const noexcept {
  const double mean_growth = std::accumulate(growth_.begin(), growth_.end(), 0.0) / static_cast<double>(growth_.size());
  const double follows_per_s = 2.0 * spec_.quickness_rad_s / std::numbers::e;
  const double noise_per_s =
      follows_per_s * ((1.0 - spec_.hybrid) * spec_.largest_sway + mean_growth * spec_.largest_wave);
  const double lean_per_s = noise_per_s + spec_.hybrid * std::numbers::sqrt2 * kLargestLean_per_s;
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

double drag_per_m(double half_speed_m_s) noexcept {
  constexpr double kGravity_m_s2 = 9.81;
  return kGravity_m_s2 / (half_speed_m_s * half_speed_m_s);
}

}  // namespace yuragi
