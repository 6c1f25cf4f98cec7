#include "daemon/sensing/recorded_source.hpp"

#include "daemon/settings/recorded_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/windlog/windlog_cursor.hpp"

namespace yuragi::daemon::sensing {

settings::RecordedSource recorded_source(const std::filesystem::path& recording, std::string_view sensor) {
  if (sensor == "*") return {};
  auto cursor = drivers::windlog::Cursor::open(recording, sensor);
  if (!cursor) return {};
  const auto first = cursor->next();
  if (!first || !*first) return {};
  const drivers::windlog::LoggedSensor& recorded = cursor->sensor_of(**first);
  return settings::recorded_source(recorded.driver, recorded.options);
}

settings::Config with_recorded_sources(settings::Config config) {
  for (settings::SensorConfig& sensor : config.sensors) {
    if (!sensor.driver->plays_recordings || sensor.stand_in) continue;
    const ParameterValues& values = sensor.values;
    const settings::RecordedSource recorded = recorded_source(values.text("file"), values.text("sensor"));
    sensor.blend.unchanged_for_s = recorded.unchanged_for_s / values.number("rate");
    set_value(sensor, recorded.value);
  }
  if (auto& fallback = config.wind.fallback) {
    const settings::RecordedSource recorded = recorded_source(fallback->recording, "");
    fallback->unchanged_for_s = recorded.unchanged_for_s;
    fallback->value = recorded.value.value_or(drivers::sensor::StatedValue{});
  }
  return config;
}

}  // namespace yuragi::daemon::sensing
