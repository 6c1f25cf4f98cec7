#include "engine/wind/turbulence/wind_spectrum.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "engine/wind/turbulence/wind_profile.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// The integral of f S over ln f from far below to far above all that matters, by the trapezium rule: of a smooth
/// function that vanishes at both ends it is as good as exact.
double summed_variance_m2_s2(const WindSpectrum& spectrum) {
  constexpr int kStepsPerUnit = 50;
  double sum = 0.0;
  for (int k = -60 * kStepsPerUnit; k <= 60 * kStepsPerUnit; ++k) {
    const double f = std::exp(static_cast<double>(k) / kStepsPerUnit);
    sum += f * spectrum.density_m2_s2_hz(f) / kStepsPerUnit;
  }
  return sum;
}

WindSpectrum spectrum_of(const SpectrumSettings& settings) {
  return WindSpectrum::make(settings).value();
}

TEST(WindSpectrum, HoldsTheVarianceThatItsClosedFormSays) {
  for (std::size_t model = 0; model < kSpectrumModelNames.size(); ++model) {
    for (std::size_t component = 0; component < kWindComponentNames.size(); ++component) {
      SpectrumSettings settings{.model = static_cast<SpectrumModel>(model),
                                .component = static_cast<WindComponent>(component),
                                .speed_m_s = 11.0,
                                .height_m = 25.0,
                                .sigma_m_s = 1.7};
      const auto made = WindSpectrum::make(settings);
      if (settings.model == SpectrumModel::kDavenport && component > 0) {
        ASSERT_FALSE(made.has_value());
        EXPECT_EQ(made.error(), SpectrumError::kNoSuchComponent);
        continue;
      }
      SCOPED_TRACE(std::string(kSpectrumModelNames[model]) + " " + std::string(kWindComponentNames[component]));
      EXPECT_NEAR(summed_variance_m2_s2(*made) / made->variance_m2_s2(), 1.0, 1e-7);
      // The constants of von Karman's are printed with three or four digits.
      EXPECT_NEAR(made->variance_m2_s2() / (1.7 * 1.7), 1.0, 5e-4);
    }
  }
}

TEST(WindSpectrum, IsItsFormula) {
  const double f = 0.13;
  const double u = 9.0;
  const double z = 12.0;
  const double n = f * z / u;
  const auto with_friction = [&](SpectrumModel model, WindComponent component) {
    return spectrum_of(
               {.model = model, .component = component, .speed_m_s = u, .height_m = z, .friction_velocity_m_s = 0.5})
               .density_m2_s2_hz(f) *
           f / 0.25;
  };
  EXPECT_NEAR(with_friction(SpectrumModel::kSimiu, WindComponent::kAlong), 200 * n / std::pow(1 + 50 * n, 5.0 / 3),
              1e-12);
  EXPECT_NEAR(with_friction(SpectrumModel::kSimiu, WindComponent::kAcross), 15 * n / std::pow(1 + 9.5 * n, 5.0 / 3),
              1e-12);
  EXPECT_NEAR(with_friction(SpectrumModel::kSimiu, WindComponent::kUpward), 3.36 * n / (1 + 10 * std::pow(n, 5.0 / 3)),
              1e-12);
  EXPECT_NEAR(with_friction(SpectrumModel::kKaimal, WindComponent::kAlong), 105 * n / std::pow(1 + 33 * n, 5.0 / 3),
              1e-12);
  EXPECT_NEAR(with_friction(SpectrumModel::kKaimal, WindComponent::kAcross), 17 * n / std::pow(1 + 9.5 * n, 5.0 / 3),
              1e-12);
  EXPECT_NEAR(with_friction(SpectrumModel::kKaimal, WindComponent::kUpward), 2.1 * n / (1 + 5.3 * std::pow(n, 5.0 / 3)),
              1e-12);
  const double x = 1200 * f / u;
  EXPECT_NEAR(with_friction(SpectrumModel::kDavenport, WindComponent::kAlong), 4 * x * x / std::pow(1 + x * x, 4.0 / 3),
              1e-12);

  const double sigma = 1.3;
  const double length = 90.0;
  const auto with_sigma = [&](SpectrumModel model, WindComponent component) {
    return spectrum_of({.model = model,
                        .component = component,
                        .speed_m_s = u,
                        .height_m = z,
                        .sigma_m_s = sigma,
                        .length_m = length})
               .density_m2_s2_hz(f) *
           f / (sigma * sigma);
  };
  const double xu = f * length / u;
  EXPECT_NEAR(with_sigma(SpectrumModel::kVonKarman, WindComponent::kAlong),
              4 * xu / std::pow(1 + 70.8 * xu * xu, 5.0 / 6), 1e-12);
  const double xv = 0.5 * xu;
  for (const auto component : {WindComponent::kAcross, WindComponent::kUpward}) {
    EXPECT_NEAR(with_sigma(SpectrumModel::kVonKarman, component),
                4 * xv * (1 + 755.2 * xv * xv) / std::pow(1 + 283.2 * xv * xv, 11.0 / 6), 1e-12);
  }
  for (const auto& [component, share] :
       {std::pair(WindComponent::kAlong, 1.0), std::pair(WindComponent::kAcross, 2.7 / 8.1),
        std::pair(WindComponent::kUpward, 0.66 / 8.1)}) {
    EXPECT_NEAR(with_sigma(SpectrumModel::kIecKaimal, component),
                4 * share * xu / std::pow(1 + 6 * share * xu, 5.0 / 3), 1e-12);
  }
}

