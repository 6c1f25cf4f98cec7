#pragma once

#include <array>

#include <glm/vec4.hpp>

namespace yuragi::viewer::light {

/// The light of a picture: the uniform block Light of viewer/gl/shaders/common.glsl, in its layout (std140). Linear, in
/// one unit for all: white paper in a light of (1, 1, 1) has the light (1, 1, 1).
struct Light {
  glm::vec4 to_sun{0.0F, 1.0F, 0.0F, 1.0F};     ///< unit vector to sun or moon, the brighter; w: how much of it is seen
  glm::vec4 sun_light{0.0F};                    ///< its illumination of a surface that faces it
  glm::vec4 sky_light{0.0F};                    ///< the sky's on a level surface
  glm::vec4 turf_light{0.0F};                   ///< light of both, reflected by the ground
  glm::vec4 zenith{0.0F};                       ///< the clear sky overhead
  glm::vec4 horizon_near{0.0F};                 ///< at the horizon, on the sun's side
  glm::vec4 horizon_far{0.0F};                  ///< on the other
  glm::vec4 glow_wide{0.0F};                    ///< around the sun: over some 30 degrees
  glm::vec4 glow_narrow{0.0F};                  ///< over some 10
  glm::vec4 glow_disc{0.0F};                    ///< over some 5
  glm::vec4 cloud_light{0.0F};                  ///< a cloud's side that the sun does not light
  glm::vec4 cloud_glow{0.0F};                   ///< the sun's contribution to it
  glm::vec4 sun_disc{0.0F, 1.0F, 0.0F, 0.0F};   ///< unit vector toward the sun, set or not; w: how much of it is seen
  glm::vec4 moon_disc{0.0F, 1.0F, 0.0F, 0.0F};  ///< the same of the moon
  glm::vec4 air{0.0F};  ///< exposure; haze, per metre; the noise value at which clouds begin; brightness of the stars
  /// Drift of the clouds, east and south, in units of their height; the share of the sun's light that their shadows
  /// remove; the noise (0 to 1) above which there is a shadow
  glm::vec4 drift{0.0F};
  /// Saturation of the picture, 0 to 1, and of its dark parts; maximum height of tall grass, 0.25 (a lawn) to 1, 0:
  /// none; exposure of the palette in doublings
  glm::vec4 colors{1.0F, 1.0F, 1.0F, 0.0F};

  // What reflects light (palettes.cpp).
  glm::vec4 grass_lush{0.0F};   ///< color of grass in moist places; w: more straw above 0, less below
  glm::vec4 grass_fresh{0.0F};  ///< in between; w: number of flowers, 1 as in a meadow
  glm::vec4 grass_straw{0.0F};  ///< where it is dry
  glm::vec4 grass_foot{0.0F};   ///< near the ground; w: 1 / the width of the picture on the ground, per metre
  std::array<glm::vec4, 3> petals{};
  glm::vec4 leaves{1.0F};         ///< factor on leaves of trees; w: the share of them that hang, 0 in winter
  glm::vec4 woods{1.0F};          ///< factor on far woods; w: snow on hills, 0 to 1
  glm::vec4 earth{0.0F};          ///< color of bare ground; w: unevenness of its look
  glm::vec4 turned_leaves{1.0F};  ///< factor on those leaves that have turned the farthest; w: free
};

/// From `a` (share 0) to `b` (share 1). If their suns are far apart, one light ends before the other begins, so that no
/// shadow swings around.
Light mixed(const Light& a, const Light& b, float share);

/// Brightness of a grey surface in this light, from which the exposure is computed.
float brightness_of(const Light& light);

}  // namespace yuragi::viewer::light
