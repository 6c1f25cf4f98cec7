#include "daemon/settings/reload_plan.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <utility>

#include "daemon/settings/config_edit.hpp"
#include "daemon/settings/scene_config.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr std::size_t kLongestShownValue = 60;

struct KeyRule {
  std::string_view table, key;
  KeyChange change;
};

constexpr KeyChange kApplied = KeyChange::kApplied;
constexpr KeyChange kTakesRestart = KeyChange::kTakesRestart;

constexpr std::array kKeyRules = {
    KeyRule{"", "seed", kTakesRestart},

    KeyRule{"stream", "listen", kTakesRestart},
    KeyRule{"stream", "max_clients", kApplied},
    KeyRule{"stream", "max_clients_per_address", kApplied},
    KeyRule{"stream", "control", kApplied},

    KeyRule{"http", "listen", kTakesRestart},
    KeyRule{"http", "hosts", kTakesRestart},
    KeyRule{"http", "token_file", kTakesRestart},
    KeyRule{"http", "proxies", kTakesRestart},
    KeyRule{"http", "readers", kTakesRestart},

    KeyRule{"recording", "file", kTakesRestart},
    KeyRule{"recording", "rotate", kApplied},
    KeyRule{"recording", "max_file_size", kApplied},
    KeyRule{"recording", "keep_days", kApplied},
    KeyRule{"recording", "max_size", kApplied},
    KeyRule{"recording", "min_free", kApplied},

    KeyRule{"animation", "rate", kTakesRestart},
    KeyRule{"animation", "threads", kTakesRestart},

    KeyRule{"wind", "default_speed", kTakesRestart},
    KeyRule{"wind", "default_direction", kTakesRestart},
    KeyRule{"wind", "default_turbulence", kTakesRestart},
    KeyRule{"wind", "default_length", kTakesRestart},
    KeyRule{"wind", "gustiness", kTakesRestart},
    KeyRule{"wind", "site_octaves", kTakesRestart},
    KeyRule{"wind", "evolving", kTakesRestart},
    KeyRule{"wind", "handover", kTakesRestart},
    KeyRule{"wind", "stale_intervals", kTakesRestart},
    KeyRule{"wind", "return_after", kTakesRestart},
    KeyRule{"wind", "relative_gains", kTakesRestart},
    KeyRule{"wind", "fallback_recording", kTakesRestart},
    KeyRule{"wind", "fallback_after", kTakesRestart},

    KeyRule{"shaping", "floor", kApplied},
    KeyRule{"shaping", "site_median", kApplied},
    KeyRule{"shaping", "site_strong", kApplied},
    KeyRule{"shaping", "site_most_gain", kApplied},
    KeyRule{"shaping", "site_memory", kApplied},
    KeyRule{"shaping", "site_file", kTakesRestart},
    KeyRule{"shaping", "over", kApplied},
    KeyRule{"shaping", "gusts", kApplied},
    KeyRule{"shaping", "ceiling", kApplied},
    KeyRule{"shaping", "ceiling_most", kApplied},
    KeyRule{"shaping", "hours", kApplied},
    KeyRule{"shaping", "zone", kApplied},
    KeyRule{"shaping", "closed", kApplied},
    KeyRule{"shaping", "fade", kApplied},

    KeyRule{"look", "sun", kApplied},
    KeyRule{"look", "latitude", kApplied},
    KeyRule{"look", "longitude", kApplied},
    KeyRule{"look", "time", kApplied},
    KeyRule{"look", "sun_height", kApplied},
    KeyRule{"look", "sun_azimuth", kApplied},
    KeyRule{"look", "clouds", kApplied},
    KeyRule{"look", "haze", kApplied},
    KeyRule{"look", "exposure", kApplied},
    KeyRule{"look", "quality", kApplied},
    KeyRule{"look", "palette", kApplied},
    KeyRule{"look", "ground", kApplied},
    KeyRule{"look", "ground_image", kApplied},
    KeyRule{"look", "ground_image_width", kApplied},
    KeyRule{"look", "density", kApplied},

    KeyRule{"log", "level", kApplied},

    KeyRule{"sensor.calibration", "unit", kApplied},
    KeyRule{"sensor.calibration", "gain", kApplied},
    KeyRule{"sensor.calibration", "offset", kApplied},
    KeyRule{"sensor.calibration", "curve", kApplied},
    KeyRule{"sensor.calibration", "north_offset", kApplied},
    // What the estimator expects of the gusts is made of the heights when it is constructed.
    KeyRule{"sensor.calibration", "height", kTakesRestart},
    KeyRule{"sensor.calibration", "scene_height", kTakesRestart},
    KeyRule{"sensor.calibration", "roughness", kTakesRestart},

    KeyRule{"sensor.judge", "enabled", kApplied},
    KeyRule{"sensor.judge", "max_speed", kApplied},
    KeyRule{"sensor.judge", "spike", kApplied},
    KeyRule{"sensor.judge", "slew", kApplied},
    KeyRule{"sensor.judge", "frozen", kApplied},
    KeyRule{"sensor.judge", "seized", kApplied},
    KeyRule{"sensor.judge", "compare", kApplied},

    KeyRule{"sensor.blend", "role", kTakesRestart},
    KeyRule{"sensor.blend", "priority", kTakesRestart},
    KeyRule{"sensor.blend", "weight", kTakesRestart},
    KeyRule{"sensor.blend", "x", kTakesRestart},
    KeyRule{"sensor.blend", "z", kTakesRestart},
    KeyRule{"sensor.blend", "lead", kTakesRestart},
    KeyRule{"sensor.blend", "value", kTakesRestart},
    KeyRule{"sensor.blend", "averaging", kTakesRestart},
    KeyRule{"sensor.blend", "direction_step", kTakesRestart},
};

