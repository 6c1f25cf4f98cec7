#include "engine/wind/turbulence/wind_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/portable.hpp"

namespace yuragi::wind::turbulence {

double log_profile_m_s(double friction_velocity_m_s, double height_m, double roughness_m) noexcept {
  return friction_velocity_m_s / kVonKarmanConstant * std::log(std::max(height_m / roughness_m, 1.0));
}

double friction_velocity_m_s(double speed_m_s, double height_m, double roughness_m) noexcept {
  return speed_m_s * kVonKarmanConstant / std::log(height_m / roughness_m);
}

double power_profile_m_s(double reference_speed_m_s, double reference_height_m, double height_m,
                         double alpha) noexcept {
  return reference_speed_m_s * std::pow(height_m / reference_height_m, alpha);
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

double davenport_coherence(double frequency_hz, double distance_m, double speed_m_s, double decay) noexcept {
  return std::exp(-decay * frequency_hz * distance_m / speed_m_s);
}

double iec_coherence(double frequency_hz, double distance_m, double speed_m_s, double height_m) noexcept {
  const double reduced = frequency_hz * distance_m / speed_m_s;
  const double separation = 0.12 * distance_m / iec_length_scale_m(WindComponent::kAlong, height_m);
  return std::exp(-12.0 * math::length(reduced, separation));
}

}  // namespace yuragi::wind::turbulence
