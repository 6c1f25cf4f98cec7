#include "daemon/animation/motion_made_of.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "engine/math/philox.hpp"

namespace yuragi::daemon::animation {

std::uint64_t motion_made_of(settings::Config config, std::size_t sensors) {
  settings::Config moving;
  for (const char* const table : {"", "animation", "wind", "shaping"})
    moving.by_name.emplace(table, std::move(config.by_name.at(table)));
  moving.by_name.at("animation").set("threads", std::int64_t{1});
  moving.sensors = std::move(config.sensors);
  moving.sensors.resize(std::min(sensors, moving.sensors.size()));
  for (settings::SensorConfig& sensor : moving.sensors) {
    sensor.values = {};
    sensor.by_name.erase(std::string(settings::kCalibrationTable));
  }
  moving.scenes = std::move(config.scenes);
  return math::stream_id(settings::to_toml(moving));
}

}  // namespace yuragi::daemon::animation