/// A value for a person; "left out" where there is none.
std::string shown(const ParameterValues::Map& values, std::string_view key) {
  const auto found = values.find(key);
  if (found == values.end()) return "left out";
  std::string text = toml_value(found->second);
  return text.size() > kLongestShownValue ? "..." : text;
}

/// A change for a person. Secrets look alike, and so do long texts.
std::string change_text(const std::string& before, const std::string& after) {
  return before == after ? ": another value" : ": " + before + " -> " + after;
}

/// The keys that two sets of values do not have in common, in the order of their names.
std::vector<std::string> different_keys(const ParameterValues& before, const ParameterValues& after) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : before.all()) {
    const auto other = after.all().find(key);
    if (other == after.all().end() || other->second != value) keys.push_back(key);
  }
  for (const auto& [key, value] : after.all()) {
    if (!before.has(key)) keys.push_back(key);
  }
  std::ranges::sort(keys);
  return keys;
}

/// Collects what differs.
class Comparison {
 public:
  explicit Comparison(ReloadPlan& plan) : plan_(plan) {}

  void note(KeyChange change, std::string what) {
    (change == kApplied ? plan_.applied : plan_.takes_restart).push_back(std::move(what));
  }

  /// The running values of a table with those of the others that are applied. `where`: what stands before a key. A
  /// key that is given in only one of them is noted, and stays as it is.
  template <class ChangeOf>
  ParameterValues merged(const std::string& where, const ParameterValues& running, const ParameterValues& wanted,
                         const ChangeOf& change_of_key) {
    ParameterValues next = running;
    for (const std::string& key : different_keys(running, wanted)) {
      const KeyChange change = change_of_key(key);
      note(change, where + key + change_text(shown(running.all(), key), shown(wanted.all(), key)));
      if (change == kApplied && next.has(key) && wanted.has(key)) next.set(key, wanted.all().at(key));
    }
    return next;
  }

