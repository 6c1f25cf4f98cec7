#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/network/ecowitt_simulator.hpp"

namespace yuragi::simulators::network {
namespace {

struct EcowittCommand {
  std::string tcp = "127.0.0.1:45000";
  std::string search;
  EcowittOptions ecowitt;
  core::CommonOptions common;
};

void simulate_ecowitt(EcowittCommand& command) {
  const Address address = core::address_option("--tcp", command.tcp);
  command.ecowitt.host = address.host;
  command.ecowitt.port = address.port;
  command.ecowitt.seed = command.common.synthetic.seed;
  if (!command.search.empty()) {
    const Address search = core::address_option("--search", command.search);
    command.ecowitt.search_host = search.host;
    command.ecowitt.search_port = search.port;
  }
  EcowittSimulator simulator(command.ecowitt, command.common.make_wind());

  // Scripts wait for this line.
  std::printf("listening on %s\n", to_string(Address{address.host, simulator.port()}).c_str());
  std::fflush(stdout);
  command.common.run_simulator(simulator);
}

}  // namespace

extern const core::Command kEcowittCommand;
const core::Command kEcowittCommand{[](CLI::App& app) {
  auto options = std::make_shared<EcowittCommand>();
  CLI::App* command = app.add_subcommand("ecowitt", "Ecowitt gateway (GW1000), which is asked over TCP");
  command->add_option("--tcp", options->tcp, "HOST:PORT to listen on; port 0 takes a free one")->capture_default_str();
  command->add_option("--search", options->search,
                      "UDP HOST:PORT at which it replies to searches for gateways, such as 0.0.0.0:46000; without it "
                      "there is no reply");
  command->add_option("--interval", options->ecowitt.interval_s, "seconds between the anemometer's radio messages")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_option("--late-by", options->ecowitt.late_s, "delay of a reply under the fault late, s")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { simulate_ecowitt(*options); });
}};

}  // namespace yuragi::simulators::network
