#pragma once

#include <string>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::settings {

/// Calls visit(where, parameter, value) for each value of a configuration that is there. `where`: what stands before
/// the key for a person, "http." or "roof.toml:3:1: sensor." or "alert night: ".
template <class Visit>
void for_each_value(const Config& config, const Visit& visit) {
  const auto visit_table = [&visit](const std::string& where, const auto& parameters, const ParameterValues& values) {
    for (const Parameter& parameter : parameters) {
      const auto found = values.all().find(parameter.name);
      if (found != values.all().end()) visit(where, parameter, found->second);
    }
  };
  const auto before_key = [](std::string_view table) {
    return table.empty() ? std::string() : std::string(table) + ".";
  };
  for (const ConfigTable& table : config_tables())
    visit_table(before_key(table.name), table.parameters, config.by_name.at(table.name));
  for (const SensorConfig& sensor : config.sensors) {
    const std::string where = place_of(sensor) + ": sensor.";
    visit_table(where, sensor.driver->parameters, sensor.values);
    for (const SensorTable& table : sensor_tables())
      visit_table(where + before_key(table.name), table.parameters, sensor.by_name.at(table.name));
  }
  for (const SceneConfig& scene : config.scenes)
    visit_table("scene " + scene.name + ": ", scene_parameters(*scene.kind), scene.values);
  for (const CameraConfig& camera : config.cameras)
    visit_table("camera " + camera.name + ": ", look::camera_parameters(), camera.values);
  for (const AlertConfig& alert : config.alerts)
    visit_table("alert " + alert.name + ": ", alert_parameters(), alert.values);
  for (const output::Table& output : config.outputs) {
    const std::string where = "output " + output.output.name + ": ";
    visit_table(where, output::output_parameters(), output.values);
    for (const ParameterValues& window : output.windows) visit_table(where, output::window_parameters(), window);
  }
  for (const feeds::ListTable& list : feeds::list_tables()) {
    const auto entries = config.lists.find(list.name);
    if (entries == config.lists.end()) continue;
    for (const feeds::Entry& entry : entries->second) {
      const std::string where = std::string(list.name) + " " + entry.name + ": ";
      visit_table(where, list.parameters, entry.values);
      for (const feeds::ListTable& below : list.below) {
        const auto tables = entry.below.find(below.name);
        if (tables == entry.below.end()) continue;
        for (const ParameterValues& values : tables->second) visit_table(where, below.parameters, values);
      }
    }
  }
}

}  // namespace yuragi::daemon::settings
