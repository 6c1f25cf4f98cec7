#include "daemon/sensing/recorded_silence.hpp"

#include "daemon/settings/recorded_sensor.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/windlog/windlog_cursor.hpp"

namespace yuragi::daemon::sensing {

namespace {

/// What is recorded of a sensor, handed to `use`; not called for "*", and for what cannot be read.
template <class Use>
void with_recorded(const std::filesystem::path& recording, std::string_view sensor, Use use) {
  if (sensor == "*") return;
  auto cursor = drivers::windlog::WindlogCursor::open(recording, sensor);
  if (!cursor) return;
  const auto first = cursor->next();
  if (first && *first) use(cursor->sensor_of(**first));
}

}  // namespace

double recorded_unchanged_for_s(const std::filesystem::path& recording, std::string_view sensor) {
  double unchanged_for_s = 0.0;
  with_recorded(recording, sensor, [&](const drivers::windlog::LoggedSensor& recorded) {
    unchanged_for_s = settings::recorded_unchanged_for_s(recorded.driver, recorded.options);
  });
  return unchanged_for_s;
}

std::optional<drivers::sensor::StatedValue> recorded_value(const std::filesystem::path& recording,
                                                           std::string_view sensor) {
  std::optional<drivers::sensor::StatedValue> value;
  with_recorded(recording, sensor, [&](const drivers::windlog::LoggedSensor& recorded) {
    value = settings::recorded_value(recorded.driver, recorded.options);
  });
  return value;
}

settings::Config with_recorded_sources(settings::Config config) {
  for (settings::SensorConfig& sensor : config.sensors) {
    if (!sensor.driver->plays_recordings || sensor.stand_in) continue;
    const ParameterValues& values = sensor.values;
    const double unchanged_for_s = recorded_unchanged_for_s(values.text("file"), values.text("sensor"));
    sensor.blend.unchanged_for_s = unchanged_for_s / values.number("rate");
    set_value(sensor, recorded_value(values.text("file"), values.text("sensor")));
  }
  if (auto& fallback = config.wind.fallback) {
    fallback->unchanged_for_s = recorded_unchanged_for_s(fallback->recording, "");
    fallback->value = recorded_value(fallback->recording, "").value_or(drivers::sensor::StatedValue{});
  }
  return config;
}

}  // namespace yuragi::daemon::sensing
