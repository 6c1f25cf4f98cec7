#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::tools::sensors {

/// The state of a running daemon.
struct DaemonStatus {
  std::string address;   ///< where it answered
  std::string software;  ///< "yuragi 0.2.0"
  double tick_rate_hz = 0.0;
  wire::Sensors sensors{};
  std::vector<wire::SceneState> scenes{};
  std::vector<wire::PlayerState> players{};
};

/// A page for a person: the verdict with what needs attention, then sensors, scenes and recordings that play.
std::string status_text(const DaemonStatus& status);

/// The same as JSON; {"verdict": "well" or "attention", "attention": [texts], ...}.
nlohmann::ordered_json status_json(const DaemonStatus& status);

}  // namespace yuragi::daemon::tools::sensors
