#include "engine/scenes/meadow.hpp"

#include <algorithm>
#include <bit>
#include <string_view>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/math/trig.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/scenes/blank_strands.hpp"

namespace yuragi::scenes {
namespace {

/// Small, as in the paper for grass: close to white, with a hint of patches.
constexpr double kLayoutBeta = 0.7;

/// One property of all blades: a noise of mean 0 and variance 1, a sample a blade.
noise::Tile2 layout_noise(const MeadowSpec& spec, std::string_view property) {
  const std::size_t size = std::bit_ceil(std::max({spec.blades_across, spec.blades_deep, noise::kMinNoiseSize}));
  return noise::make_noise_2d({.size = size,
                               .beta = kLayoutBeta,
                               .meaning = noise::BetaMeaning::kRadial,
                               .seed = spec.seed ^ math::stream_id(property)})
      .value();
}

/// `mean` with relative fluctuations of standard deviation `variation`, limited to `low` and `high` times the mean.
float varied(double mean, double variation, float noise, double low, double high) {
  return static_cast<float>(mean * std::clamp(1.0 + variation * static_cast<double>(noise), low, high));
}

}  // namespace

Meadow make_meadow(const MeadowSpec& spec) {
  const std::size_t count = spec.blades_across * spec.blades_deep;
  Meadow meadow{blank_strands(count, spec.links), {}};
  meadow.flexibility.assign(meadow.skeleton.padded_count(), 0.0F);
  const noise::Tile2 x_noise = layout_noise(spec, "meadow x");
  const noise::Tile2 z_noise = layout_noise(spec, "meadow z");
  const noise::Tile2 length_noise = layout_noise(spec, "meadow length");
  const noise::Tile2 heading_noise = layout_noise(spec, "meadow heading");
  const noise::Tile2 tilt_noise = layout_noise(spec, "meadow tilt");
  const noise::Tile2 curl_noise = layout_noise(spec, "meadow curl");

  const double pitch_x_m = spec.width_m / static_cast<double>(spec.blades_across);
  const double pitch_z_m = spec.depth_m / static_cast<double>(spec.blades_deep);
  for (std::size_t strand = 0; strand < count; ++strand) {
    const std::size_t across = strand % spec.blades_across;
    const std::size_t deep = strand / spec.blades_across;
    pose::StrandSkeleton& skeleton = meadow.skeleton;

    // Place: a grid, with a random displacement of each blade by up to one and a half cells.
    const double stray_x = std::clamp(0.45 * static_cast<double>(x_noise.at(across, deep)), -1.5, 1.5);
    const double stray_z = std::clamp(0.45 * static_cast<double>(z_noise.at(across, deep)), -1.5, 1.5);
    skeleton.root_x_m[strand] =
        static_cast<float>((static_cast<double>(across) + 0.5 + stray_x) * pitch_x_m - 0.5 * spec.width_m);
    skeleton.root_z_m[strand] =
        static_cast<float>((static_cast<double>(deep) + 0.5 + stray_z) * pitch_z_m - 0.5 * spec.depth_m);

    // Rest: tilted toward the heading, and drooping further that way from link to link.
    const float heading_rad = static_cast<float>(
        (spec.heading_deg + spec.heading_spread_deg * static_cast<double>(heading_noise.at(across, deep))) *
        kRadPerDeg);
    const math::SinCos heading = math::sin_cos(heading_rad);
    const math::SinCos tilt =
        math::sin_cos(varied(spec.tilt_deg * kRadPerDeg, 0.4, tilt_noise.at(across, deep), 0.0, 2.0));
    skeleton.rest_x[strand] = tilt.sin * heading.sin;
    skeleton.rest_y[strand] = tilt.cos;
    skeleton.rest_z[strand] = -tilt.sin * heading.cos;
    skeleton.curl_x[strand] = tilt.cos * heading.sin;
    skeleton.curl_y[strand] = -tilt.sin;
    skeleton.curl_z[strand] = -tilt.cos * heading.cos;
    const double links = static_cast<double>(spec.links);
    skeleton.rest_curl_rad[strand] =
        varied(spec.curl_deg * kRadPerDeg / links, 0.5, curl_noise.at(across, deep), 0.0, 2.5);

    // Length, and with it flexibility.
    const float length_m = varied(spec.length_m, spec.length_variation, length_noise.at(across, deep), 0.35, 1.8);
    skeleton.link_length_m[strand] = length_m / static_cast<float>(links);
    const float stiffness_noise = tilt_noise.at(across, deep) * curl_noise.at(across, deep);
    meadow.flexibility[strand] = varied(static_cast<double>(length_m) / spec.length_m, 0.2, stiffness_noise, 0.5, 1.5);
  }
  return meadow;
}

}  // namespace yuragi::scenes
