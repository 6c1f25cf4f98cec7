#pragma once

#include <glm/vec2.hpp>

#include "engine/look/look.hpp"
#include "viewer/light/daylight.hpp"

namespace yuragi::viewer::light {

/// The sky of a look at a moment (seconds since 1970, UTC).
Sky sky_of(const look::Look& look, double utc_s);

/// The light of a look at a moment, with the exposure adapted.
Light light_of(const look::Look& look, double utc_s);

/// The light as time passes: the sun's way, clouds that drift with the wind, an exposure that follows slowly, and a
/// cross-fade when the look changes. Nothing jumps. Pure: time is a parameter. Thread-safe: no.
class SkyKeeper {
 public:
  /// Duration of a change of the look.
  static constexpr double kFade_s = 4.0;

  /// Sets the look at once, or, if it is a different one, by a cross-fade of over_s (above 0).
  void start(const look::Look& look);
  void set_look(const look::Look& look, double over_s = kFade_s);
  const look::Look& look() const { return look_; }

  /// Advances by dt_s to utc_s, with the wind of now: east and south, m/s.
  const Light& advance(double utc_s, double dt_s, const glm::dvec2& wind_m_s);

  const Light& light() const { return shown_; }

 private:
  look::Look look_;
  Light shown_;
  Light before_;
  double fade_s_ = kFade_s;  // since the last change
  double over_s_ = kFade_s;
  bool has_light_ = false;
  double exposure_log_ = 0.0;  // without the look's own
  glm::dvec2 slow_wind_m_s_{0.0};
  glm::dvec2 drift_{0.0};
};

}  // namespace yuragi::viewer::light
