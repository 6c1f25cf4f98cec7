// `yuragi check-config` checks and prints a configuration; `yuragi describe` prints all keys.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/http/certificate_files.hpp"
#include "daemon/service/config_check.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/config_file.hpp"
#include "daemon/settings/page_file.hpp"
#include "daemon/settings/secret_exposure.hpp"
#include "daemon/settings/sensor_blend.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/state/json_value.hpp"
#include "daemon/tools/doctor/judgements.hpp"
#include "daemon/tools/doctor/rehearsal.hpp"
#include "daemon/tools/sensors/description_json.hpp"
#include "daemon/tools/sensors/driver_reference.hpp"
#include "engine/output/output.hpp"

namespace yuragi::daemon::commands {
namespace {

std::string length_reason(const settings::WindConfig& wind, const settings::SensorConfig& sensor) {
  if (wind.default_length_m) return " (default_length)";
  const auto [height_m, scene_height_m] = sensor.heights;
  if (!height_m) return " (no height in its calibration)";
  const std::string brought = scene_height_m != *height_m ? fmt::format(", converted to {:g} m", scene_height_m) : "";
  return fmt::format(" (height {:g} m{})", *height_m, brought);
}

nlohmann::ordered_json json_of(const ParameterValues& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, value] : values.all())
    json[name] = std::visit([](const auto& shown) { return nlohmann::ordered_json(shown); }, printable(value));
  return json;
}

/// The time from which it is on.
std::optional<std::string> from_text(const settings::CameraConfig& camera) {
  if (!camera.values.has("from")) return std::nullopt;
  return camera.values.text("from");
}

/// The entries of a list of feeds: their names, and with `full` every value.
nlohmann::ordered_json list_json(const settings::Config& config, const settings::feeds::ListTable& list, bool full) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  const auto entries = config.lists.find(list.name);
  if (entries == config.lists.end()) return json;
  for (const settings::feeds::Entry& entry : entries->second) {
    json.push_back({{"name", entry.name}});
    if (!full) continue;
    json.back()["values"] = json_of(entry.values);
    for (const auto& [name, below] : entry.below) {
      for (const ParameterValues& values : below) json.back()[name].push_back(json_of(values));
    }
  }
  return json;
}

/// What print_summary() shows, and with `full` every value.
nlohmann::ordered_json config_json(const settings::Config& config, bool full) {
  nlohmann::ordered_json sensors = nlohmann::ordered_json::array();
  for (const settings::SensorConfig& sensor : config.sensors) {
    sensors.push_back({{"name", sensor.name},
                       {"driver", sensor.driver->name},
                       {"place", settings::place_text(sensor.blend)},
                       {"value", drivers::sensor::value_text(sensor.value)},
                       {"gust_length_m", settings::gust_length_m(config.wind, sensor)},
                       {"height_m", state::json_or_null(sensor.heights.sensor_m)}});
    if (!full) continue;
    sensors.back()["values"] = json_of(sensor.values);
    for (const settings::SensorTable& table : settings::sensor_tables())
      sensors.back()[table.name] = json_of(sensor.by_name.at(table.name));
  }
  nlohmann::ordered_json scenes = nlohmann::ordered_json::array();
  for (const settings::SceneConfig& scene : config.scenes) {
    scenes.push_back({{"name", scene.name}, {"kind", scene.kind->name}});
    if (full) scenes.back()["values"] = json_of(scene.values);
  }
  nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
  for (const settings::CameraConfig& camera : config.cameras) {
    cameras.push_back({{"name", camera.name}, {"from", state::json_or_null(from_text(camera))}});
    if (full) cameras.back()["values"] = json_of(camera.values);
  }
  nlohmann::ordered_json alerts = nlohmann::ordered_json::array();
  for (const settings::AlertConfig& alert : config.alerts) {
    alerts.push_back({{"name", alert.name}, {"when", alert.values.text("when")}});
    if (full) alerts.back()["values"] = json_of(alert.values);
  }
  nlohmann::ordered_json outputs = nlohmann::ordered_json::array();
  for (const output::Table& output : config.outputs) {
    nlohmann::ordered_json windows = nlohmann::ordered_json::array();
    for (const output::Window& window : output.output.windows) windows.push_back({{"monitor", window.monitor}});
    for (std::size_t i = 0; full && i < output.windows.size(); ++i) windows[i] = json_of(output.windows[i]);
    outputs.push_back({{"name", output.output.name}, {"windows", std::move(windows)}});
    if (full) outputs.back()["values"] = json_of(output.values);
  }
  nlohmann::ordered_json json = {
      {"sensors", sensors}, {"scenes", scenes}, {"cameras", cameras}, {"alerts", alerts}, {"outputs", outputs}};
  if (!config.page_file.empty()) json["page"] = {{"file", config.page_file}, {"kept", config.kept}};
  for (const settings::feeds::ListTable& list : settings::feeds::list_tables())
    json[list.name] = list_json(config, list, full);
  if (!full) return json;
  for (const settings::ConfigTable& table : settings::config_tables()) {
    const nlohmann::ordered_json values = json_of(config.by_name.at(table.name));
    if (table.name.empty()) {
      json.update(values);
    } else {
      json[table.name] = values;
    }
  }
  return json;
}