TEST(WindSpectrum, FallsAsTheFiveThirdsLawFarUp) {
  for (const auto model : {SpectrumModel::kSimiu, SpectrumModel::kKaimal, SpectrumModel::kDavenport,
                           SpectrumModel::kVonKarman, SpectrumModel::kIecKaimal}) {
    const WindSpectrum spectrum = spectrum_of({.model = model});
    const double slope = std::log(spectrum.density_m2_s2_hz(2e6) / spectrum.density_m2_s2_hz(1e6)) / std::log(2.0);
    EXPECT_NEAR(slope, -5.0 / 3.0, 1e-3);
    EXPECT_TRUE(std::isfinite(spectrum.density_m2_s2_hz(0.0)));
  }
}

TEST(WindSpectrum, TakesWhatIsLeftOutFromTheProfileAndTheNormalTurbulenceModel) {
  const double friction = friction_velocity_m_s(8.0, 10.0, 0.03);
  EXPECT_NEAR(spectrum_of({.model = SpectrumModel::kSimiu}).variance_m2_s2(), 6.0 * friction * friction, 1e-12);
  EXPECT_NEAR(spectrum_of({.model = SpectrumModel::kDavenport, .height_m = 80.0}).variance_m2_s2(),
              6.0 * friction * friction, 1e-12)
      << "its speed is that at 10 m";
  const double sigma = 0.14 * (0.75 * 8.0 + 5.6);
  EXPECT_NEAR(spectrum_of({.model = SpectrumModel::kIecKaimal}).variance_m2_s2(), sigma * sigma, 1e-12);
  EXPECT_NEAR(spectrum_of({.model = SpectrumModel::kIecKaimal, .component = WindComponent::kUpward}).variance_m2_s2(),
              0.25 * sigma * sigma, 1e-12);
  EXPECT_NEAR(spectrum_of({.model = SpectrumModel::kIecKaimal, .friction_velocity_m_s = 1.0}).variance_m2_s2(),
              2.39 * 2.39, 1e-12);
}

