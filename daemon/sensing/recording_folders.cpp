#include "daemon/sensing/recording_folders.hpp"

#include <algorithm>
#include <functional>

namespace yuragi::daemon::sensing {

RecordingFolders::RecordingFolders(const settings::Config& config,
                                   const std::optional<std::filesystem::path>& recorded) {
  if (recorded) add(*recorded);
  for (const settings::SensorConfig& sensor : config.sensors) {
    if (sensor.values.has("file")) add(sensor.values.text("file"));
    if (sensor.stand_in) add(sensor.stand_in->recording);
  }
  if (config.wind.fallback) add(config.wind.fallback->recording);
  // A path may be the beginning of a longer one.
  std::ranges::sort(names_, std::greater{}, [](const auto& entry) { return entry.first.size(); });
}

void RecordingFolders::add(const std::filesystem::path& file) {
  if (file.has_parent_path() && file.has_filename()) names_.emplace_back(file.string(), file.filename().string());
}

void RecordingFolders::remove_from(std::string& text) const {
  for (const auto& [path, name] : names_) {
    for (auto place = text.find(path); place != std::string::npos; place = text.find(path, place + name.size())) {
      text.replace(place, path.size(), name);
    }
  }
}

void RecordingFolders::remove_from(wire::Sensors& sensors) const {
  for (wire::SensorStatus& sensor : sensors.sensors) {
    remove_from(sensor.detail);
    remove_from(sensor.state_reason);
  }
  if (sensors.recorder) remove_from(sensors.recorder->error);
}

void RecordingFolders::remove_from(wire::ControlReply& reply) const {
  remove_from(reply.message);
  for (wire::PlayerState& player : reply.players) {
    remove_from(player.file);
    remove_from(player.refusal);
  }
}

}  // namespace yuragi::daemon::sensing
