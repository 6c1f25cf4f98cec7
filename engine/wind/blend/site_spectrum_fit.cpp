#include "engine/wind/blend/site_spectrum_fit.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::wind::blend {
namespace {

/// The interval of the simulated slow sensor: it resolves no waves above 0.37 over this, 0.026 Hz.
constexpr double kPlayedInterval_s = 14.0;
constexpr double kMinFitted_m_s = 1.0;
/// Minimum number of differences of neighbouring means that the fit must have seen.
constexpr double kEnough = 15.0;
/// Haar's differences of means over tau respond most to waves of 0.37 / tau.
constexpr double kSeenTimesTau = 0.37;
/// Maximum distance of an octave above the fastest scale, in octaves.
constexpr double kBeyond_octaves = 0.5;

}  // namespace

SiteSpectrumFit::SiteSpectrumFit(const turbulence::Prior& prior, double fit_memory_s) : slow_(prior, fit_memory_s) {}

void SiteSpectrumFit::break_off() noexcept {
  slow_.break_off();
  sum_ = {};
  count_ = 0;
}

void SiteSpectrumFit::observe(const Observation& observation, const turbulence::WindTurbulence& quick,
                              turbulence::SiteSpectrum& site) noexcept {
  if (observation.interval_s > turbulence::SiteSpectrum::kQuick_s || !(observation.interval_s > 0.0) ||
      !(observation.speed_m_s > 0.0))
    return;
  sum_ = sum_ + observation.wind;
  ++count_;
  const double played_s = static_cast<double>(count_) * observation.interval_s;
  if (played_s < kPlayedInterval_s - 0.5 * observation.interval_s) return;
  slow_.forget(played_s);
  slow_.take((1.0 / static_cast<double>(count_)) * sum_, observation.ahead, observation.speed_m_s,
             observation.has_across);
  slow_.fit(kPlayedInterval_s, observation.speed_m_s);
  sum_ = {};
  count_ = 0;
  if (observation.speed_m_s >= kMinFitted_m_s && slow_.along().observations(0) >= kEnough)
    update(observation, quick, site);
}

void SiteSpectrumFit::update(const Observation& observation, const turbulence::WindTurbulence& quick,
                             turbulence::SiteSpectrum& site) const noexcept {
  const auto of_both = [&observation](const turbulence::WindTurbulence& turbulence, const auto& power_of) {
    return power_of(turbulence.along()) + (observation.has_across ? power_of(turbulence.across()) : 0.0);
  };
  for (std::size_t octave = 0; octave < turbulence::SiteSpectrum::kOctaves; ++octave) {
    // Its place among the fast source's scales, means over interval * 2^scale.
    const double tau_s = kSeenTimesTau / turbulence::SiteSpectrum::centre_hz(octave);
    const double place = std::log2(tau_s / observation.interval_s);
    if (place < -kBeyond_octaves || place > static_cast<double>(turbulence::Fit::kScales - 2)) continue;
    const double inside = std::max(place, 0.0);
    const auto below = static_cast<std::size_t>(inside);
    const double t = inside - static_cast<double>(below);
    const auto measured = [&](std::size_t scale) {
      const double seen_tau_s = std::ldexp(observation.interval_s, static_cast<int>(scale));
      return std::log10(of_both(quick, [&](const turbulence::Fit& fit) { return fit.measured(scale); }) /
                        of_both(slow_, [&](const turbulence::Fit& fit) { return fit.expected(seen_tau_s); }));
    };
    const double low = measured(below);
    const double excess_db = 10.0 * (t > 0.0 ? low + t * (measured(below + 1) - low) : low);
    site.learn(octave, excess_db, kPlayedInterval_s);  // a number that is not finite is ignored
  }
}

}  // namespace yuragi::wind::blend
