#include <sstream>
#include <utility>
#include <variant>

#include <toml++/toml.h>

#include "daemon/settings/config.hpp"
#include "engine/output/output_tables.hpp"
#include "engine/tables/parse_toml.hpp"
#include "engine/tables/toml_values.hpp"

namespace yuragi::daemon::settings {
namespace {

toml::table to_table(const ParameterValues& values) {
  toml::table table;
  for (const auto& [name, value] : values.all()) {
    std::visit([&table, &key = name](const auto& held) { table.insert(key, held); }, printable(value));
  }
  return table;
}

/// Adds an entry to a list.
void append(toml::table& root, std::string_view list, toml::table entry, const std::string& name) {
  entry.insert_or_assign("name", name);
  if (!root.contains(list)) root.insert(list, toml::array{});
  root[list].as_array()->push_back(std::move(entry));
}

}  // namespace

std::string to_toml(const Config& config) {
  toml::table root;
  for (const auto& [name, values] : config.by_name) {
    if (!name.empty()) {
      root.insert(name, to_table(values));
      continue;
    }
    for (auto&& [key, value] : to_table(values)) root.insert(key, value);
  }
  for (const SensorConfig& sensor : config.sensors) {
    toml::table entry = to_table(sensor.values);
    entry.insert_or_assign("driver", sensor.driver->name);
    for (const auto& [name, values] : sensor.by_name) entry.insert(name, to_table(values));
    append(root, "sensor", std::move(entry), sensor.name);
  }
  for (const SceneConfig& scene : config.scenes) {
    toml::table entry = to_table(scene.values);
    entry.insert_or_assign("kind", scene.kind->name);
    append(root, "scene", std::move(entry), scene.name);
  }
  for (const CameraConfig& camera : config.cameras) append(root, "camera", to_table(camera.values), camera.name);
  for (const AlertConfig& alert : config.alerts) append(root, "alert", to_table(alert.values), alert.name);
  for (const output::Table& output : config.outputs) {
    toml::table entry = to_table(output.values);
    toml::array windows;
    for (const ParameterValues& window : output.windows) windows.push_back(to_table(window));
    if (!windows.empty()) entry.insert(output::kWindowList, std::move(windows));
    append(root, output::kOutputList, std::move(entry), output.output.name);
  }
  for (const auto& [list, entries] : config.lists) {
    for (const feeds::Entry& written : entries) {
      toml::table entry = to_table(written.values);
      for (const auto& [name, below] : written.below) {
        toml::array tables;
        for (const ParameterValues& values : below) tables.push_back(to_table(values));
        entry.insert(name, std::move(tables));
      }
      append(root, list, std::move(entry), written.name);
    }
  }
  std::ostringstream out;
  out << root << '\n';
  return out.str();
}

std::string to_recorded_toml(Config config) {
  if (!config.shaping.hours.is_always_open())
    config.by_name.at("shaping").set("zone", config.shaping.hours.zone_name());
  return to_toml(config);
}

std::string to_toml(const ParameterValues& values) {
  std::ostringstream out;
  out << to_table(values);
  return out.str();
}

Result<ParameterValues, Failure> parse_values(std::string_view toml_text, std::span<const Parameter> parameters) {
  try {
    ParameterValues::Map given;
    for (const auto& [key, node] : tables::parse_toml(toml_text)) {
      const std::optional<ParameterValue> value = tables::parameter_value_of(node);
      if (!value) return Failure{std::string(key.str()) + ": takes one value: true, a number or a text"};
      given.emplace(key.str(), *value);
    }
    auto values = ParameterValues::resolve(parameters, given);
    if (!values) return Failure{values.error().name + ": " + values.error().message};
    return std::move(*values);
  } catch (const toml::parse_error& error) {
    return Failure{"TOML: " + std::string(error.description())};
  }
}

}  // namespace yuragi::daemon::settings
