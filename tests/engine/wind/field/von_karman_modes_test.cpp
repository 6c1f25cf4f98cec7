#include "engine/wind/field/von_karman_modes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/wind_coherence.hpp"

namespace yuragi::wind::field {
namespace {

constexpr double kModesSigma_m_s = 1.6;
constexpr double kModesLength_m = 57.0;

/// The integral over all k, both signs, of an even function that is smooth on the scale of 1 / L.
template <class Function>
double over_all_waves(Function function) {
  // k = sinh(s) / L: even steps of s.
  constexpr int kSteps = 900;
  constexpr double kLast = 18.0;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double s = kLast * i / kSteps;
    const double weight = i == 0 || i == kSteps ? 0.5 : 1.0;
    sum += weight * function(std::sinh(s) / kModesLength_m) * std::cosh(s) / kModesLength_m;
  }
  return 2.0 * sum * kLast / kSteps;
}

TEST(VonKarmanModes, ALineThroughThePlaneHasVonKarmansSpectrum) {
  for (const turbulence::WindComponent component :
       {turbulence::WindComponent::kAlong, turbulence::WindComponent::kAcross}) {
    const VonKarmanModes modes(component, kModesSigma_m_s, kModesLength_m);
    // WindSpectrum takes the length of u, of which that of v is half.
    const double length_of_u_m = component == turbulence::WindComponent::kAlong ? kModesLength_m : 2.0 * kModesLength_m;
    constexpr double kSpeed_m_s = 7.0;
    const turbulence::WindSpectrum spectrum =
        turbulence::WindSpectrum::make(
            {.component = component, .speed_m_s = kSpeed_m_s, .sigma_m_s = kModesSigma_m_s, .length_m = length_of_u_m})
            .value();
    for (const double frequency_hz : {0.001, 0.01, 0.03, 0.1, 1.0, 5.0}) {
      const double along_rad_m = 2.0 * std::numbers::pi * frequency_hz / kSpeed_m_s;
      const double line = over_all_waves([&](double across) { return modes.plane_density(along_rad_m, across); });
      const double density = 2.0 * line * 2.0 * std::numbers::pi / kSpeed_m_s;  // one-sided, and of frequency
      EXPECT_NEAR(density / spectrum.density_m2_s2_hz(frequency_hz), 1.0, 0.01) << frequency_hz;
    }
  }
}

TEST(VonKarmanModes, ALevelPlaneCutsThePlanesDensityOutOfSpace) {
  for (const turbulence::WindComponent component :
       {turbulence::WindComponent::kAlong, turbulence::WindComponent::kAcross}) {
    const VonKarmanModes modes(component, kModesSigma_m_s, kModesLength_m);
    for (const double along_rad_m : {0.0, 0.01, 0.3}) {
      for (const double across_rad_m : {0.005, 0.2}) {
        const double cut =
            over_all_waves([&](double up) { return modes.space_density(along_rad_m, across_rad_m, up); });
        EXPECT_NEAR(cut / modes.plane_density(along_rad_m, across_rad_m), 1.0, 1e-6);
      }
    }
  }
}

TEST(VonKarmanModes, AllWavesTogetherHaveTheVariance) {
  const VonKarmanModes u(turbulence::WindComponent::kAlong, kModesSigma_m_s, kModesLength_m);
  const double variance = over_all_waves(
      [&](double along) { return over_all_waves([&](double across) { return u.plane_density(along, across); }); });
  EXPECT_NEAR(variance, kModesSigma_m_s * kModesSigma_m_s, 1e-3);

  // Upward is across as well: the same density, turned.
  const VonKarmanModes v(turbulence::WindComponent::kAcross, kModesSigma_m_s, kModesLength_m);
  const VonKarmanModes w(turbulence::WindComponent::kUpward, kModesSigma_m_s, kModesLength_m);
  EXPECT_DOUBLE_EQ(w.space_density(0.1, 0.2, 0.3), v.space_density(0.1, 0.3, 0.2));
}

TEST(VonKarmanCoherence, IsThatOfItsModes) {
  const VonKarmanModes modes(turbulence::WindComponent::kAlong, kModesSigma_m_s, kModesLength_m);
  for (const double along_rad_m : {0.0, 0.02, 0.3}) {
    const double power = over_all_waves([&](double across) { return modes.plane_density(along_rad_m, across); });
    for (const double distance_m : {0.5, 3.0}) {
      const double together = over_all_waves([&](double across) {
        // The tail of the fast oscillation is not resolved, and has nothing to add.
        return across * distance_m < 60.0 ? modes.plane_density(along_rad_m, across) * std::cos(across * distance_m)
                                          : 0.0;
      });
      EXPECT_NEAR(von_karman_coherence(along_rad_m, distance_m, kModesLength_m), together / power, 0.01);
    }
  }
  EXPECT_EQ(von_karman_coherence(0.3, 0.0, kModesLength_m), 1.0);
  EXPECT_EQ(von_karman_coherence(1e6, 1e6, kModesLength_m), 0.0);
}

TEST(VonKarmanCoherence, IsNearDavenports) {
  constexpr double kDistance_m = 0.5;  // small against L
  for (double reduced = 0.005; reduced < 2.0; reduced *= 1.1) {
    const double along_rad_m = 2.0 * std::numbers::pi * reduced / kDistance_m;
    const double coherence = von_karman_coherence(along_rad_m, kDistance_m, kModesLength_m);
    EXPECT_NEAR(coherence, davenport_coherence(reduced, kDistance_m, kDistance_m, 7.0), 0.095) << reduced;
    EXPECT_NEAR(coherence, davenport_coherence(reduced, kDistance_m, kDistance_m, 10.0), 0.2) << reduced;
  }
}

}  // namespace
}  // namespace yuragi::wind::field
