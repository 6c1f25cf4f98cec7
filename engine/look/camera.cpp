#include "engine/look/camera.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/look/time_of_day.hpp"

namespace yuragi::look {
namespace {

constexpr double kFarthest_m = 1000.0;  // maximum distance of scenes

const Camera& default_camera() {
  static const Camera camera;
  return camera;
}

Result<double, Failure> hour_of(const std::string& text) {
  const std::optional<double> hour = time_of_day_h(text);
  if (!hour || *hour == 24.0) return Failure{"is \"" + text + "\"; allowed: a time of the day such as \"06:30\""};
  return *hour;
}

const Fields<Camera>& camera_fields() {
  static const Fields<Camera> kFields{
      {{.name = "scene",
        .default_value = std::string(),
        .help = "Name of the scene whose middle is the target",
        .left_out = "it looks at x = 0, y = 0, z = 0"},
       &Camera::scene},
      {{.name = "target_x",
        .unit = "m",
        .default_value = default_camera().target_x_m,
        .min = -kFarthest_m,
        .max = kFarthest_m,
        .help = "The target: distance to the east of the middle of the world or, with `scene`, of that scene"},
       &Camera::target_x_m},
      {{.name = "target_y",
        .unit = "m",
        .default_value = default_camera().target_y_m,
        .min = -kFarthest_m,
        .max = kFarthest_m,
        .help = "So far above there"},
       &Camera::target_y_m},
      {{.name = "target_z",
        .unit = "m",
        .default_value = default_camera().target_z_m,
        .min = -kFarthest_m,
        .max = kFarthest_m,
        .help = "Distance to the south of there"},
       &Camera::target_z_m},
      {{.name = "heading",
        .unit = "deg",
        .default_value = default_camera().heading_deg,
        .min = -360.0,
        .max = 360.0,
        .help = "Direction of view: 0 north, 90 east"},
       &Camera::heading_deg},
      {{.name = "wind_angle",
        .unit = "deg",
        .default_value = 75.0,
        .min = -180.0,
        .max = 180.0,
        .help = "Follows the mean wind instead of `heading`: direction of view, clockwise from where the wind comes "
                "from; 0 "
                "looks into it, 90 and -90 across it. It turns by at most 0.5 deg/s, and never through a scene",
        .left_out = "`heading` is the direction of view"},
       &Camera::wind_angle_deg},
      {{.name = "pitch",
        .unit = "deg",
        .default_value = default_camera().pitch_deg,
        .min = -45.0,
        .max = 89.0,
        .help = "Angle of view downward; negative: upward. The eye stays above the ground"},
       &Camera::pitch_deg},
      {{.name = "distance",
        .unit = "m",
        .default_value = 10.0,
        .min = 0.2,
        .max = 200.0,
        .help = "Distance of the eye from the target",
        .left_out = "far enough to show all of the scene; without a scene 10"},
       &Camera::distance_m},
      {{.name = "fov",
        .unit = "deg",
        .default_value = default_camera().fov_deg,
        .min = 5.0,
        .max = 100.0,
        .help =
            "Field of view from bottom to top in a picture of 16:9; an upright picture has more of it, a broader one "
            "less"},
       &Camera::fov_deg},
      {{.name = "turn",
        .unit = "deg/min",
        .default_value = default_camera().turn_deg_min,
        .min = -360.0,
        .max = 360.0,
        .help = "Turns around the target without end; above 0 the heading increases"},
       &Camera::turn_deg_min},
      {{.name = "sway",
        .unit = "deg",
        .default_value = default_camera().sway_deg,
        .min = -90.0,
        .max = 90.0,
        .help = "Swings around the target by this angle to either side"},
       &Camera::sway_deg},
      {{.name = "pan",
        .unit = "deg",
        .default_value = default_camera().pan_deg,
        .min = -90.0,
        .max = 90.0,
        .help = "The eye does not move, and the view turns by this angle to either side"},
       &Camera::pan_deg},
      {{.name = "dolly",
        .unit = "m",
        .default_value = default_camera().dolly_m,
        .min = -100.0,
        .max = 100.0,
        .help = "Moves by this distance nearer to the target, and farther from it"},
       &Camera::dolly_m},
      {{.name = "track",
        .unit = "m",
        .default_value = default_camera().track_m,
        .min = -100.0,
        .max = 100.0,
        .help = "Moves by this distance to the right and to the left, together with its target"},
       &Camera::track_m},
      {{.name = "period",
        .unit = "s",
        .default_value = default_camera().period_s,
        .min = 10.0,
        .max = 86400.0,
        .help = "Period of sway, pan, dolly and track: there and back"},
       &Camera::period_s},
      {{.name = "from",
        .default_value = std::string(),
        .help = "Time of day at which it is switched on, HH:MM in the time zone of [shaping]",
        .left_out = "it is shown only on request; if no camera has a time, the first is always on"},
       &Camera::from_h,
       hour_of},
      {{.name = "fade",
        .unit = "s",
        .default_value = default_camera().fade_s,
        .min = 0.0,
        .max = 600.0,
        .help = "Duration of the cross-fade to it at its time"},
       &Camera::fade_s},
  };
  return kFields;
}

}  // namespace

std::span<const Parameter> camera_parameters() {
  return camera_fields().parameters();
}

Result<Camera, ParameterError> camera_of(std::string name, const ParameterValues& values) {
  Camera camera{.name = std::move(name)};
  const std::vector<ParameterError> errors = camera_fields().fill(camera, values.all());
  if (!errors.empty()) return errors.front();
  return camera;
}

Camera within_limits(const Camera& camera) {
  Camera to = camera_fields().within_limits(camera, default_camera());
  if (to.from_h && !(*to.from_h >= 0.0 && *to.from_h < 24.0)) to.from_h.reset();
  return to;
}

std::size_t camera_at(std::span<const Camera> cameras, double hour) {
  // If two have the same time, the first is used.
  constexpr double kDay_h = 24.0;
  std::size_t found = 0;
  double least_ago_h = 2.0 * kDay_h;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (!cameras[i].from_h) continue;
    const double ago_h = hour - *cameras[i].from_h + (*cameras[i].from_h > hour ? kDay_h : 0.0);
    if (ago_h < least_ago_h) {
      found = i;
      least_ago_h = ago_h;
    }
  }
  return found;
}

}  // namespace yuragi::look
