#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/davis/vantage_console.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::davis {
namespace {

struct Options {
  text::SerialOrTcpOptions line;
  VantageConsoleOptions console;
  bool has_old_firmware = false;
  core::CommonOptions common;

  void run() const {
    VantageConsoleOptions made = console;
    made.knows_lps = !has_old_firmware;
    made.garbage_seed = common.synthetic.seed;
    VantageConsole simulator(line.make_wire(), made, common.make_wind());
    text::print_place(simulator.wire());
    common.run_simulator(simulator);
  }
};

}  // namespace

extern const core::Command kDavisCommand;
const core::Command kDavisCommand{[](CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("davis", "console of a Davis Vantage station, with its data logger");
  options->line.add_to(*command, "a server at HOST:PORT, like a WeatherLinkIP");
  command->add_option("--interval", options->console.interval_s, "seconds between packets")
      ->check(CLI::Range(0.05, 60.0))
      ->capture_default_str();
  command->add_flag("--old-firmware", options->has_old_firmware, "does not know the command LPS (before 1.90)");
  options->common.add_to(*command);
  command->callback([options] { options->run(); });
}};

}  // namespace yuragi::simulators::davis
