#include "daemon/settings/reload_plan.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "daemon/settings/config_edit.hpp"
#include "daemon/settings/scene_config.hpp"

namespace yuragi::daemon::settings {
namespace {

constexpr std::size_t kMaxShownValue = 60;

/// A value for a person; "left out" if there is none.
std::string shown(const ParameterValues::Map& values, std::string_view key) {
  const auto found = values.find(key);
  if (found == values.end()) return "left out";
  std::string text = toml_value(found->second);
  return text.size() > kMaxShownValue ? "..." : text;
}

/// A change, for a person. Secrets look the same, and so do long texts.
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
    (change == KeyChange::kTakesRestart ? plan_.takes_restart : plan_.applied).push_back(std::move(what));
  }

  /// The running values of a table with those of the others that are applied. `where`: what stands before a key.
  /// `otherwise`: what a new value does, of a key that does not state it.
  ParameterValues merged(const std::string& where, std::span<const Parameter> parameters, KeyChange otherwise,
                         const ParameterValues& running, const ParameterValues& wanted) {
    ParameterValues next = running;
    for (const std::string& key : different_keys(running, wanted)) {
      const auto parameter = std::ranges::find(parameters, key, &Parameter::name);
      const KeyChange change = parameter != parameters.end() ? parameter->change.value_or(otherwise) : otherwise;
      note(change, where + key + change_text(shown(running.all(), key), shown(wanted.all(), key)));
      if (change != KeyChange::kTakesRestart) next.take_over(key, wanted);
    }
    return next;
  }

  /// Does the same with all tables of an owner, which it makes again if values change.
  template <class Owner>
  void merge_tables(const std::string& who, const std::string& prefix, std::span<const TableOf<Owner>> tables,
                    Owner& next, const Owner& wanted) {
    for (const TableOf<Owner>& table : tables) {
      const std::string where =
          who + (table.name.empty() ? std::string() : "[" + prefix + std::string(table.name) + "] ");
      ParameterValues& running = next.by_name.at(table.name);
      ParameterValues values = merged(where, table.parameters, table.change, running, wanted.by_name.at(table.name));
      if (values.all() == running.all()) continue;
      running = std::move(values);
      // Each half of a table that is valid as a whole is valid with the other half of the running one: keys that
      // contradict each other are all applied, or all need a restart.
      table.fill(next, running);
    }
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

/// Reports what is new, removed or in another order.
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
    comparison.note(KeyChange::kTakesRestart, owner + "driver: \"" + std::string(next.driver->name) + "\" -> \"" +
                                                  std::string(wanted.driver->name) + "\"");
  } else {
    next.values =
        comparison.merged(owner, next.driver->parameters, KeyChange::kTakesRestart, next.values, wanted.values);
  }
  comparison.merge_tables<SensorConfig>(owner, "sensor.", sensor_tables(), next, wanted);
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
    comparison.merged(owner, {}, change, before->values, scene.values);
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
    comparison.merged(std::string(list) + " " + entry.name + ": ", {}, KeyChange::kAtOnce, before->values,
                      entry.values);
  }
  compare_lists(comparison, list, KeyChange::kAtOnce, running, wanted);
}

/// The values of a list below each entry.
using Below = std::vector<ParameterValues>;

void compare_below(Comparison& comparison, const std::string& owner, std::string_view list, const Below& running,
                   const Below& wanted) {
  for (std::size_t i = 0; i < std::min(running.size(), wanted.size()); ++i) {
    comparison.merged(owner + std::string(list) + " " + std::to_string(i + 1) + ": ", {}, KeyChange::kAtOnce,
                      running[i], wanted[i]);
  }
  if (running.size() == wanted.size()) return;
  comparison.note(KeyChange::kAtOnce, owner + std::string(list) + ": " + std::to_string(running.size()) + " -> " +
                                          std::to_string(wanted.size()));
}

