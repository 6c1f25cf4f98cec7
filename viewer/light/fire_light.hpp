#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace yuragi::viewer::light {

/// A fire as a light source.
struct Fire {
  glm::vec3 place_m{0.0F};
  float radius_m = 0.2F;  ///< distance below which its light does not increase
  glm::vec3 light{0.0F};  ///< illumination of a surface that faces it at one metre, in Light's unit
};

/// The uniform block Fires of viewer/gl/shaders/common.glsl, in its layout (std140): those that are nearest to the eye.
struct Fires {
  static constexpr std::size_t kMost = 4;
  glm::vec4 count{0.0F};  ///< x
  std::array<glm::vec4, kMost> place_radius{};
  std::array<glm::vec4, kMost> light{};
};
Fires nearest_fires(std::span<const Fire> fires, const glm::vec3& eye_m);

/// How bright flames are in a picture of this exposure, 1 by an exposure of 1. A night of these pictures is brighter
/// than a real one by some thousand times (daylight.cpp), and a flame of constant light would be overexposed: so it
/// gets about half of the exposure's gain, in logarithms.
float flame_brightness(float exposure);

/// The light of a fire, which follows its heat, but too slowly to flash. Of a surface that it lights, what the screen
/// shows of each color changes by at most 0.36 of the light's own relative change (the steepest place of the tone curve
/// in finish()), here by less than 0.4375 in a second. More than three flashes are at least seven changes, of 0.1 each
/// or, for red, of 0.0625: so there are never more than three in a second (WCAG 2.2, success criterion 2.3.1), however
/// fast the flame flickers.
class FireFlicker {
 public:
  static constexpr double kFastest_per_s = 1.2;  ///< of its logarithm

  /// Takes the heat, 0 or more, at a time in seconds, in any order. Returns the heat to show.
  float follow(float heat, double time_s);

 private:
  bool has_begun_ = false;
  double time_s_ = 0.0;
  double log_ = 0.0;
};

}  // namespace yuragi::viewer::light
