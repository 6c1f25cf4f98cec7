#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/noise/noise_tile.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi::bench {

/// Where the field has moved to, metres.
struct PlainOffset {
  double x_m = 0.0;
  double z_m = 0.0;
};

/// Strands in the wind as one would write them who does not care for speed: the formulas of SampleJob, BendingJob,
/// OscillatorJob and StrandKinematicsJob, strand after strand, in plain floats, with one libm sine and cosine a strand.
/// Compiled with -O2 and no vectorisation: what the engine's operators are measured against.
class PlainStrands {
 public:
  /// Two tiles of period_m and second_period_m (the second not turned: the cost is the same), added.
  PlainStrands(const pose::StrandSkeleton& skeleton, std::vector<float> flexibility, noise::Tile2 first,
               noise::Tile2 second, double period_m, double second_period_m);

  /// One frame: shift, sample, bend, sway (two axes), joints. `hybrid` 0 leaves the oscillators out.
  void frame(double east_m_s, double south_m_s, double dt_s, double hybrid);

  /// Joint positions, x, y, z a joint, strand after strand.
  std::span<const float> joints_m() const { return joints_m_; }
  std::span<const float> bend_east_rad() const { return bend_east_rad_; }

 private:
  float noise_at(const noise::Tile2& tile, float x_m, float z_m, double period_m, const PlainOffset& offset) const;
  void joints_of(std::size_t strand);

  struct Oscillator {
    float value = 0.0F;
    float rate = 0.0F;
  };

  const pose::StrandSkeleton* skeleton_;
  std::vector<float> flexibility_;
  noise::Tile2 first_, second_;
  double period_m_, second_period_m_;
  PlainOffset offset_;
  std::vector<Oscillator> east_, south_;
  std::vector<float> bend_east_rad_, bend_south_rad_;
  std::vector<float> curl_cos_, curl_sin_;  ///< they never change
  std::vector<float> joints_m_;
};

}  // namespace yuragi::bench