  ParameterValues merged_table(const std::string& owner, const std::string& table, const ParameterValues& running,
                               const ParameterValues& wanted) {
    return merged(owner + "[" + table + "] ", running, wanted, [&table](const std::string& key) {
      return change_of(table, key).value_or(KeyChange::kTakesRestart);
    });
  }

 private:
  ReloadPlan& plan_;
};

/// The order of those names that both have, as it is in `entries`.
template <class Entry>
std::vector<std::string> common_order(const std::vector<Entry>& entries, const std::vector<Entry>& others) {
  std::vector<std::string> names;
  for (const Entry& entry : entries) {
    if (std::ranges::find(others, entry.name, &Entry::name) != others.end()) names.push_back(entry.name);
  }
  return names;
}

/// Notes what is new, gone or in another order.
template <class Entry>
void compare_lists(Comparison& comparison, const char* list, KeyChange change, const std::vector<Entry>& running,
                   const std::vector<Entry>& wanted) {
  for (const Entry& entry : wanted) {
    if (std::ranges::find(running, entry.name, &Entry::name) == running.end()) {
      comparison.note(change, std::string(list) + " " + entry.name + ": is new");
    }
  }
  for (const Entry& entry : running) {
    if (std::ranges::find(wanted, entry.name, &Entry::name) == wanted.end()) {
      comparison.note(change, std::string(list) + " " + entry.name + ": is gone");
    }
  }
  if (common_order(running, wanted) != common_order(wanted, running)) {
    comparison.note(change, std::string("the order of the ") + list + "s");
  }
}

void compare_sensor(Comparison& comparison, SensorConfig& next, const SensorConfig& wanted) {
  const std::string owner = "sensor " + next.name + ": ";
  next.origin = wanted.origin;
  if (next.driver != wanted.driver) {
    comparison.note(kTakesRestart, owner + "driver: \"" + std::string(next.driver->name) + "\" -> \"" +
                                       std::string(wanted.driver->name) + "\"");
  } else {
    next.values = comparison.merged(owner, next.values, wanted.values, [&next](const std::string& key) {
      return driver_key_change_of(*next.driver, key);
    });
  }
  SensorTables& tables = next.by_name;
  tables.calibration =
      comparison.merged_table(owner, "sensor.calibration", tables.calibration, wanted.by_name.calibration);
  next.calibration = *calibration_of(tables.calibration);
  tables.judge = comparison.merged_table(owner, "sensor.judge", tables.judge, wanted.by_name.judge);
  next.judge = judge_settings_of(tables.judge);
  next.is_compared = is_compared(tables.judge);
  tables.blend = comparison.merged_table(owner, "sensor.blend", tables.blend, wanted.by_name.blend);
}

void compare_scenes(Comparison& comparison, const std::vector<SceneConfig>& running,
                    const std::vector<SceneConfig>& wanted, KeyChange change) {
  for (const SceneConfig& scene : wanted) {
    const auto before = std::ranges::find(running, scene.name, &SceneConfig::name);
    if (before == running.end()) continue;
    const std::string owner = "scene " + scene.name + ": ";
    if (before->kind != scene.kind) {
      comparison.note(change, owner + "kind: \"" + std::string(before->kind->name) + "\" -> \"" +
                                  std::string(scene.kind->name) + "\"");
      continue;
    }
    comparison.merged(owner, before->values, scene.values, [change](const std::string&) { return change; });
    if (before->values.all() == scene.values.all() && before->cloth != scene.cloth) {
      comparison.note(change, owner + "image: its file has changed");
    }
  }
  compare_lists(comparison, "scene", change, running, wanted);
}

/// Of cameras and of alerts, all of which is applied.
template <class Entry>
void compare_applied(Comparison& comparison, const char* list, const std::vector<Entry>& running,
                     const std::vector<Entry>& wanted) {
  for (const Entry& entry : wanted) {
    const auto before = std::ranges::find(running, entry.name, &Entry::name);
    if (before == running.end()) continue;
    comparison.merged(std::string(list) + " " + entry.name + ": ", before->values, entry.values,
                      [](const std::string&) { return kApplied; });
  }
  compare_lists(comparison, list, kApplied, running, wanted);
}

}  // namespace

