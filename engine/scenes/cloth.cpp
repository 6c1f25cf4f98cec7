#include "engine/scenes/cloth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/units.hpp"
#include "engine/math/portable.hpp"
#include "engine/pose/pose_arrays.hpp"

// The bound of largest_joint_step_m. A spline through the knots changes by no more than they do. The hybrid's leans are
// two numbers that change by at most R per second each (cloth_dynamics.hpp), with the weight h. A lean that changes by
// d turns its link by at most 2 d (lean.hpp), and a joint moves by no more than the links before it together:
//   2 length (lean_step + h sqrt(2) R dt),
// and by the turn times its distance from the axis, which is that of its fixed joint and its thread's length at most.
// And by at most its whole range, twice that distance.

namespace yuragi::scenes {
namespace {

/// Links in a band: with 200 columns its leans take about 27 kB, which fits into the nearest cache.
constexpr std::size_t kBandLinks = 16;

/// Maximum rate of the hybrid's leans: about four times that of a swinging curtain.
constexpr double kMaxLean_per_s = 8.0;

/// The remaining share of the wave as detail if the cloth is all dynamics.
constexpr double kDetail = 0.4;

/// The strongest gusts: how much stronger than the wind, and how far to its side.
constexpr double kGustAlong = 0.4;
constexpr double kGustAside = 0.5;

double edge_length_m(const ClothEdge& edge) {
  const auto way_m = [last = edge.columns - 1](const std::vector<float>& at_m) {
    return static_cast<double>(at_m[last]) - static_cast<double>(at_m[0]);
  };
  return math::length(way_m(edge.x_m), way_m(edge.y_m), way_m(edge.z_m));
}

operators::ClothKnots cloth_knots(const ClothSpec& spec, const ClothEdge& edge) {
  const auto wanted = static_cast<std::size_t>(std::ceil(edge_length_m(edge) / spec.knots_across_m));
  const auto links = static_cast<std::size_t>(std::ceil(spec.length_m / spec.knots_along_m));
  const std::size_t stride = pose::padded_to_blocks(std::clamp<std::size_t>(wanted + 1, 2, edge.columns) + 2);
  return {.columns = std::clamp<std::size_t>(wanted + 1, 2, edge.columns),
          .links = std::clamp<std::size_t>(links, 1, spec.rows - 1),
          .stride = stride};
}

std::vector<float> from_first(const std::vector<float>& at_m) {
  std::vector<float> way_m = at_m;
  for (float& each_m : way_m) each_m -= at_m.front();
  return way_m;
}

pose::GridSkeleton cloth_skeleton(const ClothSpec& spec, const ClothEdge& edge,
                                  const operators::ClothThreads& threads) {
  pose::GridSkeleton grid;
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

operators::ClothThreads cloth_threads(const ClothSpec& spec, const ClothEdge& edge) {
  std::vector<float> lean = edge.lean_east;
  lean.insert(lean.end(), edge.lean_south.begin(), edge.lean_south.end());
  const std::size_t links = spec.rows - 1;
  return operators::make_threads(links, static_cast<float>(spec.length_m / static_cast<double>(links)), lean);
}

}  // namespace

ClothEdge::ClothEdge(std::size_t column_count)
    : columns(column_count),
      x_m(pose::padded_to_blocks(column_count)),
      y_m(x_m.size()),
      z_m(x_m.size()),
      lean_east(x_m.size()),
      lean_south(x_m.size()) {}

Cloth::Cloth(const ClothSpec& spec, const ClothEdge& edge, SimdRow row)
    : spec_(spec),
      row_(row),
      threads_(cloth_threads(spec, edge)),
      knots_(cloth_knots(spec, edge)),
      lean_(knots_.size(), 0.0F),
      spline_(knots_, edge.columns, threads_.links),
      base_(threads_.rest_lean),
      links_(kBandLinks * 2 * threads_.stride, 0.0F),
      from_x_m_(from_first(edge.x_m)),
      from_z_m_(from_first(edge.z_m)),
      edge_m_(3 * threads_.stride, 0.0F),
      coarse_(threads_, edge.columns, edge.x_m, edge.y_m, edge.z_m, spec.is_first_column_fixed),
      dynamics_(coarse_.knots(), edge.columns, threads_.links),
      air_east_m_s_(coarse_.stride(), 0.0F),
      air_south_m_s_(coarse_.stride(), 0.0F),
      skeleton_(cloth_skeleton(spec, edge, threads_)) {
  turned_.resize(std::max(knots_.size(), coarse_.knots().size()));
  pose_ = pose::rest_pose(skeleton_);
}

float Cloth::wave_share() const noexcept {
  return static_cast<float>(1.0 - (1.0 - kDetail) * spec_.hybrid);
}

void Cloth::blow(double wind_east_m_s, double wind_south_m_s, std::span<const float> gusts) noexcept {
  if (!(spec_.hybrid > 0.0)) return;
  const double knots_in_one = static_cast<double>(knots_.columns - 1) / static_cast<double>(coarse_.columns() - 1);
  for (std::size_t i = 0; i < air_east_m_s_.size(); ++i) {
    const std::size_t column = std::clamp<std::size_t>(i, 1, coarse_.columns()) - 1;
    const double at = 1.0 + knots_in_one * static_cast<double>(column);
    const auto first = std::min(static_cast<std::size_t>(at), knots_.columns);
    const double part = at - static_cast<double>(first);
    const double gust = (1.0 - part) * static_cast<double>(gusts[first]) + part * static_cast<double>(gusts[first + 1]);
    const double along = 1.0 + kGustAlong * gust;
    const double aside = kGustAside * gust;
    air_east_m_s_[i] = static_cast<float>(along * wind_east_m_s - aside * wind_south_m_s);
    air_south_m_s_[i] = static_cast<float>(along * wind_south_m_s + aside * wind_east_m_s);
  }
}

void Cloth::turn_edge(ClothTurn turn) noexcept {
  const std::size_t stride = threads_.stride;
  for (std::size_t i = 0; i < stride; ++i) {
    const auto x_m = static_cast<double>(from_x_m_[i]);
    const auto z_m = static_cast<double>(from_z_m_[i]);
    edge_m_[i] = static_cast<float>((turn.cosine - 1.0) * x_m - turn.sine * z_m);
    edge_m_[2 * stride + i] = static_cast<float>(turn.sine * x_m + (turn.cosine - 1.0) * z_m);
  }
}

/// Leans, row by row east of all columns and then south.
std::span<const float> Cloth::turned(std::span<const float> leans, std::size_t stride, ClothTurn turn) noexcept {
  const auto sine = static_cast<float>(turn.sine);
  const auto cosine = static_cast<float>(turn.cosine);
  for (std::size_t row = 0; row < leans.size(); row += 2 * stride) {
    for (std::size_t east = row; east < row + stride; ++east) {
      const std::size_t south = east + stride;
      turned_[east] = cosine * leans[east] - sine * leans[south];
      turned_[south] = sine * leans[east] + cosine * leans[south];
    }
  }
  return std::span(turned_).first(leans.size());
}

void Cloth::project(double dt_s, double rest_kept, ClothTurn turn) noexcept {
  const bool is_hybrid = spec_.hybrid > 0.0;
  if (is_hybrid) {
    operators::ClothDynamicsJob{.air_east_m_s = air_east_m_s_,
                                .air_south_m_s = air_south_m_s_,
                                .dt_s = dt_s,
                                .normal_drag_per_m = spec_.normal_drag_per_m,
                                .skin_drag_per_m = spec_.skin_drag_per_m,
                                .across_stiffness_s2 = spec_.across_stiffness_s2,
                                .largest_lean_per_s = kMaxLean_per_s,
                                .row = row_,
                                .cloth = &coarse_}
        .run();
    dynamics_.spread(turned(coarse_.lean(), coarse_.stride(), turn), row_);
  }
  if (spec_.is_first_column_fixed) {  // the spline is 0 there
    for (std::size_t row = 0; row < lean_.size(); row += knots_.stride) {
      lean_[row] = -lean_[row + 2];
      lean_[row + 1] = 0.0F;
    }
  }
  spline_.spread(turned(lean_, knots_.stride, turn), row_);
  if (spec_.is_first_column_fixed) turn_edge(turn);

  // The dynamics keep the whole rest lean. For the projection the rest lean alone is the rest pose, exactly.
  const auto kept = static_cast<float>(1.0 - (1.0 - spec_.hybrid) * (1.0 - rest_kept));
  const auto sine = static_cast<float>(turn.sine);
  const auto cosine = static_cast<float>(turn.cosine);
  const std::size_t stride = threads_.stride;
  for (std::size_t i = 0; i < stride; ++i) {
    const float east = kept * threads_.rest_lean[i];
    const float south = kept * threads_.rest_lean[stride + i];
    base_[i] = cosine * east - sine * south;
    base_[stride + i] = sine * east + cosine * south;
  }

  // From the fixed edge on, band by band.
  for (std::size_t link = 0; link < threads_.links; link += kBandLinks) {
    const std::span band = std::span(links_).first(std::min(kBandLinks, threads_.links - link) * 2 * stride);
    operators::ClothLineJob{.spline = &spline_, .base = base_, .first_link = link, .row = row_, .out = band}.run();
    if (is_hybrid) {
      operators::ClothSplineJob{
          .spline = &dynamics_, .share = static_cast<float>(spec_.hybrid), .first_link = link, .row = row_, .out = band}
          .run();
    }
    operators::ClothProjectionJob{.threads = &threads_,
                                  .first_link = link,
                                  .lean = band,
                                  .edge_m = edge_m_,
                                  .row = row_,
                                  .pose = std::get_if<pose::GridPose>(&pose_)}
        .run();
  }
}

double Cloth::largest_joint_step_m(double dt_s, double lean_step, double turn_step_rad) const noexcept {
  double edge_reach_m = 0.0;
  if (turn_step_rad > 0.0) {
    for (std::size_t i = 0; i < from_x_m_.size(); ++i) {
      edge_reach_m =
          std::max(edge_reach_m, math::length(static_cast<double>(from_x_m_[i]), static_cast<double>(from_z_m_[i])));
    }
  }
  const double reach_m = edge_reach_m + spec_.length_m;
  const double step = lean_step + spec_.hybrid * std::numbers::sqrt2 * kMaxLean_per_s * dt_s;
  constexpr double kRounding_m = 1e-5;
  return std::min(2.0 * spec_.length_m * step + turn_step_rad * reach_m, 2.0 * reach_m) + kRounding_m;
}

EastSouth turned_by_heading(const Placement& placement, double east, double south) noexcept {
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

}  // namespace yuragi::scenes
