#include "daemon/service/config_check.hpp"

#include <algorithm>
#include <filesystem>

#include "daemon/animation/animation.hpp"
#include "daemon/follow/company.hpp"
#include "daemon/sensing/fallback_recording.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/settings/same_device.hpp"

namespace yuragi::daemon::service {

void check(const settings::Config& config) {
  follow::check_company(config);
  settings::open_sensors(config.sensors);
  if (config.wind.fallback) sensing::check_fallback(*config.wind.fallback);
  animation::checked_scenes_message(animation::Animation(config, sensing::make_gust_noise(config)).describe());
}

void check_restart(const settings::Config& running, const settings::Config& wanted) {
  for (const settings::SensorConfig& sensor : wanted.sensors) {
    const auto same = std::ranges::find_if(running.sensors, [&sensor](const settings::SensorConfig& other) {
      return other.driver == sensor.driver && other.values.all() == sensor.values.all();
    });
    if (same == running.sensors.end()) settings::check_sensor(sensor);
  }
  settings::refuse_same_device(wanted.sensors);
  const auto recording_of = [](const settings::Config& config) {
    return config.wind.fallback ? config.wind.fallback->recording : std::filesystem::path();
  };
  if (wanted.wind.fallback && recording_of(running) != recording_of(wanted)) {
    sensing::check_fallback(*wanted.wind.fallback);
  }
}

}  // namespace yuragi::daemon::service
