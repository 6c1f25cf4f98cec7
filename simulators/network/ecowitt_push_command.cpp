#include <array>
#include <cstdio>
#include <map>
#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/network/ecowitt_push_simulator.hpp"

namespace yuragi::simulators::network {
namespace {

struct EcowittPushCommand {
  std::string to = "127.0.0.1:8090";
  std::string protocol = "ecowitt";
  EcowittPushOptions push;
  core::CommonOptions common;
};

const std::map<std::string, PushProtocol, std::less<>> kPushProtocols = {
    {"ecowitt", PushProtocol::kEcowitt},
    {"wunderground", PushProtocol::kWunderground},
    {"ambient", PushProtocol::kAmbient},
    {"wslink", PushProtocol::kWsLink},
};

void simulate_ecowitt_push(EcowittPushCommand& command) {
  const Address address = core::address_option("--to", command.to);
  if (address.port == 0) throw CLI::ValidationError("--to", "port 0 is not possible; give the receiver's port");
  command.push.host = address.host;
  command.push.port = address.port;
  command.push.protocol = kPushProtocols.at(command.protocol);
  command.push.seed = command.common.synthetic.seed;
  EcowittPushSimulator simulator(command.push, command.common.make_wind());

  // Scripts wait for this line.
  std::printf("pushing to %s\n", command.to.c_str());
  std::fflush(stdout);
  command.common.run_simulator(simulator);
}

}  // namespace

extern const core::Command kEcowittPushCommand;
const core::Command kEcowittPushCommand{[](CLI::App& app) {
  auto options = std::make_shared<EcowittPushCommand>();
  CLI::App* command = app.add_subcommand(
      "ecowitt-push", "Ecowitt gateway, or station of Ambient, Wunderground or WSLink, which pushes by HTTP");
  command->add_option("--to", options->to, "push to HOST:PORT")->capture_default_str();
  command->add_option("--protocol", options->protocol, "protocol of the pushes")
      ->check(CLI::IsMember({"ecowitt", "wunderground", "ambient", "wslink"}))
      ->capture_default_str();
  command->add_option("--path", options->push.path, "the path that is set in the gateway; default: the usual one");
  command
      ->add_option("--station", options->push.station,
                   "the station's PASSKEY; with wunderground, its ID, with wslink, its wsid")
      ->capture_default_str();
  command->add_option("--interval", options->push.interval_s, "seconds between two pushes")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { simulate_ecowitt_push(*options); });
}};

}  // namespace yuragi::simulators::network
