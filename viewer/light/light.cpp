#include "viewer/light/light.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace yuragi::viewer::light {
namespace {

constexpr float kNearbyCosine = 0.995F;  // suns within 6 degrees are blended into each other

float luminance(const glm::vec4& light) {
  return 0.2126F * light.r + 0.7152F * light.g + 0.0722F * light.b;
}

/// The direction between two, which can be opposite; w as it is.
glm::vec4 turned(const glm::vec4& a, const glm::vec4& b, float share) {
  const glm::vec3 between = glm::mix(glm::vec3(a), glm::vec3(b), share);
  const float length = glm::length(between);
  return {length > 1e-3F ? between / length : glm::vec3(share < 0.5F ? a : b), glm::mix(a.w, b.w, share)};
}

}  // namespace

Light mixed(const Light& a, const Light& b, float share) {
  Light light;
  constexpr glm::vec4 Light::*kPlain[] = {
      &Light::sun_light,    &Light::sky_light,  &Light::turf_light,  &Light::zenith,     &Light::horizon_near,
      &Light::horizon_far,  &Light::glow_wide,  &Light::glow_narrow, &Light::glow_disc,  &Light::cloud_light,
      &Light::cloud_glow,   &Light::air,        &Light::colors,      &Light::grass_lush, &Light::grass_fresh,
      &Light::grass_straw,  &Light::grass_foot, &Light::leaves,      &Light::woods,      &Light::earth,
      &Light::turned_leaves};
  for (glm::vec4 Light::*const part : kPlain) light.*part = glm::mix(a.*part, b.*part, share);
  for (std::size_t i = 0; i < a.petals.size(); ++i)
    light.petals.at(i) = glm::mix(a.petals.at(i), b.petals.at(i), share);
  light.drift = {b.drift.x, b.drift.y, glm::mix(a.drift.z, b.drift.z, share), glm::mix(a.drift.w, b.drift.w, share)};
  light.moon_disc = turned(a.moon_disc, b.moon_disc, share);
  light.sun_disc = turned(a.sun_disc, b.sun_disc, share);
  light.to_sun = turned(a.to_sun, b.to_sun, share);
  if (glm::dot(glm::vec3(a.to_sun), glm::vec3(b.to_sun)) >= kNearbyCosine) return light;

  const Light& only = share < 0.5F ? a : b;
  const float rest = std::abs(2.0F * share - 1.0F);
  light.to_sun = only.to_sun;
  light.sun_light = rest * only.sun_light;
  light.sun_disc = {glm::vec3(only.sun_disc), rest * only.sun_disc.w};
  light.moon_disc = {glm::vec3(only.moon_disc), rest * only.moon_disc.w};
  for (glm::vec4 Light::*const glow : {&Light::glow_wide, &Light::glow_narrow, &Light::glow_disc, &Light::cloud_glow}) {
    light.*glow = rest * (only.*glow);
  }
  return light;
}

float brightness_of(const Light& light) {
  return luminance(light.sun_light) * (0.35F + 0.4F * std::max(light.to_sun.y, 0.0F)) + luminance(light.sky_light);
}

}  // namespace yuragi::viewer::light
