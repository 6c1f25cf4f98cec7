#include "daemon/settings/sensor_config.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "daemon/settings/sensor_blend.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "engine/base/fields.hpp"
#include "engine/wind/turbulence/wind_profile.hpp"

namespace yuragi::daemon::settings {
namespace {

using wind::judging::Calibration;
using wind::judging::JudgeSettings;

/// [sensor.calibration] as it is written.
struct CalibrationTable {
  Calibration calibration;
  double height_m = 0.0;
  double scene_height_m = 0.0;
  double roughness_m = 0.0;
};

auto of_calibration(auto member) {
  return member_of(&CalibrationTable::calibration, member);
}

const Fields<CalibrationTable>& calibration_fields() {
  static const Fields<CalibrationTable> kFields{
      {{.name = "unit",
        .default_value = std::string("m/s"),
        .help = "unit of the sensor's speeds, if its driver assumes m/s",
        .choices = drivers::sensor::kSpeedUnitNames},
       of_calibration(&Calibration::unit_m_s),
       drivers::sensor::metres_per_second_in},
      {{.name = "gain",
        .default_value = 1.0,
        .min = 0.01,
        .max = 100.0,
        .help = "the speed in m/s is multiplied by this"},
       of_calibration(&Calibration::gain)},
      {{.name = "offset",
        .unit = "m/s",
        .default_value = 0.0,
        .min = -20.0,
        .max = 20.0,
        .help = "added to the speed after the gain, except in a calm"},
       of_calibration(&Calibration::offset_m_s)},
      {{.name = "curve",
        .unit = "m/s",
        .default_value = std::string(""),
        .help = "applied after gain and offset: points measured:true, \"0:0 5:5.2 12:12.9\"; empty: none"},
       of_calibration(&Calibration::curve),
       wind::judging::parse_calibration_curve},
      {{.name = "north_offset",
        .unit = "deg",
        .default_value = 0.0,
        .min = -360.0,
        .max = 360.0,
        .help = "bearing of the sensor's north mark, clockwise from north"},
       of_calibration(&Calibration::north_offset_deg)},
      {{.name = "height",
        .unit = "m",
        .default_value = 0.0,
        .min = 0.0,
        .max = 1000.0,
        .help = "of the sensor above the ground, to scale its speeds to scene_height; also gives the length of "
                "its gusts (default_length of [wind]); 0: speeds are not scaled",
        .change = KeyChange::kTakesRestart},
       &CalibrationTable::height_m},
      {{.name = "scene_height",
        .unit = "m",
        .default_value = 10.0,
        .min = 0.1,
        .max = 1000.0,
        .help = "height of the wind that moves the scenes",
        .change = KeyChange::kTakesRestart},
       &CalibrationTable::scene_height_m},
      {{.name = "roughness",
        .unit = "m",
        .default_value = 0.03,
        .min = 0.0001,
        .max = 5.0,
        .help = "roughness length of the surrounding ground: 0.0002 water, 0.03 meadow, 0.5 suburb, 1 city",
        .change = KeyChange::kTakesRestart},
       &CalibrationTable::roughness_m},
  };
  return kFields;
}

/// [sensor.judge] as it is written.
struct JudgeTable {
  bool is_enabled = true;
  bool is_compared = true;
  JudgeSettings settings;
};

auto of_judge(auto member) {
  return member_of(&JudgeTable::settings, member);
}

const Fields<JudgeTable>& judge_fields() {
  static const Fields<JudgeTable> kFields{
      {{.name = "enabled",
        .default_value = true,
        .help = "implausible readings are not used for the wind (but recorded); false: all readings are used; "
                "simulated ones always are"},
       &JudgeTable::is_enabled},
      {{.name = "max_speed",
        .unit = "m/s",
        .default_value = wind::kMaxPlausibleSpeed_m_s,
        .min = 1.0,
        .max = wind::kMaxPlausibleSpeed_m_s,
        .help = "a speed above this is out of the sensor's range"},
       of_judge(&JudgeSettings::max_speed_m_s)},
      {{.name = "spike",
        .unit = "m/s",
        .default_value = 4.0,
        .min = 0.1,
        .max = 100.0,
        .help = "a difference from the last readings below this plus half of the speed is not a spike"},
       of_judge(&JudgeSettings::least_spike_m_s)},
      {{.name = "slew",
        .unit = "m/s^2",
        .default_value = 5.0,
        .min = 0.01,
        .max = 1000.0,
        .help = "a larger step is accepted once it has lasted for step / rate"},
       of_judge(&JudgeSettings::slew_m_s2)},
      {{.name = "frozen",
        .unit = "s",
        .default_value = 30.0,
        .min = 1.0,
        .max = 86400.0,
        .help = "a sensor is frozen after 20 exactly equal readings over this time; the time is longer for a "
                "sensor that often repeats values, or has never sent another"},
       of_judge(&JudgeSettings::frozen_s)},
      {{.name = "seized",
        .unit = "s",
        .default_value = 7200.0,
        .min = 60.0,
        .max = 864000.0,
        .help = "a cup is seized when it stands still for this time while the other sensors measure more than 3 "
                "m/s; without other sensors after six times as long, following a windy day"},
       of_judge(&JudgeSettings::seized_s)},
      {{.name = "compare",
        .default_value = true,
        .help = "compare its mean of 5 min with that of the other sensors (never for a microphone); with three "
                "or more live sensors, one that differs from the majority by more than a factor of 3 and 3 m/s "
                "for 10 min is not used"},
       &JudgeTable::is_compared},
  };
  return kFields;
}

std::vector<ParameterError> fill_calibration(SensorConfig& sensor, const ParameterValues& values) {
  CalibrationTable table;
  std::vector<ParameterError> errors = calibration_fields().fill(table, values.all());
  sensor.heights = {.sensor_m = std::nullopt, .scene_m = table.scene_height_m};
  if (table.height_m > 0.0) {
    sensor.heights.sensor_m = table.height_m;
    table.calibration.height_factor =
        wind::judging::height_factor(table.height_m, table.scene_height_m, table.roughness_m);
  }
  sensor.calibration = std::move(table.calibration);
  return errors;
}

std::vector<ParameterError> fill_judge(SensorConfig& sensor, const ParameterValues& values) {
  constexpr double kAlonePatience = 6.0;
  JudgeTable table;
  std::vector<ParameterError> errors = judge_fields().fill(table, values.all());
  table.settings.seized_alone_s = kAlonePatience * table.settings.seized_s;
  sensor.judge.reset();
  if (table.is_enabled) sensor.judge = table.settings;
  sensor.is_compared = table.is_compared;
  return errors;
}

std::vector<ParameterError> fill_blend(SensorConfig& sensor, const ParameterValues& values) {
  auto blend = blend_source_of(values, *sensor.driver);
  if (!blend) return {blend.error()};
  blend->length_m = sensor.blend.length_m;
  sensor.blend = *blend;
  const drivers::sensor::DriverDescription& driver = *sensor.driver;
  set_value(sensor, driver.stated_value != nullptr ? driver.stated_value(sensor.values) : std::nullopt);
  if (driver.unchanged_for_s != nullptr) sensor.blend.unchanged_for_s = driver.unchanged_for_s(sensor.values);
  return {};
}

}  // namespace

std::span<const SensorTable> sensor_tables() {
  static const std::array kTables = {
      SensorTable{.name = kCalibrationTable,
                  .summary = "from its readings to the wind; recordings hold uncalibrated readings",
                  .parameters = calibration_fields().parameters(),
                  .change = KeyChange::kAtOnce,
                  .fill = fill_calibration},
      SensorTable{.name = kBlendTable,
                  .summary = "how it is combined with other sensors",
                  .parameters = sensor_blend_parameters(),
                  .change = KeyChange::kTakesRestart,
                  .fill = fill_blend},
      SensorTable{.name = "judge",
                  .summary = "which of its readings are accepted",
                  .parameters = judge_fields().parameters(),
                  .change = KeyChange::kAtOnce,
                  .fill = fill_judge},
  };
  return kTables;
}

wind::judging::Calibration calibration_of(const ParameterValues& values) {
  SensorConfig sensor;
  for (const ParameterError& error : fill_calibration(sensor, values)) throw_exception_from_error(error, {});
  return sensor.calibration;
}

void set_value(SensorConfig& sensor, const std::optional<drivers::sensor::StatedValue>& stated) {
  sensor.value = sensor_value_of(sensor.by_name.at(kBlendTable), stated);
  sensor.blend.value = sensor.value.value;
  sensor.blend.averaging_s = sensor.value.averaging_s;
}

const std::string& place_of(const SensorConfig& sensor) noexcept {
  return sensor.origin.empty() ? sensor.name : sensor.origin;
}

double gust_length_m(const WindConfig& wind, const SensorConfig& sensor) noexcept {
  return sensor.blend.length_m > 0.0 ? sensor.blend.length_m : wind.gust_length_m();
}

void set_gust_length(SensorConfig& sensor) noexcept {
  if (!sensor.heights.sensor_m) return;
  const double length_m =
      wind::turbulence::iec_length_scale_m(wind::turbulence::WindComponent::kAlong, *sensor.heights.sensor_m);
  sensor.blend.length_m = std::max(sensor.calibration.height_factor * length_m, kMinGusts_m);
}

}  // namespace yuragi::daemon::settings