std::optional<KeyChange> change_of(std::string_view table, std::string_view key) {
  const auto found =
      std::ranges::find_if(kKeyRules, [&](const KeyRule& rule) { return rule.table == table && rule.key == key; });
  if (found == kKeyRules.end()) return std::nullopt;
  return found->change;
}

KeyChange driver_key_change_of(const drivers::sensor::DriverDescription& driver, std::string_view key) {
  return driver.plays_recordings && key == "rate" ? kApplied : kTakesRestart;
}

ReloadPlan plan_reload(const Config& running, const Config& wanted, bool can_change_scenes) {
  ReloadPlan plan{.next = running, .applied = {}, .takes_restart = {}};
  Comparison comparison(plan);
  Config& next = plan.next;
  if (running.seed != wanted.seed) {
    comparison.note(kTakesRestart, "seed: " + std::to_string(running.seed) + " -> " + std::to_string(wanted.seed));
  }
  // Each half of a table that is valid as a whole is valid with the other half of the running one: keys that contradict
  // each other are all applied, or all take a restart.
  const auto merged_table = [&comparison](const char* table, ParameterValues& values, const ParameterValues& other) {
    values = comparison.merged_table("", table, values, other);
  };
  merged_table("stream", next.by_name.stream, wanted.by_name.stream);
  next.stream = *stream_config_of(next.by_name.stream);
  merged_table("http", next.by_name.http, wanted.by_name.http);
  next.http = *http_config_of(next.by_name.http);
  merged_table("recording", next.by_name.recording, wanted.by_name.recording);
  next.recording = recording_config_of(next.by_name.recording);
  merged_table("animation", next.by_name.animation, wanted.by_name.animation);
  merged_table("wind", next.by_name.wind, wanted.by_name.wind);
  const std::size_t applied_before = plan.applied.size();
  merged_table("shaping", next.by_name.shaping, wanted.by_name.shaping);
  next.shaping = *shaping_config_of(next.by_name.shaping, next.wind);
  plan.changes_shaping = plan.applied.size() > applied_before;
  merged_table("look", next.by_name.look, wanted.by_name.look);
  next.by_name.look = wanted.by_name.look;  // all of it is applied, also that a key is left out
  next.look = *look::look_of(next.by_name.look);
  merged_table("log", next.by_name.log, wanted.by_name.log);
  next.log = log_config_of(next.by_name.log);

  for (SensorConfig& sensor : next.sensors) {
    const auto found = std::ranges::find(wanted.sensors, sensor.name, &SensorConfig::name);
    if (found != wanted.sensors.end()) compare_sensor(comparison, sensor, *found);
  }
  compare_lists(comparison, "sensor", kTakesRestart, running.sensors, wanted.sensors);

  const std::size_t noted_before = plan.applied.size() + plan.takes_restart.size();
  compare_scenes(comparison, running.scenes, wanted.scenes, can_change_scenes ? kApplied : kTakesRestart);
  plan.changes_scenes = can_change_scenes && plan.applied.size() + plan.takes_restart.size() > noted_before;
  if (plan.changes_scenes) next.scenes = wanted.scenes;
  compare_applied(comparison, "camera", running.cameras, wanted.cameras);
  next.cameras = wanted.cameras;
  compare_applied(comparison, "alert", running.alerts, wanted.alerts);
  next.alerts = wanted.alerts;
  const auto same_output = [](const output::OutputTable& one, const output::OutputTable& other) {
    return one.output == other.output;
  };
  if (!std::ranges::equal(running.outputs, wanted.outputs, same_output)) {
    comparison.note(kTakesRestart, "[[output]]: has changed; viewers read it when they are started");
  }
  next.outputs = wanted.outputs;
  next.clock = wanted.clock;
  return plan;
}

}  // namespace yuragi::daemon::settings
