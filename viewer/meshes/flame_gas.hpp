#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "viewer/meshes/flame_volume.hpp"

namespace yuragi::viewer::meshes {

/// The burning gas of a flame: the streamed heat enters at the foot, rises, is torn by eddies and by the puffs of the
/// fire, and burns out on its way. Gas that a puff cuts off flies on above the flame.
///
/// A grid in the coordinates of FlameVolume: kAcross x kAcross cells a layer, kLayers layers from the foot to
/// FlameVolume::kReach of the way to the top, so that it bends as the streamed rows do. Advances in fixed steps of time
/// (semi-Lagrangian: J. Stam 1999, "Stable fluids"), so that the same times give the same bits. The first time, and any
/// after a jump, starts settled, as if kSettling_s had passed. Pure; allocates when it is made, never afterwards.
/// Thread-safe: no.
class FlameGas {
 public:
  static constexpr std::size_t kAcross = FlameVolume::kAcross;
  static constexpr std::size_t kLayers = 64;
  static constexpr double kStep_s = 1.0 / 60.0;
  static constexpr double kSettling_s = 2.5;
  static constexpr double kJump_s = 1.0;
  static constexpr double kMaxWind_m_s = 100.0;  ///< a stronger wind counts as this

  /// For a volume that is not empty.
  explicit FlameGas(const FlameVolume& volume);

  /// Advances to a moment; the volume is that moment's. The wind is a speed; one that is negative or not finite counts
  /// as none. A time that is not finite, or beyond any date, changes nothing.
  void advance_to(double time_s, double wind_m_s, const FlameVolume& volume);
  /// Starts again at a moment, settled.
  void settle_at(double time_s, double wind_m_s, const FlameVolume& volume);

  /// Layer after layer from the foot, two bytes a cell: heat and soot, 0 to 255.
  std::span<const std::uint8_t> texels() const { return texels_; }
  /// For each of kLayers layers: the extent of the gas from its middle, as a part of its half side; 0: no gas.
  std::span<const float> extents() const { return extents_; }
  /// The distance that the gas has risen, as a part of the flame's height, modulo kRisenPeriod.
  double risen() const { return risen_; }
  /// A whole number of tiles for each rate at which fire.frag.glsl moves its noise, so that it never jumps.
  static constexpr double kRisenPeriod = 10000.0;

 private:
  struct Cell {
    float heat = 0.0F, soot = 0.0F;
  };
  struct Velocity {
    float x = 0.0F, z = 0.0F, up = 0.0F;
  };

  void step(double time_s, double wind_m_s, const FlameVolume& volume);
  void write_texels(float part);

  double height_m_, width_m_;
  std::vector<Cell> cells_, next_, shown_;
  std::vector<Velocity> eddies_;                    ///< of unit deviation, m/s; repeats after kLayers
  std::array<float, kAcross * kAcross> to_side_{};  ///< how far a cell is from the middle, in half sides
  std::array<float, kLayers> rise_m_s_{}, rises_for_s_{};
  std::vector<std::uint8_t> texels_;
  std::array<float, kLayers> extents_{};
  std::int64_t steps_ = 0;  ///< whole steps since time 0
  double time_s_ = 0.0;
  bool has_begun_ = false;
  double risen_ = 0.0, carried_ = 0.0;
};

}  // namespace yuragi::viewer::meshes
