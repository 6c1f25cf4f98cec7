#include <filesystem>
#include <memory>
#include <string>

#include "engine/base/duration.hpp"
#include "simulators/core/command.hpp"
#include "simulators/core/rehearsal.hpp"

namespace yuragi::simulators::core {
namespace {

constexpr const char* kScenarioFooter =
    "FILE (TOML) describes the wind over time, the devices, and their faults:\n"
    "\n"
    "  duration = \"10min\"             # without it: runs until it is stopped\n"
    "\n"
    "  [[wind]]                       # a synthetic wind\n"
    "  speed = 2.5                    # m/s; also direction, turbulence, seed, like the simulators' options\n"
    "\n"
    "  [[wind]]                       # a storm front, which comes up within 20 s\n"
    "  at = \"4min\"\n"
    "  ramp = \"20s\"\n"
    "  recording = \"storm.windlog\"    # beside FILE; or speed, direction, turbulence, seed\n"
    "\n"
    "  [[device]]\n"
    "  name = \"roof\"\n"
    "  simulate = \"modbus --tcp 127.0.0.1:1502 --device renke-rs-fsjt-rs-fxjt-n01\"  # any other simulator's options\n"
    "  faults = [\"silence@6min+20s\", \"unplug@8min+1min\"]\n"
    "\n"
    "All devices are in the same wind. While it runs, standard input takes: DEVICE KIND [TIME], DEVICE clear, DEVICE\n"
    "help. It ends with an error if a device fails, for example if its port is in use. Rehearsals of whole\n"
    "installations, with the daemon's configuration for each, are in config/rehearsals.";

struct ScenarioOptions {
  std::string file;
  RunOptions run;
};

void rehearse(const ScenarioOptions& options) {
  const Scenario scenario = read_scenario(options.file);
  Rehearsal rehearsal(scenario, std::filesystem::read_symlink("/proc/self/exe"), options.file);
  RunOptions run_options = options.run;
  if (!run_options.duration_s) run_options.duration_s = scenario.duration_s;
  run(rehearsal, Faults(rehearsal.known_faults()), run_options);
}

}  // namespace

extern const Command kScenarioCommand;
const Command kScenarioCommand{[](CLI::App& app) {
  auto options = std::make_shared<ScenarioOptions>();
  CLI::App* command =
      app.add_subcommand("scenario", "rehearse several devices in one wind, with faults at given times");
  command->add_option("FILE", options->file, "the scenario")->required()->check(CLI::ExistingFile);
  command->add_option("--duration", options->run.duration_s, "end after this time: 90 (seconds), 5min, 2h")
      ->type_name("TIME")
      ->transform(CLI::Validator(duration_to_seconds, ""))
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--verbose", options->run.verbose, "print the wind every second even without a terminal");
  command->footer(kScenarioFooter);
  command->callback([options] { rehearse(*options); });
}};

}  // namespace yuragi::simulators::core
