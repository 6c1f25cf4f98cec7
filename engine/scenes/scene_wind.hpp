#pragma once

#include <cstdint>
#include <memory>

#include "engine/base/state_pass.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::scenes {

struct Placement;

/// The part of the wind over the ground that a scene uses at its place.
enum class WindPart : std::uint8_t {
  kAll,   ///< with all gusts; those of the noise if it is given
  kMean,  ///< without gusts: for a scene whose elements read the gusts at their own places
};

/// The wind for a scene: limited to kStrongestSceneWind_m_s, and smoothed, so that no input makes a scene jump. It lags
/// by 2 / kOmega_rad_s = 0.1 s.
///
/// From one tick of dt to the next it changes by at most largest_step_m_s(dt), for any input: its rate is the input
/// convolved with the derivative of the impulse response w^2 t exp(-w t), whose magnitude integrates to 2 w / e, and
/// the input is never longer than kStrongestSceneWind_m_s. It is never longer than that itself, because the impulse
/// response is positive and integrates to 1. Thread-safe: no. Realtime-safe: yes.
class Wind {
 public:
  static constexpr double kOmega_rad_s = 20.0;

  /// The wind at the place of a scene. `gusts`: the noise of its wind; if null, only the measured wind is used.
  explicit Wind(const Placement& placement, std::shared_ptr<const wind::turbulence::GustNoise> gusts = nullptr,
                WindPart part = WindPart::kAll);

  /// Advances by dt_s toward `wind`. Calm from the beginning stays calm, exactly.
  void step(const wind::ground::Wind& wind, double dt_s) noexcept;

  double east_m_s() const noexcept { return east_.value; }
  double south_m_s() const noexcept { return south_.value; }
  double speed_m_s() const noexcept;

  void list_state(StatePass& pass) { pass(east_, south_); }

  static double largest_step_m_s(double dt_s) noexcept;

  /// A wind that is too strong for any scene is cut to kStrongestSceneWind_m_s.
  static wind::Vector cut(wind::Vector wind) noexcept;

 private:
  wind::Vector at_place(const wind::ground::Wind& wind) const noexcept;

  std::shared_ptr<const wind::turbulence::GustNoise> gusts_;
  WindPart part_;
  double place_x_m_, place_z_m_;
  math::CriticallyDamped east_, south_;
};

}  // namespace yuragi::scenes
