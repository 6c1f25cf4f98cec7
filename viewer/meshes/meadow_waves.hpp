#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace yuragi::viewer::meshes {

/// Waves of gusts over the grass of scenes without streamed ground: a square tile of bends that travels downwind at the
/// wind's speed and repeats without a seam. They are synthetic, because the stream has gusts at one place only. Pure:
/// the same steps give the same state. The first step, and one back in time, starts settled in that wind.
class MeadowWaves {
 public:
  static constexpr std::size_t kNodes = 64;    ///< a side
  static constexpr float kSide_m = 96.0F;      ///< of the tile
  static constexpr float kSettling_s = 3.0F;   ///< time constant with which the grass follows the wind's mean
  static constexpr float kTurbulence = 0.24F;  ///< standard deviation of the speed, as a part of the mean

  MeadowWaves();

  /// Advances to a moment with this wind toward east and south. Allocates nothing. The same moment changes nothing.
  void advance_to(double time_s, const glm::vec2& wind_m_s);
  /// Fills `bends` (kNodes rows of kNodes, from the tile's corner) for grass that is bent by `mean` on the average:
  /// east, south, radians.
  void fill(const glm::vec2& mean, std::span<glm::vec2> bends) const;

  /// How far grass is bent by the mean wind: east, south, radians.
  glm::vec2 mean_bend() const;
  /// The tile's corner: how far the waves have travelled, metres, modulo the tile's side.
  const glm::vec2& drifted_m() const { return drifted_m_; }

 private:
  std::vector<float> gusts_;  ///< of the nodes; mean 0, standard deviation 1
  bool is_settled_ = false;
  double time_s_ = 0.0;
  glm::vec2 wind_m_s_{0.0F}, drifted_m_{0.0F};
};

}  // namespace yuragi::viewer::meshes
