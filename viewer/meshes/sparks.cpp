#include "viewer/meshes/sparks.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr double kJump_s = 0.5;
constexpr double kShortest_s = 0.7, kLongest_s = 2.3;
/// Gas above a fire rises at this part of sqrt(g h) (B. McCaffrey 1979, "Purely buoyant diffusion flames": 1.9 sqrt(z)
/// m/s up to 2.2 m/s and more for small fires), and slows down within this many seconds.
constexpr double kRise = 0.75;
constexpr double kGravity_m_s2 = 9.81;
constexpr double kSlowing_s = 1.1;
constexpr double kGoesWithWind = 0.75;
constexpr double kShareThatGlows = 0.6;
constexpr float kMinHeat = 0.1F;

/// A chance from 0 to 1 for a property of the n-th spark of a place.
double chance(std::size_t place, double number, std::uint64_t which) {
  const math::RandomStream random(place, math::stream_id("sparks") + which);
  return random.uniform(2 * static_cast<std::uint64_t>(static_cast<std::int64_t>(number)));
}

}  // namespace

void Sparks::move_to(double time_s, const glm::vec2& wind_m_s, const FlameVolume& flame) {
  const glm::dvec2 wind(wind_m_s);
  const double passed_s = time_s - time_s_;
  // Another wind at the same time belongs to another stream, or a test.
  const bool is_other = passed_s == 0.0 && wind_m_s != wind_m_s_;
  const bool has_jumped = !has_begun_ || is_other || std::abs(passed_s) > kJump_s;
  if (!has_jumped) way_m_ += passed_s * wind;
  time_s_ = time_s;
  wind_m_s_ = wind_m_s;
  has_begun_ = true;
  const double rise_m_s = kRise * std::sqrt(kGravity_m_s2 * static_cast<double>(flame.height_m()));

  for (std::size_t i = 0; i < kMost; ++i) {
    Spark& spark = sparks_[i];
    Flight& flight = flights_[i];
    const double life_s = kShortest_s + (kLongest_s - kShortest_s) * chance(i, 0.0, 0);
    const double turns = time_s / life_s + chance(i, 0.0, 1);
    const double number = std::floor(turns);
    const double age_s = (turns - number) * life_s;
    const auto of = [&](std::uint64_t which) { return chance(i, number, which); };
    if (flight.number != number || has_jumped) {
      const auto turn_rad = static_cast<float>(2.0 * kPi * of(2));
      const float radius_m = flame.thickest_m() * 0.7F * std::sqrt(static_cast<float>(of(3)));
      flight.number = number;
      flight.from_m = flame.is_empty() ? glm::vec3(0.0F)
                                       : flame.place_m(radius_m * std::cos(turn_rad), radius_m * std::sin(turn_rad),
                                                       0.15F + 0.7F * static_cast<float>(of(4)));
      flight.way_m = way_m_ - age_s * wind;
    }

    const double wave_rad = 2.0 * kPi * of(5);
    const double waves_per_s = 0.6 + 1.2 * of(6);
    const double rises_m_s = rise_m_s * (0.45 + 0.75 * of(7));
    const auto place_at = [&](double at_s, const glm::dvec2& drift_m) {
      const double up_m = rises_m_s * kSlowing_s * (1.0 - std::exp(-at_s / kSlowing_s));
      const double aside_m = 0.10 * at_s;
      const double turn_rad = 2.0 * kPi * waves_per_s * at_s + wave_rad;
      return flight.from_m +
             glm::vec3(drift_m.x + aside_m * std::sin(turn_rad), up_m, drift_m.y + aside_m * std::cos(0.8 * turn_rad));
    };
    // A spark reaches the wind's speed within its first half second.
    const double held = kGoesWithWind * (1.0 - std::exp(-2.0 * age_s));
    const glm::dvec2 drift_m = held * (way_m_ - flight.way_m);
    spark.place_m = place_at(age_s, drift_m);
    spark.before_m = place_at(std::max(age_s - kBlur_s, 0.0), drift_m - held * kBlur_s * wind);
    const double left = 1.0 - age_s / life_s;
    const double lit = of(8) < kShareThatGlows && flame.mean_heat() > kMinHeat ? 1.0 : 0.0;
    spark.glow = static_cast<float>(lit * left * std::sqrt(left) * std::min(1.0, 12.0 * age_s) *
                                    (0.8 + 0.2 * std::sin(23.0 * age_s + wave_rad)));
    spark.radius_m = 0.0014F + 0.0016F * static_cast<float>(of(9));
  }
}

}  // namespace yuragi::viewer::meshes