/// Of the lists of feeds, all of which is applied.
void compare_feeds(Comparison& comparison, const Config& running, const Config& wanted) {
  const auto entries_of = [](const Config& config, std::string_view list) {
    const auto found = config.lists.find(list);
    return found != config.lists.end() ? found->second : std::vector<feeds::Entry>();
  };
  const auto below_of = [](const feeds::Entry& entry, std::string_view list) {
    const auto found = entry.below.find(list);
    return found != entry.below.end() ? found->second : Below();
  };
  for (const feeds::ListTable& list : feeds::list_tables()) {
    const std::vector<feeds::Entry> before = entries_of(running, list.name);
    const std::vector<feeds::Entry> after = entries_of(wanted, list.name);
    const std::string name(list.name);
    compare_applied(comparison, name.c_str(), before, after);
    for (const feeds::Entry& entry : after) {
      const auto same = std::ranges::find(before, entry.name, &feeds::Entry::name);
      if (same == before.end()) continue;
      for (const feeds::ListTable& below : list.below)
        compare_below(comparison, name + " " + entry.name + ": ", below.name, below_of(*same, below.name),
                      below_of(entry, below.name));
    }
  }
}

/// Adds to the text of each change whose value comes from page.toml that it does.
void mark_kept(std::vector<std::string>& changes, const std::vector<std::string>& kept) {
  for (std::string& change : changes) {
    if (std::ranges::any_of(kept, [&](const std::string& key) { return change.starts_with(key + ": "); }))
      change += " (kept on the page)";
  }
}

}  // namespace

ReloadPlan plan_reload(const Config& running, const Config& wanted, bool can_change_scenes) {
  ReloadPlan plan{.next = running, .applied = {}, .takes_restart = {}};
  Comparison comparison(plan);
  Config& next = plan.next;
  comparison.merge_tables<Config>("", "", config_tables(), next, wanted);
  plan.changes_shaping = next.by_name.at("shaping").all() != running.by_name.at("shaping").all();

  if (running.page_trouble != wanted.page_trouble)
    comparison.note(KeyChange::kAtOnce,
                    wanted.page_trouble.empty() ? "the page's file is read" : "the page's file is left out");
  next.page_trouble = wanted.page_trouble;
  next.page_file = wanted.page_file;
  next.page_calibrations = wanted.page_calibrations;
  next.kept = wanted.kept;
  next.passed_over = wanted.passed_over;
  for (SensorConfig& sensor : next.sensors) {
    const auto found = std::ranges::find(wanted.sensors, sensor.name, &SensorConfig::name);
    if (found != wanted.sensors.end()) compare_sensor(comparison, sensor, *found);
  }
  compare_lists(comparison, "sensor", KeyChange::kTakesRestart, running.sensors, wanted.sensors);

  const std::size_t noted_before = plan.applied.size() + plan.takes_restart.size();
  compare_scenes(comparison, running.scenes, wanted.scenes,
                 can_change_scenes ? KeyChange::kAtOnce : KeyChange::kTakesRestart);
  plan.changes_scenes = can_change_scenes && plan.applied.size() + plan.takes_restart.size() > noted_before;
  if (plan.changes_scenes) next.scenes = wanted.scenes;
  compare_applied(comparison, "camera", running.cameras, wanted.cameras);
  next.cameras = wanted.cameras;
  compare_applied(comparison, "alert", running.alerts, wanted.alerts);
  next.alerts = wanted.alerts;
  const auto same_output = [](const output::Table& one, const output::Table& other) {
    return one.output == other.output;
  };
  if (!std::ranges::equal(running.outputs, wanted.outputs, same_output)) {
    comparison.note(KeyChange::kTakesRestart, "[[output]]: has changed; viewers read it when they are started");
  }
  next.outputs = wanted.outputs;
  compare_feeds(comparison, running, wanted);
  plan.changes_feeds = running.feeds != wanted.feeds;
  next.lists = wanted.lists;
  next.feeds = wanted.feeds;
  next.clock = wanted.clock;
  mark_kept(plan.applied, wanted.kept);
  return plan;
}

}  // namespace yuragi::daemon::settings
