// `yuragi calibrate`: guides a person through the calibration of a sensor, and writes the configuration.
#include "daemon/commands/calibrate.hpp"

#include "daemon/commands/command.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/settings/page_file.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/tools/calibration/calibration_report.hpp"

namespace yuragi::daemon::commands {

extern const Command kCalibrateCommand;

namespace {

constexpr const char* kCalibrateFooter =
    "The steps for a new sensor, in this order: zero (still air), span (a known wind, or a reference sensor), north\n"
    "(the direction of its vane). A microphone needs only the step microphone. Measurements, changes and their\n"
    "effect are shown before anything is written. The file keeps its comments and layout, and the previous one is\n"
    "kept as FILE.bak. A running daemon that was started with this file reads it again (`yuragi reload`).\n"
    "An implausible result is refused, with the reason.\n"
    "What the page has calibrated is taken over into the file, which then counts.\n"
    "\n"
    "Live readings come from the running daemon if there is one, otherwise from the device; with --recording from\n"
    "a recording. Recordings hold uncalibrated readings, so a calibration can be repeated at any time.\n"
    "\n"
    "  yuragi calibrate zero --config wall.toml --sensor roof\n"
    "  yuragi calibrate north --config wall.toml --sensor roof --bearing 214\n"
    "  yuragi calibrate span --config wall.toml --sensor roof --reference handheld --for 1200\n"
    "  yuragi calibrate microphone --config wall.toml --sensor mic --reference roof --recording may.windlog\n"
    "\n"
    "Exit code 0: done (or declined); 64: wrong command line; 65: the measurement is refused; 66: the recording\n"
    "does not exist; 69: a sensor is silent, or the daemon must be stopped first; 73: the file cannot be written;\n"
    "78: the file has an error.";

void list_calibrations(const std::filesystem::path& file, bool as_json) {
  const auto all = tools::calibration::calibrations_json(settings::load_installation(file));
  if (as_json) return print_json(all);
  for (const auto& sensor : all) {
    std::string names;
    for (const auto& way : sensor["ways"]) {
      const auto name = way["calibration"].get<std::string>();
      if (names.find(name) == std::string::npos) names += (names.empty() ? "" : ", ") + name;
    }
    settings::write_at_once(sensor["sensor"].get<std::string>() + ": " + (names.empty() ? "none" : names) + "\n");
  }
}

void add_calibrate_list(CLI::App& calibrate) {
  struct ListOptions {
    std::filesystem::path file;
    bool as_json = false;
  };
  CLI::App* command = calibrate.add_subcommand("list", "how each sensor can be calibrated");
  command->footer(
      "--json: also what to prepare, for how long it listens, and the present values.\n"
      "  yuragi calibrate list --config wall.toml");
  auto options = std::make_shared<ListOptions>();
  command->add_option("--config,-c", options->file, "the configuration file")->required()->type_name("FILE");
  add_json(*command, options->as_json);
  command->callback([options] { list_calibrations(options->file, options->as_json); });
}

void add_calibrate(CLI::App& app) {
  CLI::App* calibrate = app.add_subcommand("calibrate", "Calibrate a sensor, and write the configuration");
  calibrate->require_subcommand(1);
  calibrate->footer(kCalibrateFooter);
  add_calibrate_list(*calibrate);
  add_calibrate_zero(*calibrate);
  add_calibrate_north(*calibrate);
  add_calibrate_span(*calibrate);
  add_calibrate_microphone(*calibrate);
}

}  // namespace

void add_calibration_request(CLI::App& command, tools::calibration::Request& request,
                             const std::string& default_duration) {
  command.add_option("--config,-c", request.config_file, "the configuration file, which is read and written")
      ->required()
      ->type_name("FILE");
  command.add_option("--sensor", request.sensor, "which sensor; optional if there is only one")->type_name("NAME");
  command
      .add_option("--for", request.duration_s,
                  "how long to listen: 90 (seconds), 20min (default " + default_duration + ")")
      ->type_name("TIME")
      ->transform(duration_in_seconds())
      ->check(CLI::Range(1.0, 86400.0));
  command.add_option("--recording", request.recording, "use this recording instead of live readings")
      ->type_name("FILE.windlog");
  command.add_option("--part", request.parts, "part of the recording, in seconds; can be repeated")
      ->type_name("FROM,TO")
      ->expected(1)
      ->take_all();
  add_connect(command, request.connect);
  command.add_flag("--yes,-y", request.takes_yes, "write without asking and without waiting");
  command.add_flag("--dry-run", request.is_dry_run, "show what would be written, but write nothing");
}

void add_calibration_json(CLI::App& command, tools::calibration::Request& request) {
  command.add_flag("--json", request.as_json,
                   "write nothing, ask nothing, and print the progress and the result: a JSON object a line, each with "
                   "all so far");
}

const Command kCalibrateCommand{add_calibrate};

}  // namespace yuragi::daemon::commands
