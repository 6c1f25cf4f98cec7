#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/parameter.hpp"
#include "engine/base/simd_row.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/noise/torus.hpp"

namespace yuragi {

/// Where on the noise each column of a cloth is, as SampleJob wants it.
struct NoisePlaces {
  std::vector<std::uint32_t> x, z;
};

/// The noise that moves a cloth: a 2-D 1/f^beta tile which the wind carries over it (ShiftJob), read at places
/// (SampleJob) as numbers from -1 to 1. `kSecondNoise` reads the same tile elsewhere: another noise, as good as
/// independent. Allocates when it is made. Thread-safe: no. Realtime-safe: yes, but for places().
class ClothNoise {
 public:
  enum Channel : std::uint32_t { kFirstNoise, kSecondNoise };

  /// Reads `tile_period` and `beta` of the scene's parameters.
  ClothNoise(const ParameterValues& values, std::uint64_t seed, SimdRow row);

  /// Where these are. Metres; allocates.
  NoisePlaces places(std::span<const double> x_m, std::span<const double> z_m) const;

  /// The noise goes by so far as the wind goes in dt_s.
  void shift(double wind_east_m_s, double wind_south_m_s, double dt_s) noexcept;

  /// As many values as there are places.
  void sample(const NoisePlaces& places, Channel channel, std::span<float> out) const noexcept;

 private:
  double period_m_;
  SimdRow row_;
  NoiseTile2 tile_;
  TorusOffset offset_;
};

}  // namespace yuragi
