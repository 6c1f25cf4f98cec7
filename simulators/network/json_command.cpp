#include <cstdio>
#include <memory>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/network/json_simulator.hpp"

namespace yuragi::simulators::network {
namespace {

struct JsonCommand {
  std::string tcp = "127.0.0.1:8080";
  JsonOptions json{.speed_at = ""};
  core::CommonOptions common;
};

void simulate_json(JsonCommand& command) {
  const Address address = core::address_option("--tcp", command.tcp);
  command.json.host = address.host;
  command.json.port = address.port;
  if (command.json.speed_at.empty()) {
    command.json.speed_at = "/wind/speed";
    if (command.json.direction_at.empty()) command.json.direction_at = "/wind/direction";
  }
  command.json.seed = command.common.synthetic.seed;
  JsonSimulator simulator(command.json, command.common.make_wind());

  // Scripts wait for this line.
  std::printf("listening on %s\n", to_string(Address{address.host, simulator.port()}).c_str());
  std::fflush(stdout);
  command.common.run_simulator(simulator);
}

}  // namespace

extern const core::Command kJsonCommand;
const core::Command kJsonCommand{[](CLI::App& app) {
  auto options = std::make_shared<JsonCommand>();
  JsonOptions& json = options->json;
  CLI::App* command = app.add_subcommand("json", "a web server that replies with the wind as JSON, by HTTP");
  command->add_option("--tcp", options->tcp, "HOST:PORT to listen on; port 0 takes a free one")->capture_default_str();
  command->add_option("--speed-at", json.speed_at,
                      "JSON pointer to the speed; default: /wind/speed, with the direction at /wind/direction");
  command->add_option("--direction-at", json.direction_at, "JSON pointer to the direction");
  command->add_option("--gust-at", json.gust_at, "JSON pointer to the gust");
  command->add_option("--time-at", json.time_at, "JSON pointer to the time of the observation");
  command->add_option("--unit", json.unit, "unit of speed and gust")
      ->check(CLI::IsMember({"m/s", "km/h", "kn", "mph", "ft/s"}))
      ->capture_default_str();
  command->add_option("--interval", json.interval_s, "seconds between two observations")
      ->check(CLI::Range(0.05, 3600.0))
      ->capture_default_str();
  command->add_option("--late-by", json.late_s, "delay of a reply under the fault late, s")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { simulate_json(*options); });
}};

}  // namespace yuragi::simulators::network
