#pragma once

#include <cstdint>

#include "engine/wind/turbulence/wind_component.hpp"

namespace yuragi::wind::turbulence {

// The change of the mean wind and its turbulence with height. All functions here are pure.
// Thread-safe and realtime-safe: yes.

/// The friction velocity u* of the logarithmic profile (u* / 0.41) ln(z / z0) that has this speed at this height, which
/// is above the roughness length z0.
double friction_velocity_m_s(double speed_m_s, double height_m, double roughness_m) noexcept;

/// Turbulence at a site: A is the roughest.
enum class IecTurbulenceClass : std::uint8_t { kA, kB, kC };

/// Standard deviation by the IEC's normal turbulence model: I_ref (0.75 U + 5.6 m/s), I_ref = 0.16, 0.14, 0.12 for A,
/// B, C; v has 0.8 and w 0.5 of it. Source: IEC 61400-1:2005, 6.3.1.3 and annex B.2.
double iec_sigma_m_s(IecTurbulenceClass turbulence, WindComponent component, double speed_m_s) noexcept;

/// Lambda, the IEC's scale of turbulence: 0.7 z below 60 m, 42 m above.
double iec_lambda_m(double height_m) noexcept;

/// The IEC's integral length scales for its Kaimal spectrum: (8.1, 2.7, 0.66) Lambda.
double iec_length_scale_m(WindComponent component, double height_m) noexcept;

}  // namespace yuragi::wind::turbulence
