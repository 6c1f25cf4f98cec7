#pragma once

#include <cstdint>

#include "engine/wind/turbulence/wind_component.hpp"

namespace yuragi::wind::turbulence {

// The change of the mean wind and its turbulence with height and from place to place. All functions here are pure.
// Thread-safe and realtime-safe: yes.

/// Von Karman's constant.
inline constexpr double kVonKarmanConstant = 0.41;

/// The mean speed at `height_m` by the logarithmic profile (u* / 0.41) ln(z / z0), above the roughness length z0; 0 at
/// and below it.
double log_profile_m_s(double friction_velocity_m_s, double height_m, double roughness_m) noexcept;

/// The friction velocity u* of a logarithmic profile that has this speed at this height, which is above the roughness.
double friction_velocity_m_s(double speed_m_s, double height_m, double roughness_m) noexcept;

/// The mean speed at `height_m` by the power law U_r (z / z_r)^alpha. alpha is 1/7 over open country, 0.2 in IEC
/// 61400-1.
double power_profile_m_s(double reference_speed_m_s, double reference_height_m, double height_m, double alpha) noexcept;

/// Turbulence at a site: A is the roughest.
enum class IecTurbulenceClass : std::uint8_t { kA, kB, kC };

/// Standard deviation by the IEC's normal turbulence model: I_ref (0.75 U + 5.6 m/s), I_ref = 0.16, 0.14, 0.12 for A,
/// B, C; v has 0.8 and w 0.5 of it. Source: IEC 61400-1:2005, 6.3.1.3 and annex B.2.
double iec_sigma_m_s(IecTurbulenceClass turbulence, WindComponent component, double speed_m_s) noexcept;

/// Lambda, the IEC's scale of turbulence: 0.7 z below 60 m, 42 m above.
double iec_lambda_m(double height_m) noexcept;

/// The IEC's integral length scales for its Kaimal spectrum: (8.1, 2.7, 0.66) Lambda.
double iec_length_scale_m(WindComponent component, double height_m) noexcept;

/// Coherence (the root of the squared one) of u at two places `distance_m` apart across the wind: exp(-C f d / U), with
/// the decay C about 7 vertically and 10 to 16 sideways. Source: Davenport 1961.
double davenport_coherence(double frequency_hz, double distance_m, double speed_m_s, double decay) noexcept;

/// The same by IEC 61400-1:2005, annex B.2: exp(-12 sqrt((f d / U)^2 + (0.12 d / L_c)^2)), L_c = 8.1 Lambda.
double iec_coherence(double frequency_hz, double distance_m, double speed_m_s, double height_m) noexcept;

}  // namespace yuragi::wind::turbulence
