#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "engine/base/parameter.hpp"
#include "engine/base/result.hpp"

namespace yuragi::look {

/// More than any installation needs; also the limit of clients.
inline constexpr std::size_t kMaxCameras = 32;

/// A camera on the scenes, and its moves: a [[camera]] of the configuration. It looks at a target from `distance_m`
/// away. sway, pan, dolly and track move slowly to one side and to the other, once in `period_s`, together and by the
/// daemon's clock, so that several viewers show the same.
struct Camera {
  std::string name = {};
  std::string scene = {};   ///< its target: the middle of this scene; empty: x = y = z = 0
  double target_x_m = 0.0;  ///< offset from there: east, up, south
  double target_y_m = 0.0;
  double target_z_m = 0.0;
  double heading_deg = 210.0;  ///< direction of view: 0 north, 90 east
  /// Angle from the direction of the mean wind (wind::ViewWind) to the view, clockwise: the heading follows the wind.
  /// Nullopt: `heading_deg` is the heading
  std::optional<double> wind_angle_deg = std::nullopt;
  double pitch_deg = 6.0;  ///< of the view below level; negative: upward
  /// From the eye to the target. Nullopt: the whole scene fits into the picture; without a scene 10 m
  std::optional<double> distance_m = std::nullopt;
  double fov_deg = 40.0;      ///< field of view from bottom to top in a picture of 16:9
  double turn_deg_min = 0.0;  ///< around the target, for ever; above 0 the heading grows
  double sway_deg = 0.0;      ///< around the target
  double pan_deg = 0.0;       ///< of the view, without moving the eye
  double dolly_m = 0.0;       ///< of the eye along the view
  double track_m = 0.0;       ///< of eye and target, to the right and to the left
  double period_s = 120.0;
  std::optional<double> from_h = std::nullopt;  ///< local time of the day from which it is on
  double fade_s = 5.0;                          ///< duration of the cross-fade to it

  friend bool operator==(const Camera&, const Camera&) = default;
};

/// The keys of a [[camera]], without its name.
std::span<const Parameter> camera_parameters();

/// From values of camera_parameters().
Result<Camera, ParameterError> camera_of(std::string name, const ParameterValues& values);

/// The same camera with every number finite and within the limits of camera_parameters(): for untrusted input.
Camera within_limits(const Camera& camera);

/// Returns the camera that is on at a time of the day, 0 to 24: the one with the latest `from_h` until then; before the
/// first `from_h` of the day, the last one of the day before. The first camera if none has a `from_h`; 0 if there are
/// none.
std::size_t camera_at(std::span<const Camera> cameras, double hour);

}  // namespace yuragi::look
