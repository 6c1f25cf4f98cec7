#include "viewer/light/daylight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

namespace yuragi::viewer::light {
namespace {

/// The clear sky with the sun at a height. Chosen by eye: the evening (8.5 degrees) was set first, and the others
/// follow photographs and skies computed by single scattering: the sun's side goes from white over orange to red, the
/// other side and the zenith stay blue until the stars come out.
struct SkyColors {
  float sun_height_deg;
  glm::vec3 zenith, horizon_near, horizon_far;
  glm::vec3 glow_wide, glow_narrow, glow_disc;
  glm::vec3 cloud_light, cloud_glow;
  glm::vec3 sky_light;
};

const std::array kSkies{
    SkyColors{-18.0F,
              {0.0008F, 0.0015F, 0.0037F},
              {0.0026F, 0.0034F, 0.0060F},
              {0.0022F, 0.0031F, 0.0058F},
              {0.0F, 0.0F, 0.0F},
              {0.0F, 0.0F, 0.0F},
              {0.0F, 0.0F, 0.0F},
              {0.0016F, 0.0023F, 0.0046F},
              {0.0F, 0.0F, 0.0F},
              {0.0075F, 0.0092F, 0.0140F}},
    SkyColors{-12.0F,
              {0.0016F, 0.0036F, 0.0115F},
              {0.0085F, 0.0080F, 0.0135F},
              {0.0036F, 0.0060F, 0.0150F},
              {0.0022F, 0.0008F, 0.0004F},
              {0.0F, 0.0F, 0.0F},
              {0.0F, 0.0F, 0.0F},
              {0.0034F, 0.0045F, 0.0100F},
              {0.001F, 0.0004F, 0.0003F},
              {0.0075F, 0.0090F, 0.0150F}},
    SkyColors{-8.0F,
              {0.0040F, 0.0090F, 0.0290F},
              {0.056F, 0.029F, 0.026F},
              {0.0115F, 0.0155F, 0.036F},
              {0.024F, 0.0080F, 0.0040F},
              {0.0F, 0.0F, 0.0F},
              {0.0F, 0.0F, 0.0F},
              {0.0105F, 0.0118F, 0.0240F},
              {0.022F, 0.0075F, 0.0060F},
              {0.0250F, 0.0270F, 0.0420F}},
    SkyColors{-4.0F,
              {0.012F, 0.028F, 0.087F},
              {0.23F, 0.088F, 0.042F},
              {0.052F, 0.055F, 0.110F},
              {0.16F, 0.044F, 0.010F},
              {0.03F, 0.010F, 0.002F},
              {0.0F, 0.0F, 0.0F},
              {0.046F, 0.044F, 0.074F},
              {0.22F, 0.065F, 0.036F},
              {0.140F, 0.136F, 0.180F}},
    SkyColors{0.0F,
              {0.035F, 0.078F, 0.205F},
              {0.60F, 0.27F, 0.125F},
              {0.225F, 0.180F, 0.255F},
              {0.40F, 0.13F, 0.025F},
              {0.32F, 0.12F, 0.025F},
              {0.35F, 0.14F, 0.03F},
              {0.220F, 0.175F, 0.235F},
              {0.85F, 0.25F, 0.085F},
              {0.260F, 0.245F, 0.310F}},
    SkyColors{3.0F,
              {0.060F, 0.135F, 0.310F},
              {0.70F, 0.40F, 0.22F},
              {0.38F, 0.32F, 0.36F},
              {0.50F, 0.185F, 0.032F},
              {0.55F, 0.28F, 0.08F},
              {0.95F, 0.58F, 0.25F},
              {0.46F, 0.35F, 0.39F},
              {1.20F, 0.43F, 0.12F},
              {0.340F, 0.360F, 0.470F}},
    SkyColors{8.5F,
              {0.10F, 0.22F, 0.47F},
              {0.66F, 0.49F, 0.36F},
              {0.58F, 0.48F, 0.42F},
              {0.44F, 0.20F, 0.04F},
              {0.55F, 0.36F, 0.15F},
              {1.10F, 0.85F, 0.50F},
              {0.72F, 0.56F, 0.53F},
              {1.10F, 0.52F, 0.16F},
              {0.46F, 0.55F, 0.74F}},
    SkyColors{20.0F,
              {0.20F, 0.50F, 1.18F},
              {1.42F, 1.36F, 1.30F},
              {1.12F, 1.24F, 1.42F},
              {0.50F, 0.36F, 0.20F},
              {0.80F, 0.66F, 0.42F},
              {2.20F, 1.90F, 1.50F},
              {1.75F, 1.66F, 1.68F},
              {1.10F, 0.82F, 0.48F},
              {0.76F, 0.95F, 1.30F}},
    SkyColors{45.0F,
              {0.27F, 0.75F, 1.92F},
              {2.05F, 2.35F, 2.70F},
              {1.75F, 2.15F, 2.72F},
              {0.45F, 0.42F, 0.36F},
              {1.10F, 1.02F, 0.86F},
              {4.00F, 3.80F, 3.40F},
              {2.90F, 2.98F, 3.16F},
              {1.10F, 1.00F, 0.82F},
              {0.92F, 1.22F, 1.68F}},
    SkyColors{90.0F,
              {0.33F, 0.88F, 2.20F},
              {2.25F, 2.60F, 3.00F},
              {2.05F, 2.48F, 3.02F},
              {0.45F, 0.44F, 0.40F},
              {1.15F, 1.10F, 1.00F},
              {4.60F, 4.50F, 4.20F},
              {3.20F, 3.30F, 3.50F},
              {1.10F, 1.05F, 0.95F},
              {0.98F, 1.32F, 1.82F}},
};

/// The logarithm is linear between two rows: light spans a factor of a thousand.
glm::vec3 between(const glm::vec3& a, const glm::vec3& b, float share) {
  constexpr float kLeast = 1e-5F;
  return glm::exp(glm::mix(glm::log(a + kLeast), glm::log(b + kLeast), share)) - kLeast;
}

SkyColors clear_sky(float height_deg) {
  if (height_deg <= kSkies.front().sun_height_deg) return kSkies.front();
  if (height_deg >= kSkies.back().sun_height_deg) return kSkies.back();
  const auto above = std::ranges::upper_bound(kSkies, height_deg, {}, &SkyColors::sun_height_deg);
  const auto below = std::prev(above);
  const float share = (height_deg - below->sun_height_deg) / (above->sun_height_deg - below->sun_height_deg);
  SkyColors sky = *below;
  for (glm::vec3 SkyColors::*const part : {&SkyColors::zenith, &SkyColors::horizon_near, &SkyColors::horizon_far,
                                           &SkyColors::glow_wide, &SkyColors::glow_narrow, &SkyColors::glow_disc,
                                           &SkyColors::cloud_light, &SkyColors::cloud_glow, &SkyColors::sky_light}) {
    sky.*part = between((*below).*part, (*above).*part, share);
  }
  return sky;
}

float luminance_of(const glm::vec3& light) {
  return glm::dot(light, glm::vec3(0.2126F, 0.7152F, 0.0722F));
}

/// 0 at `low` and below (or above, where low > high), 1 at `high`.
float rise(double low, double high, double value) {
  const double share = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return static_cast<float>(share * share * (3.0 - 2.0 * share));
}

// Outside of the atmosphere, in Light's unit: chosen so that the evening's sun is as bright as in the painted sky.
constexpr glm::vec3 kSunOutside(13.9F, 12.4F, 11.4F);
// Optical depth of air straight overhead, in the red, green and blue of a screen (610, 540 and 465 nm; w: their
// wavelength in micrometres): molecules, 0.008735 w^-4.08; 0.3 cm of ozone; a little dust, 0.05 w^-1.3.
constexpr glm::vec3 kAirDepth(0.196F, 0.244F, 0.334F);
// Some thousand times brighter than in reality, as a night in a film: a realistic one would be black beside a lamp.
constexpr glm::vec3 kFullMoon(0.075F, 0.088F, 0.112F);
constexpr glm::vec3 kMoonlitSky(0.0016F, 0.0029F, 0.0058F);
constexpr glm::vec3 kTurf(0.055F, 0.065F, 0.022F);  // what it reflects
constexpr glm::vec3 kOvercast(0.93F, 0.99F, 1.06F);
constexpr glm::vec3 kOvercastNight(0.70F, 0.96F, 1.40F);

// The share of the light that an overcast sky lets through. It is less by night, and the sky is drawn darker than its
// light: a grey sky brighter than the land looks like a dim day.
constexpr float kThroughClouds = 0.30F;
constexpr float kThroughCloudsByNight = 0.22F;
constexpr float kNightCloudsSeen = 0.45F;

constexpr float kCloudShadow = 0.6F;  // share of the sun's light that a cloud blocks

}  // namespace

glm::vec3 sunlight_at(double height_deg) {
  if (height_deg <= -1.0) return glm::vec3(0.0F);
  const double height = std::max(height_deg, 0.0);
  const double air_mass =
      1.0 / (std::sin(height * 0.017453292519943295) + 0.50572 * std::pow(height + 6.07995, -1.6364));
  return kSunOutside * glm::exp(-kAirDepth * static_cast<float>(air_mass)) * rise(-1.0, 0.5, height_deg);
}

Light daylight(const Sky& sky) {
  const SkyColors clear = clear_sky(static_cast<float>(sky.sun.height_deg));
  const bool is_night = sky.sun.height_deg < -3.0;
  const float moon = static_cast<float>(std::pow(sky.moon_lit_share, 1.3)) * rise(0.0, 8.0, sky.moon.height_deg);
  const float moon_in_dark = moon * rise(-3.5, -10.0, sky.sun.height_deg);
  const float covered = rise(0.45, 1.0, sky.clouds);

  // Clouds scatter the sunlight that they block over the whole sky, and three quarters of it back up.
  const glm::vec3 direct = is_night ? kFullMoon * moon_in_dark : sunlight_at(sky.sun.height_deg);
  const glm::dvec3 to_sun = direction_of(is_night ? sky.moon : sky.sun);
  const glm::vec3 moonlit = kMoonlitSky * moon_in_dark;
  const float level =
      luminance_of(direct) * static_cast<float>(std::max(to_sun.y, 0.0)) + luminance_of(clear.sky_light + moonlit);
  const float dark = rise(-4.0, -12.0, sky.sun.height_deg);
  const glm::vec3 grey =
      glm::mix(kOvercast, kOvercastNight, dark) * (glm::mix(kThroughClouds, kThroughCloudsByNight, dark) * level);
  const glm::vec3 seen_grey = grey * glm::mix(1.0F, kNightCloudsSeen, dark);

  Light light;
  light.to_sun = glm::vec4(glm::vec3(to_sun), 1.0F - covered);
  light.sun_disc = glm::vec4(glm::vec3(direction_of(sky.sun)), 1.0F - covered);
  light.moon_disc =
      glm::vec4(glm::vec3(direction_of(sky.moon)),
                (1.0F - covered) * rise(0.0, 2.0, sky.moon.height_deg) * (sky.moon_lit_share > 0.0 ? 1.0F : 0.0F));
  const auto set = [](glm::vec4& to, const glm::vec3& color) { to = glm::vec4(color, 0.0F); };
  set(light.sun_light, direct * (1.0F - 0.98F * covered));
  // (An overcast sky is three times as bright overhead as at the horizon: CIE S 011.)
  set(light.zenith, glm::mix(clear.zenith + moonlit, seen_grey * 0.9F, covered));
  set(light.horizon_near, glm::mix(clear.horizon_near + moonlit, seen_grey * 0.6F, covered));
  set(light.horizon_far, glm::mix(clear.horizon_far + moonlit, seen_grey * 0.6F, covered));
  set(light.glow_wide, clear.glow_wide * (1.0F - covered));
  set(light.glow_narrow, clear.glow_narrow * (1.0F - covered));
  set(light.glow_disc, clear.glow_disc * (1.0F - covered));
  set(light.cloud_light, glm::mix(clear.cloud_light + 0.8F * moonlit, seen_grey * 0.65F, covered));
  set(light.cloud_glow, (clear.cloud_glow + 0.35F * kFullMoon * moon_in_dark) * (1.0F - covered));
  set(light.sky_light, glm::mix(clear.sky_light + moonlit, grey, covered));
  set(light.turf_light, kTurf * (0.35F * glm::vec3(light.sun_light) + 2.2F * glm::vec3(light.sky_light)));

  light.colors.y = 1.0F - 0.52F * dark;
  const double haze_per_m = 0.00008 * std::exp(7.6 * sky.haze);
  const double clouds_begin = 0.73 - 0.62 * sky.clouds + 3.0 * std::max(0.0, 0.1 - sky.clouds) -
                              0.28 * static_cast<double>(rise(0.65, 1.0, sky.clouds));
  const float stars = rise(-7.0, -15.0, sky.sun.height_deg) * (1.0F - covered) * (1.0F - 0.6F * moon);
  light.air = {1.0F, static_cast<float>(haze_per_m), static_cast<float>(clouds_begin), stars};
  // Shadows of single clouds: none by night, under an overcast sky, or in fog. Clouds are where the mean of two layers
  // of noise is above clouds_begin; one layer alone has a wider spread.
  const float held_back =
      kCloudShadow * (1.0F - covered) * rise(0.0, 6.0, sky.sun.height_deg) * rise(0.9, 0.5, sky.haze);
  light.drift = {0.0F, 0.0F, held_back, 0.5F + 1.4F * (static_cast<float>(clouds_begin) - 0.45F)};
  return light;
}

}  // namespace yuragi::viewer::light
