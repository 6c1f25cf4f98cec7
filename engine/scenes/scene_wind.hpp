#pragma once

#include <cstdint>
#include <memory>

#include "engine/math/critically_damped.hpp"
#include "engine/wind/ground/ground_wind.hpp"

namespace yuragi::scenes {

struct Placement;

/// What of the wind over the ground a scene feels in its place.
enum class WindPart : std::uint8_t {
  kAll,   ///< with all gusts; those of the noise where it is given
  kMean,  ///< without any: for a scene whose elements read the gusts each in its own place
};

/// The wind as a scene feels it: what is too strong is cut to kStrongestSceneWind_m_s, and a step becomes a quick
/// swell, so that no input whatever makes a scene jump. It lags by 2 / kOmega_rad_s = 0.1 s.
///
/// From one tick of dt to the next it changes by at most largest_step_m_s(dt), whatever comes in: its rate is the input
/// convolved with the derivative of the impulse response w^2 t exp(-w t), whose magnitude integrates to 2 w / e, and
/// the input is never longer than kStrongestSceneWind_m_s. It is never longer than that itself, since the impulse
/// response is positive and integrates to 1. Thread-safe: no. Realtime-safe: yes.
class Wind {
 public:
  static constexpr double kOmega_rad_s = 20.0;

  /// The wind in the place of a scene. `gusts`: the noise of the wind that it will be given; without it, only what was
  /// measured blows there.
  explicit Wind(const Placement& placement, std::shared_ptr<const wind::turbulence::GustNoise> gusts = nullptr,
                WindPart part = WindPart::kAll);

  /// Advances by dt_s toward `wind`. Calm from the beginning stays calm, exactly.
  void step(const wind::ground::Wind& wind, double dt_s) noexcept;

  double east_m_s() const noexcept { return east_.value; }
  double south_m_s() const noexcept { return south_.value; }
  double speed_m_s() const noexcept;

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
