#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::settings {

/// What a running daemon does with a key that has another value in the configuration that it reads again.
enum class KeyChange : std::uint8_t {
  kApplied,       ///< takes effect while it runs
  kTakesRestart,  ///< takes effect when the daemon is started again
};

/// Of a key of config_tables() (`table` as ConfigTable::name), of "sensor.calibration", "sensor.judge" or
/// "sensor.blend". Nothing for a key that is in none of them. Pure.
std::optional<KeyChange> change_of(std::string_view table, std::string_view key);

/// Of a driver's own key. Pure.
KeyChange driver_key_change_of(const drivers::sensor::DriverDescription& driver, std::string_view key);

/// The way from the configuration that runs to another.
struct ReloadPlan {
  /// What runs afterwards: the running configuration with those values of the other that are applied.
  Config next;

  /// What changes, for a person, in the order of the file: "[shaping] floor: 0.0 -> 1.5", "sensor roof: host:
  /// \"192.168.1.20\" -> \"192.168.1.21\"", "scene elm: is new".
  std::vector<std::string> applied;
  std::vector<std::string> takes_restart;

  bool changes_scenes = false;   ///< next.scenes are not those that run
  bool changes_shaping = false;  ///< something of [shaping]
  bool is_empty() const noexcept { return applied.empty() && takes_restart.empty(); }
};

/// Compares two configurations as parse_config() makes them. `can_change_scenes`: the scenes can be exchanged while the
/// daemon runs; otherwise what differs in them takes a restart. Sensors and scenes are the same where they have the
/// same name. Pure.
ReloadPlan plan_reload(const Config& running, const Config& wanted, bool can_change_scenes);

}  // namespace yuragi::daemon::settings
