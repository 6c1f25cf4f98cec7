#pragma once

#include <span>

#include "engine/wind/blend/blend_settings.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::wind::blend {

/// The weights of a source's value: in the middle of the scene, and in the slopes (1/m).
struct PlaceWeights {
  double middle = 0.0, per_m_east = 0.0, per_m_south = 0.0;
};

/// The plane through the mean winds of several absolute sources at their places, by weighted least squares. It is given
/// as the weights of their values, which may be vectors, and follows a source as its share fades and returns.
///
/// A small ridge makes the slope fade if only one place remains, and bounds it if the remaining ones are close
/// together. Thread-safe: reading, yes. Realtime-safe: yes.
class MeanWindPlane {
 public:
  explicit MeanWindPlane(std::span<const SourceSettings> sources);

  /// Returns true if all are at one place.
  bool is_point() const noexcept { return length_m_ <= 0.0; }
  /// From corner to corner.
  double length_m() const noexcept { return length_m_; }
  /// Its ends, without slopes.
  const ground::WindSlope& ends() const noexcept { return ends_; }

  /// Computes the weights for sources with these shares (at least 0; one per source). The sum of the weights in the
  /// middle is that of the shares. `part`, 0 to 1: the part of the slopes to use.
  void weigh(std::span<const double> shares, double part, std::span<PlaceWeights> weights) const noexcept;

 private:
  struct Place {
    double east_m = 0.0, south_m = 0.0;
  };
  std::vector<Place> places_;
  Place middle_;  ///< that of the scene, or the nearest within the plane
  ground::WindSlope ends_;
  double length_m_ = 0.0;
};

}  // namespace yuragi::wind::blend
