#include "engine/wind/turbulence/synthetic_wind.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/noise/spectral_noise.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr std::size_t kTileSize = 4096;
constexpr double kFastSample_s = 0.25;  // frequencies from 1/1024 to 2 Hz
constexpr double kSlowSample_s = kFastSample_s * std::numbers::phi;
constexpr double kAcrossToAlong = 0.8;

noise::Tile1 make_tile(std::uint64_t seed) {
  auto tile = noise::make_noise_1d(
      {.size = kTileSize, .beta = 5.0 / 3.0, .meaning = noise::BetaMeaning::kTransect, .seed = seed});
  if (!tile) throw std::logic_error("the synthetic wind's noise tile has a size or slope that is not allowed");
  return std::move(*tile);
}

/// The periodic tile at a place between samples, by the cubic through the four nearest (Catmull and Rom, 1974).
double sample_smoothly(const noise::Tile1& tile, double position) noexcept {
  const auto size = static_cast<double>(tile.size());
  const double wrapped = position - size * std::floor(position / size);
  const auto index = static_cast<std::size_t>(wrapped);
  const double t = wrapped - std::floor(wrapped);
  const auto value = [&](std::size_t offset) {
    return static_cast<double>(tile.values[(index + tile.size() - 1 + offset) % tile.size()]);
  };
  const double a = value(0);
  const double b = value(1);
  const double c = value(2);
  const double d = value(3);
  return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

}  // namespace

double SyntheticWind::Component::at(double time_s) const noexcept {
  return (sample_smoothly(fast, time_s / kFastSample_s) + sample_smoothly(slow, time_s / kSlowSample_s)) /
         std::numbers::sqrt2;
}

SyntheticWind::SyntheticWind(const SyntheticWindSettings& settings)
    : settings_(settings),
      along_(wind_from(1.0, settings.mean_direction_deg)),
      across_{-along_.v_m_s, along_.u_m_s},
      along_noise_{make_tile(4 * settings.seed), make_tile(4 * settings.seed + 1)},
      across_noise_{make_tile(4 * settings.seed + 2), make_tile(4 * settings.seed + 3)} {}

Vector SyntheticWind::at(double time_s) const noexcept {
  const double sigma_m_s = settings_.turbulence_intensity * settings_.mean_speed_m_s;
  const double along_m_s = settings_.mean_speed_m_s + sigma_m_s * along_noise_.at(time_s);
  const double across_m_s = kAcrossToAlong * sigma_m_s * across_noise_.at(time_s);
  return along_m_s * along_ + across_m_s * across_;
}

}  // namespace yuragi::wind::turbulence
