#include "engine/wind/blend/mean_wind_plane.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/portable.hpp"

namespace yuragi::wind::blend {
namespace {

/// The ridge, over the square of the sensors' extent: two sensors at its ends, whose own spread is 0.25, lose 1 % of
/// the slope.
constexpr double kRidge = 0.0025;
constexpr double kMinShareSum = 1e-9;

}  // namespace

MeanWindPlane::MeanWindPlane(std::span<const SourceSettings> sources) {
  bool is_first = true;
  for (const SourceSettings& source : sources) {
    places_.push_back({source.east_m, source.south_m});
    if (source.is_relative) continue;
    ends_.west_m = is_first ? source.east_m : std::min(ends_.west_m, source.east_m);
    ends_.east_m = is_first ? source.east_m : std::max(ends_.east_m, source.east_m);
    ends_.north_m = is_first ? source.south_m : std::min(ends_.north_m, source.south_m);
    ends_.south_m = is_first ? source.south_m : std::max(ends_.south_m, source.south_m);
    is_first = false;
  }
  middle_ = {std::clamp(0.0, ends_.west_m, ends_.east_m), std::clamp(0.0, ends_.north_m, ends_.south_m)};
  length_m_ = math::length(ends_.east_m - ends_.west_m, ends_.south_m - ends_.north_m);
}

void MeanWindPlane::weigh(std::span<const double> shares, double part, std::span<PlaceWeights> weights) const noexcept {
  double sum = 0.0;
  Place centre;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    weights[i] = {.middle = shares[i]};
    sum += shares[i];
    centre.east_m += shares[i] * places_[i].east_m;
    centre.south_m += shares[i] * places_[i].south_m;
  }
  if (is_point() || sum < kMinShareSum) return;
  centre = {centre.east_m / sum, centre.south_m / sum};

  // How far they are spread about their centre, in both directions; with the ridge the matrix has an inverse.
  double east_east = kRidge * length_m_ * length_m_;
  double south_south = east_east;
  double east_south = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double east_m = places_[i].east_m - centre.east_m;
    const double south_m = places_[i].south_m - centre.south_m;
    east_east += shares[i] / sum * east_m * east_m;
    east_south += shares[i] / sum * east_m * south_m;
    south_south += shares[i] / sum * south_m * south_m;
  }
  const double determinant = east_east * south_south - east_south * east_south;

  const double to_east_m = middle_.east_m - centre.east_m;
  const double to_south_m = middle_.south_m - centre.south_m;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double east_m = places_[i].east_m - centre.east_m;
    const double south_m = places_[i].south_m - centre.south_m;
    const double scale = part * shares[i] / determinant;
    weights[i].per_m_east = scale * (south_south * east_m - east_south * south_m);
    weights[i].per_m_south = scale * (east_east * south_m - east_south * east_m);
    weights[i].middle += weights[i].per_m_east * to_east_m + weights[i].per_m_south * to_south_m;
  }
}

}  // namespace yuragi::wind::blend
