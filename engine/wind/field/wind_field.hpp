#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "engine/math/portable.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::wind::field {

/// A place in the world, metres from the middle of the scene on the ground: x toward east, y up, z toward south.
struct WindPlace {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
};

/// Wind at a place: toward east, toward north, and up, m/s.
struct WindVector3 {
  double u_m_s = 0.0;
  double v_m_s = 0.0;
  double w_m_s = 0.0;
};

/// The wind everywhere at one moment, mean and gusts together. How it advances in time depends on the kind.
/// Thread-safe: yes, while the field is not advanced. Realtime-safe: yes. Finite at every finite place.
class WindField {
 public:
  virtual ~WindField() = default;

  /// 2: the same at every height, and no wind upward. 3: different at each height.
  virtual int dims() const noexcept = 0;
  virtual WindVector3 at(WindPlace place) const noexcept = 0;
};

/// The live wind over the ground as a field of two dimensions. Refers to both, and to the ground's tapes; they must
/// live on.
class GroundWindField final : public WindField {
 public:
  GroundWindField(const ground::Wind& ground, const turbulence::GustNoise& noise) : ground_(ground), noise_(noise) {}

  int dims() const noexcept override { return 2; }
  WindVector3 at(WindPlace place) const noexcept override {
    const Vector wind = ground_.at(noise_, place.x_m, place.z_m);
    return {wind.u_m_s, wind.v_m_s, 0.0};
  }

 private:
  const ground::Wind& ground_;
  const turbulence::GustNoise& noise_;
};

/// Places in rows: sample (i, j, k) is i - count_x / 2 (rounded down) steps east of the middle, j up from the ground,
/// and k - count_z / 2 south.
struct Grid {
  std::size_t count_x = 1, count_y = 1, count_z = 1;
  double spacing_m = 1.0;

  std::size_t size() const noexcept { return count_x * count_y * count_z; }
  /// From the middle to the farthest sample, along the ground.
  double reach_m() const noexcept {
    const std::size_t half_x = count_x / 2;
    const std::size_t half_z = count_z / 2;
    return spacing_m * math::length(static_cast<double>(half_x), static_cast<double>(half_z));
  }
  WindPlace place(std::size_t i, std::size_t j, std::size_t k) const noexcept;
};

/// The field on a grid: all u, then all v, then (of a field of three dimensions) all w; within each z is the slowest
/// axis, then y, then x. `out` holds field.dims() times grid.size() values.
void sample_field(const WindField& field, const Grid& grid, std::span<float> out) noexcept;

}  // namespace yuragi::wind::field