std::string page_calibration_text(const settings::Config& config, const settings::SensorConfig& sensor) {
  for (const settings::PageCalibration& calibration : config.page_calibrations) {
    if (calibration.sensor == sensor.name && calibration.why_not.empty())
      return ", calibrated on the page: " + calibration.values;
  }
  return "";
}

void print_summary(const settings::Config& config, const std::filesystem::path& file) {
  fmt::print("{}: no errors\n", file.string());
  if (!config.page_file.empty() && settings::page_warnings(config).empty())
    fmt::print("{}: no errors; its sensors, calibrations and values are read after the configuration\n",
               config.page_file);
  for (const std::string& value : config.kept) fmt::print("  {} is kept on the page\n", value);
  for (const settings::SensorConfig& sensor : config.sensors) {
    fmt::print("  sensor {} ({}), {}, gusts of {:.0f} m{}{}\n", sensor.name, sensor.driver->name,
               settings::place_text(sensor.blend), settings::gust_length_m(config.wind, sensor),
               length_reason(config.wind, sensor), page_calibration_text(config, sensor));
  }
  for (const settings::SceneConfig& scene : config.scenes)
    fmt::print("  scene {} ({})\n", scene.name, scene.kind->name);
  for (const settings::CameraConfig& camera : config.cameras) {
    const std::optional<std::string> from = from_text(camera);
    const std::optional<double>& angle_deg = camera.camera.wind_angle_deg;
    fmt::print("  camera {}{}{}\n", camera.name,
               angle_deg ? fmt::format(", keeps {:g} deg to the wind", *angle_deg) : std::string(),
               from ? fmt::format(", from {} ({})", *from, config.clock.zone_name()) : std::string());
  }
  for (const settings::AlertConfig& alert : config.alerts)
    fmt::print("  alert {} ({})\n", alert.name, alert.values.text("when"));
  for (const auto& [list, entries] : config.lists) {
    for (const settings::feeds::Entry& entry : entries)
      fmt::print("  {}{}\n", list, entry.name == list ? std::string() : " " + entry.name);
  }
}

struct CheckOptions {
  std::filesystem::path file;
  bool as_service = false;
  std::filesystem::path unit;
  bool full = false;
  bool as_json = false;
};

/// The problems of the unit with this configuration at the next boot.
void rehearse(const settings::Config& config, const CheckOptions& options) {
  namespace doctor = tools::doctor;
  const auto unit =
      options.unit.empty() ? doctor::installed_unit(doctor::kServiceUnit) : doctor::unit_of_file(options.unit);
  if (!unit) {
    throw FailureError({fmt::format("{} is not installed here; name its file: --unit FILE", doctor::kServiceUnit),
                        FailureKind::kNoInput});
  }
  const std::filesystem::path file = settings::absolute_path(options.file);
  const auto plugged = doctor::plugged_devices(config);
  std::vector<doctor::Finding> findings =
      doctor::judge({.file = file, .error = {}, .exposed = settings::exposed_secrets(config, file)});
  for (doctor::Finding& finding :
       doctor::rehearse({.config = config, .config_file = file, .unit = *unit, .plugged = plugged})) {
    findings.push_back(std::move(finding));
  }
  if (options.as_json) {
    print_json(doctor::findings_json(findings));
  } else {
    settings::write_at_once(doctor::findings_text(findings));
  }
  if (doctor::gravest(findings) == doctor::Verdict::kError) throw ExitError(kExitAttention, "");
}

void check_config(const CheckOptions& options) {
  const settings::Config config = settings::load_installation(options.file);
  service::check(config);
  if (!config.http.certificate.empty()) http::CertificateFiles(config.http.certificate, config.http.key);
  for (const std::string& warning : settings::page_warnings(config)) fmt::print(stderr, "warning: {}\n", warning);
  if (options.as_service) return rehearse(config, options);
  for (const std::string& warning : settings::exposed_secrets(config, options.file)) {
    fmt::print(stderr, "warning: {}\n", warning);
  }
  if (options.as_json) {
    print_json(config_json(config, options.full));
  } else if (options.full) {
    for (const std::string& value : config.kept)
      fmt::print("# {} is kept on the page, in {}\n", value, config.page_file);
    fmt::print("{}", settings::to_toml(config));
  } else {
    print_summary(config, options.file);
  }
}

