#include "daemon/sensing/recorded_silence.hpp"

#include "daemon/settings/recorded_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/windlog/windlog_cursor.hpp"

namespace yuragi::daemon::sensing {

double recorded_unchanged_for_s(const std::filesystem::path& recording, std::string_view sensor) {
  if (sensor == "*") return 0.0;
  auto cursor = drivers::windlog::WindlogCursor::open(recording, sensor);
  if (!cursor) return 0.0;
  const auto first = cursor->next();
  if (!first || !*first) return 0.0;
  const drivers::windlog::LoggedSensor& recorded = cursor->sensor_of(**first);
  return settings::recorded_unchanged_for_s(recorded.driver, recorded.options);
}

settings::Config with_recorded_silences(settings::Config config) {
  for (settings::SensorConfig& sensor : config.sensors) {
    if (!sensor.driver->plays_recordings || sensor.stand_in) continue;
    const ParameterValues& values = sensor.values;
    const double unchanged_for_s = recorded_unchanged_for_s(values.text("file"), values.text("sensor"));
    sensor.blend.unchanged_for_s = unchanged_for_s / values.number("rate");
  }
  if (config.wind.fallback)
    config.wind.fallback->unchanged_for_s = recorded_unchanged_for_s(config.wind.fallback->recording, "");
  return config;
}

}  // namespace yuragi::daemon::sensing
