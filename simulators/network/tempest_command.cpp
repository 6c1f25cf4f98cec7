#include <cstdio>
#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/network/tempest_simulator.hpp"

namespace yuragi::simulators::network {
namespace {

struct TempestCommand {
  std::string to = "127.0.0.1:50222";
  TempestOptions tempest;
  core::CommonOptions common;
};

void simulate_tempest(TempestCommand& command) {
  const Address address = core::address_option("--udp", command.to);
  if (address.port == 0) throw CLI::ValidationError("--udp", "port 0 is not possible; give the receiver's port");
  command.tempest.host = address.host;
  command.tempest.port = address.port;
  command.tempest.seed = command.common.synthetic.seed;
  TempestSimulator simulator(command.tempest, command.common.make_wind());

  // Scripts wait for this line.
  std::printf("sending to %s\n", command.to.c_str());
  std::fflush(stdout);
  command.common.run_simulator(simulator);
}

}  // namespace

extern const core::Command kTempestCommand;
const core::Command kTempestCommand{[](CLI::App& app) {
  auto options = std::make_shared<TempestCommand>();
  CLI::App* command = app.add_subcommand("tempest", "WeatherFlow hub with Tempest stations, which sends JSON by UDP");
  command->add_option("--udp", options->to, "send to HOST:PORT, which may be a broadcast address")
      ->capture_default_str();
  command->add_option("--station", options->tempest.stations, "serial number of a station; can be repeated")
      ->capture_default_str();
  command
      ->add_option("--interval", options->tempest.rapid_wind_interval_s,
                   "seconds between rapid winds; 0: none, observations only")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_option("--report-interval", options->tempest.report_interval_s, "seconds between observations")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { simulate_tempest(*options); });
}};

}  // namespace yuragi::simulators::network
