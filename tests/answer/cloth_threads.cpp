#include "tests/answer/cloth_threads.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "tests/answer/spectra.hpp"
#include "tests/answer/test_wind.hpp"

namespace yuragi::answer {
namespace {

/// A wave that takes longer between two places of a cloth than this is none that the wind carries.
constexpr double kMaxLag_s = 1.5;

std::size_t row_at(std::size_t rows, double way) {
  return static_cast<std::size_t>(std::lround(way * static_cast<double>(rows - 1)));
}

double thread_length_m(const pose::GridSkeleton& grid) {
  double length_m = 0.0;
  for (std::size_t row = 1; row < grid.rows; ++row) {
    const std::size_t at = row * grid.stride();
    const std::size_t before = at - grid.stride();
    const auto step_m = [&](const std::vector<float>& place_m) {
      return static_cast<double>(place_m[at]) - static_cast<double>(place_m[before]);
    };
    length_m += std::hypot(step_m(grid.rest_x_m), step_m(grid.rest_y_m), step_m(grid.rest_z_m));
  }
  return length_m;
}

std::vector<std::size_t> joints_of(const pose::GridSkeleton& grid, const std::vector<std::size_t>& columns) {
  const std::size_t half = row_at(grid.rows, 0.5);
  const std::size_t late = row_at(grid.rows, 0.9);
  std::vector<std::size_t> joints;
  for (const std::size_t column : columns) {
    for (const std::size_t row :
         {std::size_t{0}, row_at(grid.rows, 0.25), half, half + 1, late, late + 1, grid.rows - 1}) {
      joints.push_back(row * grid.columns + column);
    }
  }
  return joints;
}

}  // namespace

ClothThreads::ClothThreads(const pose::GridSkeleton& grid, std::size_t threads)
    : ClothThreads(grid, spread(grid.columns, threads)) {}

ClothThreads::ClothThreads(const pose::GridSkeleton& grid, std::vector<std::size_t> columns)
    : columns_(std::move(columns)),
      grid_columns_(grid.columns),
      rows_(grid.rows),
      length_m_(thread_length_m(grid)),
      tracks_(joints_of(grid, columns_)) {}

Series ClothThreads::slope(std::size_t thread, Joint from, Joint to, Horizontal aside) const {
  return high_passed(tracks_.way_m(at(thread, from), at(thread, to), aside), kRate_hz, kAcrossFrom_hz);
}

Lag ClothThreads::lag(std::size_t thread, Horizontal aside) const {
  return lag_of(slope(thread, Joint::kHalf, Joint::kHalfNext, aside),
                slope(thread, Joint::kLate, Joint::kLateNext, aside), kRate_hz, -kMaxLag_s, kMaxLag_s);
}

double ClothThreads::speed_m_s(Lag lag) const {
  const double way_m = (kLateWay - kHalfWay) * length_m_;
  return lag.seconds > 0.0 ? way_m / lag.seconds : std::numeric_limits<double>::infinity();
}

Horizontal ClothThreads::tip_way(const pose::Kinematics& joints) const {
  Horizontal sum;
  for (const std::size_t column : columns_) {
    const pose::JointPosition first = joints.joint(column);
    const pose::JointPosition tip = joints.joint((rows_ - 1) * grid_columns_ + column);
    sum.east += static_cast<double>(tip.x_m - first.x_m);
    sum.south += static_cast<double>(tip.z_m - first.z_m);
  }
  return sum;
}

}  // namespace yuragi::answer
