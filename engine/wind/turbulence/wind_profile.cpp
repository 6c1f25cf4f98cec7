#include "engine/wind/turbulence/wind_profile.hpp"

#include <array>
#include <cmath>

namespace yuragi::wind::turbulence {
namespace {

constexpr double kVonKarmanConstant = 0.41;

}  // namespace

double friction_velocity_m_s(double speed_m_s, double height_m, double roughness_m) noexcept {
  return speed_m_s * kVonKarmanConstant / std::log(height_m / roughness_m);
}

double iec_sigma_m_s(IecTurbulenceClass turbulence, WindComponent component, double speed_m_s) noexcept {
  constexpr std::array<double, 3> kReferenceIntensity = {0.16, 0.14, 0.12};
  constexpr std::array<double, 3> kShare = {1.0, 0.8, 0.5};
  return kShare[static_cast<std::size_t>(component)] * kReferenceIntensity[static_cast<std::size_t>(turbulence)] *
         (0.75 * speed_m_s + 5.6);
}

double iec_lambda_m(double height_m) noexcept {
  return height_m < 60.0 ? 0.7 * height_m : 42.0;
}

double iec_length_scale_m(WindComponent component, double height_m) noexcept {
  constexpr std::array<double, 3> kScale = {8.1, 2.7, 0.66};
  return kScale[static_cast<std::size_t>(component)] * iec_lambda_m(height_m);
}

}  // namespace yuragi::wind::turbulence
