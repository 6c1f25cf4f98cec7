#pragma once

#include <string>
#include <vector>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::settings {

/// The way from the configuration that runs to another.
struct ReloadPlan {
  /// The new running configuration: the old one with the applicable values of the other.
  Config next;

  /// What changes, for a person, in the order of the file: "[shaping] floor: 0.0 -> 1.5", "sensor roof: host:
  /// \"192.168.1.20\" -> \"192.168.1.21\"", "scene elm: is new".
  std::vector<std::string> applied;
  std::vector<std::string> takes_restart;

  bool changes_scenes = false;   ///< next.scenes are not those that run
  bool changes_shaping = false;  ///< something of [shaping]
  bool changes_feeds = false;    ///< next.feeds is not what runs
  bool is_empty() const noexcept { return applied.empty() && takes_restart.empty(); }
};

/// Compares two configurations as parse_config() makes them. `can_change_scenes`: the scenes can be exchanged while the
/// daemon runs; otherwise what differs in them needs a restart. Sensors and scenes are the same if they have the
/// same name. Pure.
ReloadPlan plan_reload(const Config& running, const Config& wanted, bool can_change_scenes);

}  // namespace yuragi::daemon::settings
