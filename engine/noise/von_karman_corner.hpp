#pragma once

namespace yuragi::noise {

/// The corner of von Karman's spectrum: of turbulence whose integral length scale is L its shape bends at the
/// wavenumber 1 / (1.339 L), rad/m. With it the integral length scale of a straight line through the turbulence is L.
/// It is Gamma(1/3) / (sqrt(pi) Gamma(5/6)), and (2 pi 1.339)^2 is the 70.8 of the spectrum along a line. Source: von
/// Karman 1948, Progress in the statistical theory of turbulence.
inline constexpr double kVonKarmanCorner = 1.339;

}  // namespace yuragi::noise
