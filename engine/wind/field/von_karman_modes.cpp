#include "engine/wind/field/von_karman_modes.hpp"

#include <cmath>
#include <numbers>

#include "engine/math/portable.hpp"
#include "engine/noise/von_karman_corner.hpp"

namespace yuragi::wind::field {
VonKarmanModes::VonKarmanModes(turbulence::WindComponent component, double sigma_m_s, double length_m) noexcept
    : component_(component) {
  // The scale of v and w along the wind is half of that of u in the same turbulence.
  const double length_of_u_m = component == turbulence::WindComponent::kAlong ? length_m : 2.0 * length_m;
  const double kappa = 1.0 / (noise::kVonKarmanCorner * length_of_u_m);
  kappa_squared_ = kappa * kappa;
  // E integrates to 3/2 sigma^2; the integral of k^4 / (kappa^2 + k^2)^(17/6) is kappa^(-2/3) B(5/2, 1/3) / 2.
  const double energy = 3.0 * sigma_m_s * sigma_m_s * math::cube_root(kappa_squared_) / std::beta(5.0 / 2.0, 1.0 / 3.0);
  scale_ = energy / (4.0 * std::numbers::pi);
}

double VonKarmanModes::plane_density(double along_rad_m, double across_rad_m) const noexcept {
  // The integral over k_up of (k_side^2 + k_up^2) / (s + k_up^2)^(17/6), s = kappa^2 + k_along^2 + k_across^2.
  static const double kSide = std::beta(1.0 / 2.0, 7.0 / 3.0);
  static const double kUp = std::beta(3.0 / 2.0, 4.0 / 3.0);
  const double side_rad_m = component_ == turbulence::WindComponent::kAlong ? across_rad_m : along_rad_m;
  const double s = kappa_squared_ + along_rad_m * along_rad_m + across_rad_m * across_rad_m;
  return scale_ * std::pow(s, -4.0 / 3.0) * (kSide * side_rad_m * side_rad_m / s + kUp);
}

double VonKarmanModes::space_density(double along_rad_m, double across_rad_m, double up_rad_m) const noexcept {
  const double own_rad_m = component_ == turbulence::WindComponent::kAlong    ? along_rad_m
                           : component_ == turbulence::WindComponent::kAcross ? across_rad_m
                                                                              : up_rad_m;
  const double k_squared = along_rad_m * along_rad_m + across_rad_m * across_rad_m + up_rad_m * up_rad_m;
  return scale_ * (k_squared - own_rad_m * own_rad_m) * std::pow(kappa_squared_ + k_squared, -17.0 / 6.0);
}

}  // namespace yuragi::wind::field
