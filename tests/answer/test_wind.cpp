#include "tests/answer/test_wind.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "engine/wind/turbulence/gust_variances.hpp"

namespace yuragi::answer {
namespace {

/// As the daemon has it: at their own full rate eddies would lose more along the way than measured gusts do.
constexpr double kTurnoverShare = 0.5;

bool is_short(const wind::turbulence::GustNoise::Octave& octave, double shortest_wave_m) {
  const double middle_rad_m = std::sqrt(octave.from_rad_m * octave.to_rad_m);
  return 2.0 * std::numbers::pi / middle_rad_m < shortest_wave_m;
}

}  // namespace

TestWind::TestWind(std::shared_ptr<const wind::turbulence::GustNoise> noise, const TestWindSettings& settings)
    : noise_(std::move(noise)),
      mean_(wind::wind_from(settings.speed_m_s, settings.direction_deg)),
      turnover_m23_s_(kTurnoverShare * wind::turbulence::eddy_turnover_m23_s(settings.intensity * settings.speed_m_s,
                                                                             settings.length_m)) {
  const wind::turbulence::GustVariances variances =
      wind::turbulence::gust_variances(*noise_, settings.intensity, settings.length_m);
  wind_.gusts.ahead = wind::wind_from(1.0, settings.direction_deg);
  wind_.advection = mean_;
  wind_.gusts.carried = noise_->begin(settings.seed);
  for (std::size_t i = 0; i < wind::turbulence::GustNoise::kOctaves; ++i) {
    if (is_short(noise_->octaves()[i], settings.shortest_wave_m)) continue;
    const double along_m_s = settings.speed_m_s * std::sqrt(variances[i]);
    wind_.gusts.along_m_s[i] = static_cast<float>(along_m_s);
    wind_.gusts.across_m_s[i] = static_cast<float>(wind::turbulence::kAcrossPerAlong * along_m_s);
  }
  wind_.everywhere = mean_ + noise_->everywhere(wind_.gusts);
}

const wind::ground::Wind& TestWind::step(double dt_s) noexcept {
  noise_->carry(wind_.gusts.carried, mean_.u_m_s, -mean_.v_m_s, dt_s, turnover_m23_s_);
  wind_.everywhere = mean_ + noise_->everywhere(wind_.gusts);
  wind_.tick = ++tick_;
  return wind_;
}

std::shared_ptr<const wind::turbulence::GustNoise> test_gusts() {
  static const auto kGusts = std::make_shared<const wind::turbulence::GustNoise>(
      wind::turbulence::GustNoiseSettings{.seed = 1, .evolves = true});
  return kGusts;
}

std::uint64_t wind_seed(std::size_t beaufort_index) noexcept {
  constexpr std::array<std::uint64_t, kBeauforts> kSeeds = {47, 26, 53, 22};
  return kSeeds[beaufort_index];
}

}  // namespace yuragi::answer
