#include "daemon/settings/config.hpp"

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/settings/same_device.hpp"

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

std::string read_config_text(const std::filesystem::path& file) {
  const auto refuse = [&file](const std::string& why) { return ConfigError(file.string() + ":1:1: file: " + why); };
  // Without waiting for somebody who writes into a pipe.
  const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) throw refuse("cannot be read; check its path and permissions");
  const std::unique_ptr<const int, void (*)(const int*)> closed(&descriptor, [](const int* one) { close(*one); });

  struct stat status {};
  if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    throw refuse("cannot be read; it is no regular file, but a folder, a pipe or a device");
  }
  std::string text(kLargestConfig_bytes + 1, '\0');
  std::size_t length = 0;
  while (length < text.size()) {
    const ssize_t count = read(descriptor, text.data() + length, text.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw refuse(std::string("cannot be read: ") + std::strerror(errno));
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
  }
  if (length > kLargestConfig_bytes) throw refuse("is too large; allowed: up to 1 MB");
  text.resize(length);
  return text;
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
