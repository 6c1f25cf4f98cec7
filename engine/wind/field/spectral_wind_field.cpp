#include "engine/wind/field/spectral_wind_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/math/philox.hpp"
#include "engine/math/portable.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/wind/field/von_karman_modes.hpp"

namespace yuragi::wind::field {
namespace {

constexpr std::array<turbulence::WindComponent, 3> kComponents = {
    turbulence::WindComponent::kAlong, turbulence::WindComponent::kAcross, turbulence::WindComponent::kUpward};
/// Relative to u (IEC 61400-1:2005, annex B.2).
constexpr std::array kDeviations = {1.0, 0.8, 0.5};
constexpr std::array kLengths = {1.0, 2.7 / 8.1, 0.66 / 8.1};

constexpr std::size_t kPeriodsPerWay = 256;
constexpr std::size_t kFieldWaySamples = 16 * kPeriodsPerWay / 2;  // 16 in its shortest waves, of two tiles

VonKarmanModes modes_of(const WindFieldSettings& settings, turbulence::WindComponent component) {
  const auto i = static_cast<std::size_t>(component);
  return {component, kDeviations[i] * settings.turbulence_intensity * settings.speed_m_s,
          kLengths[i] * settings.length_m};
}

/// The variance of the wave vectors in the cell of a mode, whose wave numbers are in cycles of the tile.
class CellPower {
 public:
  CellPower(const WindFieldSettings& settings, turbulence::WindComponent component)
      : modes_(modes_of(settings, component)),
        is_space_(settings.dims == 3),
        ahead_(wind_from(1.0, settings.direction_deg)),
        cell_rad_m_(2.0 * std::numbers::pi / (static_cast<double>(settings.samples) * settings.spacing_m)) {}

  double operator()(double x, double z, double y) const {
    // The density curves most for long waves: those cells are divided.
    const double cycles = math::length(x, z, y);
    const int parts = cycles < 0.5 ? (is_space_ ? 32 : 128) : cycles < 3.0 ? 8 : 1;
    const int parts_y = is_space_ ? parts : 1;
    double sum = 0.0;
    for (int j = 0; j < parts_y; ++j) {
      for (int k = 0; k < parts; ++k) {
        for (int i = 0; i < parts; ++i) {
          sum += density(x + middle(i, parts), z + middle(k, parts), y + middle(j, parts_y));
        }
      }
    }
    return sum / (parts * parts * parts_y) * std::pow(cell_rad_m_, is_space_ ? 3.0 : 2.0);
  }

 private:
  static double middle(int part, int parts) { return (part + 0.5) / parts - 0.5; }

  double density(double x, double z, double y) const {
    const double east_rad_m = cell_rad_m_ * x;
    const double north_rad_m = -cell_rad_m_ * z;
    const double along_rad_m = east_rad_m * ahead_.u_m_s + north_rad_m * ahead_.v_m_s;
    const double across_rad_m = north_rad_m * ahead_.u_m_s - east_rad_m * ahead_.v_m_s;
    return is_space_ ? modes_.space_density(along_rad_m, across_rad_m, cell_rad_m_ * y)
                     : modes_.plane_density(along_rad_m, across_rad_m);
  }

