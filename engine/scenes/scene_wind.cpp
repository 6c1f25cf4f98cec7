#include "engine/scenes/scene_wind.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/scenes/scene.hpp"

namespace yuragi::scenes {
namespace {

/// A smaller wind is set to 0: it moves nothing, and the filter would decay to denormal numbers, which are slow.
constexpr double kCalm_m_s = 1e-12;

void settle(math::CriticallyDamped& follower) noexcept {
  if (std::abs(follower.value) < kCalm_m_s && std::abs(follower.rate_per_s) < kCalm_m_s) follower = {};
}

}  // namespace

Wind::Wind(const Placement& placement, std::shared_ptr<const wind::turbulence::GustNoise> gusts, WindPart part)
    : gusts_(std::move(gusts)), part_(part), place_x_m_(placement.x_m), place_z_m_(placement.z_m) {}

wind::Vector Wind::at_place(const wind::ground::Wind& wind) const noexcept {
  if (part_ == WindPart::kMean) return wind.smooth_at(place_x_m_, place_z_m_);
  if (!gusts_) return wind.measured_at(place_x_m_, place_z_m_);
  return wind.at(*gusts_, place_x_m_, place_z_m_);
}

wind::Vector Wind::cut(wind::Vector wind) noexcept {
  const double speed_m_s = std::sqrt(wind.u_m_s * wind.u_m_s + wind.v_m_s * wind.v_m_s);
  return speed_m_s > kStrongestSceneWind_m_s ? (kStrongestSceneWind_m_s / speed_m_s) * wind : wind;
}

void Wind::step(const wind::ground::Wind& wind, double dt_s) noexcept {
  const wind::Vector here = cut(at_place(wind));
  east_.step(here.u_m_s, kOmega_rad_s, dt_s);
  south_.step(-here.v_m_s, kOmega_rad_s, dt_s);
  settle(east_);
  settle(south_);
}

double Wind::speed_m_s() const noexcept {
  return std::sqrt(east_.value * east_.value + south_.value * south_.value);
}

double Wind::largest_step_m_s(double dt_s) noexcept {
  const double rate_m_s2 = 2.0 * kStrongestSceneWind_m_s * kOmega_rad_s / std::numbers::e;
  return std::min(rate_m_s2 * dt_s, 2.0 * kStrongestSceneWind_m_s);
}

}  // namespace yuragi::scenes
