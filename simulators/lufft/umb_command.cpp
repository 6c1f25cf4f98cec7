#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/lufft/umb_station.hpp"
#include "simulators/text/text_options.hpp"

namespace yuragi::simulators::lufft {
namespace {

struct UmbOptions {
  text::SerialOrTcpOptions line;
  UmbStationOptions station;
  bool has_no_fast_channels = false;
  core::CommonOptions common;

  void run() const {
    UmbStationOptions made = station;
    made.has_fast_channels = made.measures_more = !has_no_fast_channels;
    made.garbage_seed = common.synthetic.seed;
    UmbStation simulator(line.make_wire(), made, common.make_wind());
    text::print_place(simulator.wire());
    common.run_simulator(simulator);
  }
};

}  // namespace

extern const core::Command kUmbCommand;
const core::Command kUmbCommand{[](CLI::App& app) {
  auto options = std::make_shared<UmbOptions>();
  CLI::App* command = app.add_subcommand("umb", "Lufft weather station or VENTUS, with the binary UMB protocol");
  options->line.add_to(*command, "a serial device server at HOST:PORT");
  command->add_option("--class", options->station.device_class, "7: a weather station; 8: a VENTUS")
      ->check(CLI::Range(1, 14))
      ->capture_default_str();
  command->add_option("--id", options->station.id, "its id on the line")
      ->check(CLI::Range(1, 255))
      ->capture_default_str();
  command->add_flag("--without-fast", options->has_no_fast_channels,
                    "has no fast channels and measures only wind, like a VENTUS");
  command->add_flag("--only-wind", options->station.refuses_long_query, "refuses a query of more than two channels");
  command->add_flag("--echo", options->station.echoes,
                    "its line has one pair of wires: clients receive their own requests");
  options->common.add_to(*command);
  command->callback([options] { options->run(); });
}};

}  // namespace yuragi::simulators::lufft
