#include "daemon/settings/config.hpp"

#include <memory>
#include <utility>

#include "daemon/settings/same_device.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::settings {
SensorConfig default_sensor(std::string name, const drivers::sensor::DriverDescription& driver, ParameterValues values,
                            std::string origin) {
  SensorConfig sensor{
      .name = std::move(name), .driver = &driver, .values = std::move(values), .origin = std::move(origin)};
  for (const SensorTable& table : sensor_tables()) {
    const ParameterValues& defaults = sensor.by_name[table.name] =
        ParameterValues::resolve(table.parameters, {}).value();
    table.fill(sensor, defaults);
  }
  return sensor;
}

Config listening_at(Config config, const std::string& address) {
  config.stream.listen = address;
  config.by_name.at("stream").set("listen", address);
  return config;
}

values::Names names_of(const Config& config) {
  values::Names names;
  for (const SensorConfig& sensor : config.sensors) names.sensors.push_back(sensor.name);
  for (const values::Place& place : config.feeds.places) names.places.push_back(place.name);
  for (const SceneConfig& scene : config.scenes) names.scenes.push_back(scene.name);
  return names;
}

std::string read_config_text(const std::filesystem::path& file) {
  auto text = platform::read_whole(file, kMaxConfig_bytes);
  if (!text) throw ConfigError(file.string() + ":1:1: file: " + text.error().message);
  return std::move(*text);
}

namespace {

ConfigError cannot_open(const SensorConfig& sensor, const std::exception& why) {
  return ConfigError(place_of(sensor) + ": sensor: " + why.what());
}

}  // namespace

std::unique_ptr<drivers::sensor::Sensor> open_sensor(const SensorConfig& sensor) {
  try {
    return sensor.stand_in ? sensor.stand_in->open() : sensor.driver->open(sensor.values);
  } catch (const std::exception& error) {
    throw cannot_open(sensor, error);
  }
}

void check_sensor(const SensorConfig& sensor) {
  try {
    sensor.driver->open(sensor.values);
  } catch (const drivers::sensor::LineInUse&) {
    return;  // by what runs until the restart
  } catch (const std::exception& error) {
    throw cannot_open(sensor, error);
  }
}

std::vector<std::unique_ptr<drivers::sensor::Sensor>> open_sensors(std::span<const SensorConfig> sensors) {
  std::vector<std::unique_ptr<drivers::sensor::Sensor>> opened;
  opened.reserve(sensors.size());
  for (const SensorConfig& sensor : sensors) opened.push_back(open_sensor(sensor));
  refuse_same_device(sensors);
  return opened;
}

}  // namespace yuragi::daemon::settings