void add_check_config(CLI::App& app) {
  CLI::App* command = app.add_subcommand("check-config", "check a configuration, and show what it amounts to");
  command->footer(
      "Exit code 0: no error; 78: errors, each reported as file:line:column: key: what is wrong.\nNo device is opened. "
      "--full prints the whole configuration with every default; \"(secret)\" replaces a password.\n"
      "Warns on standard error if others can read a password.\n"
      "Values that are kept on the page override the file's and are named.\n"
      "--json: sensors (name, driver, place, gust_length_m, height_m), scenes (name, kind), cameras (name, from), "
      "alerts\n(name, when), outputs (name, windows) and, if there is one, page (file, kept); with --full also the "
      "values of every table by the keys of the "
      "configuration, without "
      "secrets.\n"
      "--as-service tries the next boot: what yuragi.service would meet, for its own user (with sudo it can check "
      "everything):\nits user's rights to token, pictures, recordings, profiles and devices, ports, libraries, the "
      "wall's X server, monitors.\nExit code 0: no error; 1: errors, each with the command that fixes it. --json: as "
      "`yuragi doctor`.\n"
      "  sudo yuragi check-config /etc/yuragi/yuragi.toml --as-service");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("file", options->file, "the configuration")->required()->type_name("FILE.toml");
  CLI::Option* as_service =
      command->add_flag("--as-service", options->as_service, "try what the daemon's unit would meet at the next boot");
  command->add_option("--unit", options->unit, "the file of that unit; default: yuragi.service, as it is installed")
      ->needs(as_service)
      ->type_name("FILE");
  command->add_flag("--full", options->full, "print every value, including defaults, as TOML");
  add_json(*command, options->as_json);
  command->callback([options] { check_config(*options); });
}

/// A table of the configuration: its name in the file, what it is, its keys.
struct DescribedTable {
  std::string name;
  std::string summary;
  std::span<const Parameter> parameters;
};

std::vector<DescribedTable> all_tables() {
  std::vector<DescribedTable> all;
  for (const settings::ConfigTable& table : settings::config_tables()) {
    all.push_back({table.name.empty() ? std::string() : fmt::format("[{}]", table.name), std::string(table.summary),
                   table.parameters});
  }
  for (const drivers::sensor::DriverDescription* driver : drivers::sensor::driver_table()) {
    all.push_back(
        {"[[sensor]]", fmt::format("driver = \"{}\": {}", driver->name, driver->summary), driver->parameters});
  }
  for (const settings::SensorTable& table : settings::sensor_tables()) {
    all.push_back({fmt::format("[sensor.{}]", table.name),
                   fmt::format("below a [[sensor]] of any kind: {}", table.summary), table.parameters});
  }
  all.push_back({"[[scene]]", "of any kind: its place and visibility", settings::common_scene_parameters()});
  for (const scenes::Description* scene : scenes::scene_table()) {
    all.push_back({"[[scene]]", fmt::format("kind = \"{}\": {}", scene->name, scene->summary), scene->parameters});
  }
  all.push_back({"[[camera]]",
                 "a place to see the scenes from, with a name, and how it moves; viewers follow it at once, and take "
                 "the next when its time comes",
                 look::camera_parameters()});
  all.push_back(
      {"[[alert]]",
       "a condition that is reported by a command or a webhook, once when it begins and once when it ends; with "
       "a name",
       settings::alert_parameters()});
  all.push_back({"[[output]]",
                 "how `yuragi-viewer --config FILE` shows its picture on a wall; with a name if there are several, for "
                 "`--output NAME`",
                 output::output_parameters()});
  all.push_back({"[[output.window]]",
                 "below an [[output]]: a monitor that it fills, with all of the picture or a part; without any it is "
                 "the primary monitor",
                 output::window_parameters()});
  for (const settings::feeds::ListTable& list : settings::feeds::list_tables()) {
    all.push_back({fmt::format("[[{}]]", list.name), std::string(list.summary), list.parameters});
    for (const settings::feeds::ListTable& below : list.below)
      all.push_back({fmt::format("[[{}.{}]]", list.name, below.name), std::string(below.summary), below.parameters});
  }
  return all;
}

void describe_everything(bool as_json) {
  if (as_json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const DescribedTable& table : all_tables()) {
      json.push_back({{"table", table.name},
                      {"summary", table.summary},
                      {"parameters", tools::sensors::parameters_json(table.parameters)}});
    }
    return print_json(json);
  }
  fmt::print("# A configuration is a TOML file. Everything has a default; an empty file is allowed.\n");
  for (const DescribedTable& table : all_tables()) {
    fmt::print("\n{}  # {}\n{}", table.name, table.summary, tools::sensors::parameter_text(table.parameters));
  }
}

void add_describe(CLI::App& app) {
  CLI::App* command = app.add_subcommand("describe", "list every key of a configuration: unit, range, default, help");
  command->footer(
      "--json: a list with table, summary, parameters for each table; of a parameter name, type, unit, default, "
      "left_out\n"
      "(what it means if it is left out), min, max, choices, help.");
  auto as_json = std::make_shared<bool>(false);
  add_json(*command, *as_json);
  command->callback([as_json] { describe_everything(*as_json); });
}

}  // namespace

extern const Command kCheckConfigCommand;
const Command kCheckConfigCommand{add_check_config};

extern const Command kDescribeCommand;
const Command kDescribeCommand{add_describe};

}  // namespace yuragi::daemon::commands