  VonKarmanModes modes_;
  bool is_space_;
  Vector ahead_;
  double cell_rad_m_;
};

WindFieldSettings checked(const WindFieldSettings& settings) {
  const auto require = [](bool is_so, const char* rule) {
    if (!is_so) throw std::invalid_argument(std::string("a wind field has ") + rule);
  };
  require(settings.dims == 2 || settings.dims == 3, "2 dimensions or 3");
  require(settings.speed_m_s >= 0.0 && std::isfinite(settings.speed_m_s), "a mean speed of 0 or above");
  require(std::isfinite(settings.direction_deg), "a direction in degrees");
  require(settings.turbulence_intensity >= 0.0 && std::isfinite(settings.turbulence_intensity),
          "a turbulence intensity of 0 or above");
  require(std::abs(settings.stress) <= kMaxStress, "a stress from -0.6 to 0.6");
  require(settings.stress == 0.0 || settings.dims == 3, "a stress in 3 dimensions only");
  require(settings.length_m > 0.0 && std::isfinite(settings.length_m), "a length scale above 0 m");
  require(settings.spacing_m > 0.0 && std::isfinite(settings.spacing_m), "a spacing above 0 m");
  return settings;
}

std::uint64_t seed_of(const WindFieldSettings& settings, turbulence::WindComponent component) {
  constexpr std::array kStreams = {math::stream_id("wind field along"), math::stream_id("wind field across"),
                                   math::stream_id("wind field upward")};
  return settings.seed ^ kStreams[static_cast<std::size_t>(component)];
}

}  // namespace

SpectralWindField::Way SpectralWindField::make_way(const WindFieldSettings& settings,
                                                   turbulence::WindComponent component, std::uint64_t seed) {
  // Waves longer than two tiles, for which the tile has no mode, are in the cell about 0.
  const double way_m = static_cast<double>(kPeriodsPerWay * settings.samples) * settings.spacing_m;
  const double length_m = kLengths[static_cast<std::size_t>(component)] * settings.length_m;
  return {noise::make_noise_1d({.size = kFieldWaySamples,
                                .seed = seed,
                                .integral_scale = std::max(length_m / way_m, noise::kMinNoiseIntegralScale),
                                .to_cycles = kPeriodsPerWay / 2.0})
              .value(),
          std::sqrt(CellPower(settings, component)(0.0, 0.0, 0.0))};
}

/// The likeness of each wave of w to that of u. Most of their power is in different waves, so that with a likeness of 1
/// the stress would be 0.63 to 0.8, depending on the tile's length and resolution.
double SpectralWindField::likeness_of(const WindFieldSettings& settings) {
  if (settings.stress == 0.0 || settings.turbulence_intensity * settings.speed_m_s == 0.0) return 0.0;
  const noise::SharedVariance shared =
      noise::shared_variance(settings.dims, settings.samples, CellPower(settings, turbulence::WindComponent::kAlong),
                             CellPower(settings, turbulence::WindComponent::kUpward));
  const std::uint64_t seed = seed_of(settings, turbulence::WindComponent::kAlong);
  const Way along = make_way(settings, turbulence::WindComponent::kAlong, seed);
  const Way up = make_way(settings, turbulence::WindComponent::kUpward, seed);
  double product = 0.0;
  for (std::size_t i = 0; i < along.noise.size(); ++i) {
    product += static_cast<double>(along.noise.values[i]) * static_cast<double>(up.noise.values[i]);
  }
  const double of_ways = product / static_cast<double>(along.noise.size()) * along.deviation_m_s * up.deviation_m_s;
  const double all = std::sqrt((shared.one + along.deviation_m_s * along.deviation_m_s) *
                               (shared.other + up.deviation_m_s * up.deviation_m_s));
  const double likeness = settings.stress * all / (shared.common + of_ways);
  if (std::abs(likeness) <= 1.0) return likeness;
  throw std::invalid_argument("a wind field of this length and spacing has a stress of at most " +
                              std::to_string(std::abs(settings.stress / likeness)));
}

std::vector<noise::MovingField> SpectralWindField::fields_of(const WindFieldSettings& settings, double likeness) {
  std::vector<noise::MovingField> fields;
  for (std::size_t i = 0; i < static_cast<std::size_t>(settings.dims); ++i) {
    fields.push_back({.power = CellPower(settings, kComponents[i]),
                      .seed = seed_of(settings, kComponents[i]),
                      .likeness = kComponents[i] == turbulence::WindComponent::kUpward ? likeness : 0.0,
                      .like_seed = seed_of(settings, turbulence::WindComponent::kAlong)});
  }
  return fields;
}

SpectralWindField::SpectralWindField(const WindFieldSettings& settings)
    : SpectralWindField(settings, likeness_of(checked(settings))) {}

SpectralWindField::SpectralWindField(const WindFieldSettings& settings, double likeness)
    : period_m_(static_cast<double>(settings.samples) * settings.spacing_m),
      speed_m_s_(settings.speed_m_s),
      stress_(settings.stress),
      ahead_(wind_from(1.0, settings.direction_deg)),
      noise_(settings.dims, settings.samples, fields_of(settings, likeness)) {
  for (int i = 0; i < settings.dims; ++i) {
    const turbulence::WindComponent component = kComponents[static_cast<std::size_t>(i)];
    ways_.push_back(make_way(settings, component, seed_of(settings, component)));
  }
  if (likeness != 0.0) {
    const Way like =
        make_way(settings, turbulence::WindComponent::kUpward, seed_of(settings, turbulence::WindComponent::kAlong));
    const auto own_share = static_cast<float>(std::sqrt(1.0 - likeness * likeness));
    std::vector<float>& up = ways_[2].noise.values;
    for (std::size_t i = 0; i < up.size(); ++i) {
      up[i] = own_share * up[i] + static_cast<float>(likeness) * like.noise.values[i];
    }
  }
  if (settings.evolves) {
    const double turnover_m23_s =
        turbulence::eddy_turnover_m23_s(settings.turbulence_intensity * settings.speed_m_s, settings.length_m);
    const double longest_rad_m = 2.0 * std::numbers::pi / period_m_;
    turning_rad_s_ = turnover_m23_s * math::cube_root(longest_rad_m * longest_rad_m);
  }
  go_to(0.0);
}

void SpectralWindField::go_to(double time_s) noexcept {
  const double way_m = speed_m_s_ * time_s;
  noise_.move_to({way_m * ahead_.u_m_s / period_m_, -way_m * ahead_.v_m_s / period_m_, 0.0}, turning_rad_s_ * time_s);
  // The wind comes from upwind: read at minus the way.
  const std::uint32_t place = noise::torus_phase(-way_m, static_cast<double>(kPeriodsPerWay) * period_m_);
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    now_m_s_[i] = ways_[i].deviation_m_s * static_cast<double>(noise::read_noise(ways_[i].noise, place));
  }
}

WindVector3 SpectralWindField::at(WindPlace place) const noexcept {
  const std::array<double, 3> where = {place.x_m / period_m_, place.z_m / period_m_, place.y_m / period_m_};
  const double along_m_s = speed_m_s_ + now_m_s_[0] + noise_.read(0, where);
  const double across_m_s = now_m_s_[1] + noise_.read(1, where);
  const double up_m_s = dims() == 3 ? now_m_s_[2] + noise_.read(2, where) : 0.0;
  return {along_m_s * ahead_.u_m_s - across_m_s * ahead_.v_m_s, along_m_s * ahead_.v_m_s + across_m_s * ahead_.u_m_s,
          up_m_s};
}

double SpectralWindField::variance_m2_s2(turbulence::WindComponent component) const noexcept {
  const auto i = static_cast<std::size_t>(component);
  if (i >= ways_.size()) return 0.0;
  return noise_.variance(i) + ways_[i].deviation_m_s * ways_[i].deviation_m_s;
}

double SpectralWindField::along_up_covariance_m2_s2() const noexcept {
  return stress_ * std::sqrt(variance_m2_s2(turbulence::WindComponent::kAlong) *
                             variance_m2_s2(turbulence::WindComponent::kUpward));
}

}  // namespace yuragi::wind::field
