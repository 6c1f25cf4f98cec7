// `yuragi calibrate`: guides a person through the calibration of a sensor, and writes the configuration.
#include "daemon/commands/calibrate.hpp"

#include "daemon/commands/command.hpp"
#include "daemon/commands/run_options.hpp"

namespace yuragi {

extern const Command kCalibrateCommand;

namespace {

constexpr const char* kCalibrateFooter =
    "A new sensor, in this order: zero (still air), span (a known wind, or a sensor that is right), north (where its\n"
    "vane points); a microphone: microphone, then nothing else. What was measured, what changes and its effect are\n"
    "shown before anything is written; comments and layout of the file stay, and what it said before is kept beside\n"
    "it as FILE.bak. Where it learned something that cannot be right, it refuses and says why.\n"
    "\n"
    "Live readings come from the running daemon where there is one, else from the device. --recording takes them from\n"
    "a recording instead, which holds what the sensor itself said: a calibration can be done again at any time.\n"
    "\n"
    "  yuragi calibrate zero --config wall.toml --sensor roof\n"
    "  yuragi calibrate north --config wall.toml --sensor roof --bearing 214\n"
    "  yuragi calibrate span --config wall.toml --sensor roof --reference handheld --for 1200\n"
    "  yuragi calibrate microphone --config wall.toml --sensor mic --reference roof --recording may.windlog\n"
    "\n"
    "Exit code 0: done (or not wanted after all); 64: the command line; 65: what was measured is refused; 66: there "
    "is\n"
    "no such recording; 69: a sensor is silent, or the daemon must be ended first; 73: the file cannot be written;\n"
    "78: it is wrong.";

void add_calibrate(CLI::App& app) {
  CLI::App* calibrate = app.add_subcommand("calibrate", "Calibrate a sensor, and write the configuration");
  calibrate->require_subcommand(1);
  calibrate->footer(kCalibrateFooter);
  add_calibrate_zero(*calibrate);
  add_calibrate_north(*calibrate);
  add_calibrate_span(*calibrate);
  add_calibrate_microphone(*calibrate);
}

}  // namespace

void add_calibration_request(CLI::App& command, CalibrationRequest& request, const std::string& default_duration) {
  command.add_option("--config,-c", request.config_file, "the installation, which is read and written")
      ->required()
      ->type_name("FILE");
  command.add_option("--sensor", request.sensor, "which one; may be left out where there is only one")
      ->type_name("NAME");
  command
      .add_option("--for", request.duration_s,
                  "how long to listen: 90 (seconds), 20min (default " + default_duration + ")")
      ->type_name("TIME")
      ->transform(duration_in_seconds())
      ->check(CLI::Range(1.0, 86400.0));
  command.add_option("--recording", request.recording, "learn from this recording, not from live readings")
      ->type_name("FILE.windlog");
  command.add_option("--part", request.parts, "of the recording: from this second to that one; can be given again")
      ->type_name("FROM,TO")
      ->expected(1)
      ->take_all();
  add_connect(command, request.connect);
  command.add_flag("--yes,-y", request.takes_yes, "write without asking, and wait for nobody");
  command.add_flag("--dry-run", request.is_dry_run, "show what would be written, and write nothing");
}

const Command kCalibrateCommand{add_calibrate};

}  // namespace yuragi
