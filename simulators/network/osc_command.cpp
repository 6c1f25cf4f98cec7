#include <cstdio>
#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/network/osc_simulator.hpp"

namespace yuragi::simulators::network {
namespace {

constexpr std::size_t kLastArgument = 63;  // as the daemon reads

struct OscCommand {
  std::string to = "127.0.0.1:9000";
  OscOptions osc;
  core::CommonOptions common;
};

void simulate_osc(OscCommand& command) {
  const Address address = core::address_option("--to", command.to);
  if (address.port == 0) throw CLI::ValidationError("--to", "port 0 is not possible; give the receiver's port");
  if (!command.osc.address.starts_with('/')) throw CLI::ValidationError("--address", "must begin with /, as in /wind");
  if (command.osc.speed_argument == command.osc.direction_argument)
    throw CLI::ValidationError("--direction-argument", "is the same as --speed-argument; choose another number");
  command.osc.host = address.host;
  command.osc.port = address.port;
  command.osc.seed = command.common.synthetic.seed;
  OscSimulator simulator(command.osc, command.common.make_wind());

  // Scripts wait for this line.
  std::printf("sending to %s\n", command.to.c_str());
  std::fflush(stdout);
  command.common.run_simulator(simulator);
}

}  // namespace

extern const core::Command kOscCommand;
const core::Command kOscCommand{[](CLI::App& app) {
  auto options = std::make_shared<OscCommand>();
  CLI::App* command = app.add_subcommand("osc", "program that sends the wind as Open Sound Control messages by UDP");
  command->add_option("--to", options->to, "send to HOST:PORT")->capture_default_str();
  command->add_option("--address", options->osc.address, "the messages' OSC address")->capture_default_str();
  command->add_option("--speed-argument", options->osc.speed_argument, "which argument is the speed; the first is 0")
      ->check(CLI::Range(std::size_t{0}, kLastArgument))
      ->capture_default_str();
  command->add_option("--direction-argument", options->osc.direction_argument, "which argument is the direction")
      ->check(CLI::Range(std::size_t{0}, kLastArgument))
      ->capture_default_str();
  command->add_option("--interval", options->osc.interval_s, "seconds between messages")
      ->check(CLI::Range(0.001, 3600.0))
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { simulate_osc(*options); });
}};

}  // namespace yuragi::simulators::network
