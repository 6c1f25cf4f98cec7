#pragma once

#include <array>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "viewer/meshes/flame_volume.hpp"

namespace yuragi::viewer::meshes {

/// A glowing spark, in the layout that the shader reads.
struct Spark {
  glm::vec3 place_m{0.0F};
  float glow = 0.0F;         ///< 0 to 1
  glm::vec3 before_m{0.0F};  ///< its position kBlur_s before
  float radius_m = 0.0F;
};

/// The sparks that leave a flame: each rises with the gas, drifts with the wind, and goes out. Its birth and its
/// movement depend on the time alone; only the wind's path since then, and the flame's position, are stored. Allocates
/// nothing. Pure.
class Sparks {
 public:
  static constexpr std::size_t kMost = 40;
  static constexpr double kBlur_s = 0.012;

  /// The wind goes toward east and south. After a jump in time, or with another wind at the
  /// same time, this wind counts as if it had always blown.
  void move_to(double time_s, const glm::vec2& wind_m_s, const FlameVolume& flame);
  std::span<const Spark> all() const { return sparks_; }

 private:
  struct Flight {
    double number = -1.0;  ///< count of all sparks of its place
    glm::vec3 from_m{0.0F};
    glm::dvec2 way_m{0.0};  ///< the wind's, when it was born
  };
  std::array<Flight, kMost> flights_;
  std::array<Spark, kMost> sparks_;
  glm::dvec2 way_m_{0.0};
  double time_s_ = 0.0;
  glm::vec2 wind_m_s_{0.0F};
  bool has_begun_ = false;
};

}  // namespace yuragi::viewer::meshes
