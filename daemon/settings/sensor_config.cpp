#include "daemon/settings/sensor_config.hpp"

#include <algorithm>
#include <utility>

#include "daemon/settings/sensor_blend.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/wind/turbulence/wind_profile.hpp"

namespace yuragi::daemon::settings {

void set_value(SensorConfig& sensor, const std::optional<drivers::sensor::StatedValue>& stated) {
  sensor.value = sensor_value_of(sensor.by_name.blend, stated);
  sensor.blend.value = sensor.value.value;
  sensor.blend.averaging_s = sensor.value.averaging_s;
}

const std::string& place_of(const SensorConfig& sensor) noexcept {
  return sensor.origin.empty() ? sensor.name : sensor.origin;
}

double gust_length_m(const WindConfig& wind, const SensorConfig& sensor) noexcept {
  return sensor.blend.length_m > 0.0 ? sensor.blend.length_m : wind.gust_length_m();
}

double gust_length_at_height_m(double height_m, const wind::judging::Calibration& calibration) noexcept {
  return std::max(calibration.height_factor *
                      wind::turbulence::iec_length_scale_m(wind::turbulence::WindComponent::kAlong, height_m),
                  kShortestGusts_m);
}

Result<wind::judging::Calibration, ParameterError> calibration_of(const ParameterValues& values) {
  auto curve = wind::judging::parse_calibration_curve(values.text("curve"));
  if (!curve) return ParameterError{"curve", curve.error().message};
  wind::judging::Calibration calibration{.unit_m_s = drivers::sensor::metres_per_second_in(values.text("unit")),
                                         .gain = values.number("gain"),
                                         .offset_m_s = values.number("offset"),
                                         .curve = std::move(*curve),
                                         .north_offset_deg = values.number("north_offset")};
  const SensorHeights heights = sensor_heights_of(values);
  if (heights.sensor_m) {
    calibration.height_factor =
        wind::judging::height_factor(*heights.sensor_m, heights.scene_m, values.number("roughness"));
  }
  return calibration;
}

SensorHeights sensor_heights_of(const ParameterValues& values) {
  SensorHeights heights{.scene_m = values.number("scene_height")};
  if (const double sensor_m = values.number("height"); sensor_m > 0.0) heights.sensor_m = sensor_m;
  return heights;
}

std::optional<wind::judging::JudgeSettings> judge_settings_of(const ParameterValues& values) {
  constexpr double kAlonePatience = 6.0;
  if (!values.flag("enabled")) return std::nullopt;
  return wind::judging::JudgeSettings{.max_speed_m_s = values.number("max_speed"),
                                      .slew_m_s2 = values.number("slew"),
                                      .least_spike_m_s = values.number("spike"),
                                      .frozen_s = values.number("frozen"),
                                      .seized_s = values.number("seized"),
                                      .seized_alone_s = kAlonePatience * values.number("seized")};
}

bool is_compared(const ParameterValues& values) {
  return values.flag("compare");
}

}  // namespace yuragi::daemon::settings
