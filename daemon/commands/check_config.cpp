// `yuragi check-config` checks and prints a configuration; `yuragi describe` prints all keys.
#include <memory>
#include <string>

#include <fmt/core.h>

#include "daemon/commands/command.hpp"
#include "daemon/sensing/fallback_recording.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/sensor_blend.hpp"
#include "daemon/tools/sensors/driver_reference.hpp"

namespace yuragi::daemon::commands {
namespace {

std::string length_reason(const settings::WindConfig& wind, const settings::SensorConfig& sensor) {
  if (wind.default_length_m) return " (default_length)";
  const auto [height_m, scene_height_m] = sensor.heights;
  if (!height_m) return " (no height in its calibration)";
  const std::string brought = scene_height_m != *height_m ? fmt::format(", converted to {:g} m", scene_height_m) : "";
  return fmt::format(" (height {:g} m{})", *height_m, brought);
}

void add_check_config(CLI::App& app) {
  CLI::App* command = app.add_subcommand("check-config", "check a configuration, and show what it amounts to");
  command->footer(
      "Exit code 0: no error; 78: errors, each reported as file:line:column: key: what is wrong.\nNo device is opened. "
      "--full prints the whole configuration with every default.");
  auto file = std::make_shared<std::filesystem::path>();
  auto full = std::make_shared<bool>(false);
  command->add_option("file", *file, "the configuration")->required()->type_name("FILE.toml");
  command->add_flag("--full", *full, "print every value, including defaults, as TOML");
  command->callback([file, full] {
    const settings::Config config = settings::load_config(*file);
    for (const settings::SensorConfig& sensor : config.sensors) settings::open_sensor(sensor);
    if (config.wind.fallback) sensing::check_fallback(*config.wind.fallback);
    if (*full) {
      fmt::print("{}", settings::to_toml(config));
      return;
    }
    fmt::print("{}: no errors\n", file->string());
    for (const settings::SensorConfig& sensor : config.sensors) {
      fmt::print("  sensor {} ({}), {}, gusts of {:.0f} m{}\n", sensor.name, sensor.driver->name,
                 settings::place_text(sensor.blend), settings::gust_length_m(config.wind, sensor),
                 length_reason(config.wind, sensor));
    }
    for (const settings::SceneConfig& scene : config.scenes)
      fmt::print("  scene {} ({})\n", scene.name, scene.kind->name);
  });
}

void print_parameters(std::span<const Parameter> parameters) {
  fmt::print("{}", tools::sensors::parameter_text(parameters));
}

void describe_everything() {
  fmt::print("# A configuration is a TOML file. Everything has a default; an empty file is allowed.\n");
  for (const settings::ConfigTable& table : settings::config_tables()) {
    fmt::print("\n{}  # {}\n", table.name.empty() ? std::string() : fmt::format("[{}]", table.name), table.summary);
    print_parameters(table.parameters);
  }
  for (const drivers::sensor::DriverDescription* driver : drivers::sensor::driver_table()) {
    fmt::print("\n[[sensor]]  # driver = \"{}\": {}\n", driver->name, driver->summary);
    print_parameters(driver->parameters);
  }
  fmt::print(
      "\n"
      "[sensor.calibration]  # below a [[sensor]] of any kind: from its readings to the wind; recordings hold "
      "uncalibrated readings\n");
  print_parameters(settings::calibration_parameters());
  fmt::print(
      "\n"
      "[sensor.blend]  # below a [[sensor]] of any kind: how it is combined with other sensors\n");
  print_parameters(settings::sensor_blend_parameters());
  fmt::print(
      "\n"
      "[sensor.judge]  # below a [[sensor]] of any kind: which of its readings are accepted\n");
  print_parameters(settings::judge_parameters());
  fmt::print(
      "\n"
      "[[scene]]  # of any kind: its place and visibility\n");
  print_parameters(settings::common_scene_parameters());
  for (const scenes::SceneDescription* scene : scenes::scene_table()) {
    fmt::print("\n[[scene]]  # kind = \"{}\": {}\n", scene->name, scene->summary);
    print_parameters(scene->parameters);
  }
}

void add_describe(CLI::App& app) {
  CLI::App* command = app.add_subcommand("describe", "list every key of a configuration: unit, range, default, help");
  command->callback(describe_everything);
}

}  // namespace

extern const Command kCheckConfigCommand;
const Command kCheckConfigCommand{add_check_config};

extern const Command kDescribeCommand;
const Command kDescribeCommand{add_describe};

}  // namespace yuragi::daemon::commands
