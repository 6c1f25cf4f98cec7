#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/settings/config.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::sensing {

/// Removes the folders of the files that the daemon reads and writes (recordings that are played, the fall-back
/// recording, files of lines) from what clients on other machines receive: of /home/anna/storm.windlog they see
/// storm.windlog. Thread-safe: yes.
class RecordingFolders {
 public:
  /// `recorded`: the recording that is written, if any.
  explicit RecordingFolders(const settings::Config& config,
                            const std::optional<std::filesystem::path>& recorded = std::nullopt);

  void remove_from(wire::Sensors& sensors) const;
  void remove_from(wire::ControlReply& reply) const;

 private:
  void add(const std::filesystem::path& file);
  void remove_from(std::string& text) const;

  std::vector<std::pair<std::string, std::string>> names_;  // of each path with a folder its last part; longest first
};

}  // namespace yuragi::daemon::sensing