TEST(WindSpectrum, RefusesWhatHasNoMeaning) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto error_of = [](const SpectrumSettings& settings) { return WindSpectrum::make(settings).error(); };
  EXPECT_EQ(error_of({.speed_m_s = 0.0}), SpectrumError::kSpeedOutOfRange);
  EXPECT_EQ(error_of({.speed_m_s = nan}), SpectrumError::kSpeedOutOfRange);
  EXPECT_EQ(error_of({.height_m = -1.0}), SpectrumError::kHeightOutOfRange);
  EXPECT_EQ(error_of({.model = SpectrumModel::kSimiu, .height_m = 0.02}), SpectrumError::kHeightOutOfRange);
  EXPECT_EQ(error_of({.sigma_m_s = -1.0}), SpectrumError::kSigmaOutOfRange);
  EXPECT_EQ(error_of({.sigma_m_s = 1.0, .friction_velocity_m_s = 1.0}), SpectrumError::kSigmaOutOfRange);
  EXPECT_EQ(error_of({.friction_velocity_m_s = kEndless}), SpectrumError::kFrictionVelocityOutOfRange);
  EXPECT_EQ(error_of({.length_m = 0.0}), SpectrumError::kLengthOutOfRange);
  EXPECT_EQ(error_of({.model = SpectrumModel::kKaimal, .length_m = 50.0}), SpectrumError::kLengthOutOfRange);
}

/// The energy of the IEC's Kaimal spectrum between two frequencies (0 to infinity) in closed form, of a component with
/// standard deviation `sigma_m_s` and time scale T = L / U.
double iec_kaimal_energy_m2_s2(double sigma_m_s, double time_scale_s, double from_hz, double to_hz) {
  const auto above = [time_scale_s](double f) { return std::pow(1.0 + 6.0 * f * time_scale_s, -2.0 / 3.0); };
  return sigma_m_s * sigma_m_s * (above(from_hz) - above(to_hz));
}

TEST(IecKaimal, HasItsEnergyBetweenTwoFrequencies) {
  const double sigma = 1.4;
  const WindSpectrum spectrum =
      spectrum_of({.model = SpectrumModel::kIecKaimal, .speed_m_s = 10.0, .sigma_m_s = sigma, .length_m = 200.0});
  const double from_hz = 0.01;
  const double to_hz = 0.5;
  constexpr int kSteps = 20000;
  double sum = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double f = from_hz * std::pow(to_hz / from_hz, (k + 0.5) / kSteps);
    sum += f * spectrum.density_m2_s2_hz(f) * std::log(to_hz / from_hz) / kSteps;
  }
  EXPECT_NEAR(sum, iec_kaimal_energy_m2_s2(sigma, 20.0, from_hz, to_hz), 1e-8);
  EXPECT_NEAR(iec_kaimal_energy_m2_s2(sigma, 20.0, 0.0, kEndless), sigma * sigma, 1e-12);
}

TEST(WindProfile, IsLogarithmic) {
  EXPECT_NEAR(friction_velocity_m_s(7.0, 12.0, 0.1) / 0.41 * std::log(12.0 / 0.1), 7.0, 1e-12);
}

TEST(IecTurbulence, HasItsClassesAndScales) {
  EXPECT_NEAR(iec_sigma_m_s(IecTurbulenceClass::kA, WindComponent::kAlong, 15.0), 0.16 * (11.25 + 5.6), 1e-12);
  EXPECT_NEAR(iec_sigma_m_s(IecTurbulenceClass::kC, WindComponent::kAcross, 15.0), 0.8 * 0.12 * (11.25 + 5.6), 1e-12);
  EXPECT_NEAR(iec_lambda_m(30.0), 21.0, 1e-12);
  EXPECT_EQ(iec_lambda_m(60.0), 42.0);
  EXPECT_EQ(iec_lambda_m(200.0), 42.0);
  EXPECT_NEAR(iec_length_scale_m(WindComponent::kUpward, 100.0), 0.66 * 42.0, 1e-12);
}

}  // namespace
}  // namespace yuragi::wind::turbulence
