#include "simulators/core/scenario_file.hpp"

#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "engine/base/duration.hpp"
#include "engine/tables/parse_toml.hpp"

namespace yuragi::simulators::core {
namespace {

/// Takes the values of one table, and rejects the keys that were not read.
class ScenarioTable {
 public:
  ScenarioTable(const toml::table& table, std::string place) : table_(table), place_(std::move(place)) {}

  bool has(std::string_view key) const { return table_.contains(key); }

  [[noreturn]] void fail(std::string_view key, std::string_view what) const {
    const toml::node* node = table_.get(key);
    const toml::source_region& source = (node != nullptr ? *node : table_).source();
    throw std::runtime_error(fmt::format("{}:{}:{}: {}{}: {}", source.path ? *source.path : "", source.begin.line,
                                         source.begin.column, place_, key, what));
  }

  std::string text(std::string_view key, std::string_view allowed) {
    const toml::node* node = take(key);
    const auto* value = node != nullptr ? node->as_string() : nullptr;
    if (value == nullptr || value->get().empty()) fail(key, fmt::format("must be {}", allowed));
    return value->get();
  }

  std::vector<std::string> texts(std::string_view key, std::string_view allowed) {
    std::vector<std::string> all;
    const toml::node* node = take(key);
    if (node == nullptr) return all;
    if (!node->is_array()) fail(key, fmt::format("must be {}", allowed));
    for (const toml::node& one : *node->as_array()) {
      if (!one.is_string()) fail(key, fmt::format("must be {}", allowed));
      all.push_back(one.as_string()->get());
    }
    return all;
  }

  double number(std::string_view key, double least, double greatest, double otherwise) {
    const toml::node* node = take(key);
    if (node == nullptr) return otherwise;
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !(*value >= least && *value <= greatest))
      fail(key, fmt::format("must be a number from {} to {}", least, greatest));
    return *value;
  }

  /// "90", "5min" or a number of seconds.
  std::optional<double> duration_s(std::string_view key) {
    const toml::node* node = take(key);
    if (node == nullptr) return std::nullopt;
    if (node->is_number()) return number(key, 0.0, 1e9, 0.0);
    const auto parsed = parse_duration_s(node->value_or(std::string()));
    if (!parsed) fail(key, parsed.error().message);
    return *parsed;
  }

  /// The tables [[key]], of which there is at least one.
  std::vector<ScenarioTable> tables(std::string_view key) {
    std::vector<ScenarioTable> all;
    const toml::node* node = take(key);
    if (node == nullptr || !node->is_array_of_tables()) fail(key, fmt::format("at least one [[{}]] is needed", key));
    for (const toml::node& one : *node->as_array()) all.emplace_back(*one.as_table(), fmt::format("{}.", key));
    return all;
  }

  void finish() const {
    for (const auto& [key, node] : table_) {
      if (!taken_.contains(key.str()))
        fail(key.str(), fmt::format("is not known here; allowed: {}", fmt::join(taken_, ", ")));
    }
  }

 private:
  const toml::node* take(std::string_view key) {
    taken_.emplace(key);
    return table_.get(key);
  }

  const toml::table& table_;
  std::string place_;
  std::set<std::string, std::less<>> taken_;
};

WindPhase read_phase(ScenarioTable table, const std::filesystem::path& folder) {
  WindPhase phase;
  phase.start_s = table.duration_s("at").value_or(0.0);
  phase.ramp_s = table.duration_s("ramp").value_or(0.0);
  if (table.has("recording")) {
    phase.recording = (folder / table.text("recording", "a recording: FILE.windlog")).string();
  } else {
    wind::turbulence::SyntheticWindSettings& wind = phase.synthetic;
    wind.mean_speed_m_s = table.number("speed", 0.0, 60.0, wind.mean_speed_m_s);
    wind.mean_direction_deg = table.number("direction", 0.0, 360.0, wind.mean_direction_deg);
    wind.turbulence_intensity = table.number("turbulence", 0.0, 1.0, wind.turbulence_intensity);
    wind.seed = static_cast<std::uint64_t>(std::floor(table.number("seed", 0.0, 1e9, static_cast<double>(wind.seed))));
  }
  table.finish();
  return phase;
}

ScenarioDevice read_device(ScenarioTable table) {
  ScenarioDevice device;
  device.name = table.text("name", "a name of the device");
  device.simulate = table.text("simulate", "the arguments of yuragi-sim: \"nmea --pty\"");
  device.faults = table.texts("faults", "a list of faults: [\"silence@5min+30s\"]");
  table.finish();
  return device;
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text = tables::toml_text(in);
  if (in.bad() || !in.is_open()) throw std::runtime_error(file.string() + ": cannot be read; check its path");
  toml::table root;
  try {
    root = tables::parse_toml(text, file.string());
  } catch (const toml::parse_error& error) {
    const toml::source_position& at = error.source().begin;
    throw std::runtime_error(fmt::format("{}:{}:{}: {}", file.string(), at.line, at.column, error.description()));
  }

  ScenarioTable table(root, "");
  Scenario scenario;
  scenario.duration_s = table.duration_s("duration");
  double free_from_s = 0.0;  // the end of the previous ramp
  for (ScenarioTable& one : table.tables("wind")) {
    const WindPhase phase = read_phase(one, file.parent_path());
    const bool is_first = scenario.phases.empty();
    if (is_first && phase.start_s > 0.0) one.fail("at", "the first wind must begin at 0");
    if (!is_first && (phase.start_s <= scenario.phases.back().start_s || phase.start_s < free_from_s))
      one.fail("at", "must be after the beginning and the ramp of the previous wind");
    free_from_s = phase.start_s + phase.ramp_s;
    scenario.phases.push_back(phase);
  }
  std::set<std::string> names;
  for (ScenarioTable& one : table.tables("device")) {
    scenario.devices.push_back(read_device(one));
    if (!names.insert(scenario.devices.back().name).second)
      one.fail("name", "another device has this name; choose a different one");
  }
  table.finish();
  return scenario;
}

}  // namespace yuragi::simulators::core
