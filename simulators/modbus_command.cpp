#include <cstdio>
#include <memory>
#include <string>

#include "simulators/commands.hpp"
#include "simulators/common_options.hpp"
#include "simulators/modbus_simulator.hpp"

namespace yuragi::sim {
namespace {

struct Options {
  std::string tcp = "127.0.0.1:1502";
  std::string profile = "renke-rs-fsjt-rs-fxjt-n01";
  CommonOptions common;
};

void simulate(const Options& options) {
  const Address address = parse_address("--tcp", options.tcp);
  ModbusSimulator simulator(options.profile, address.host, address.port, options.common.synthetic.seed,
                            options.common.make_wind());

  // Scripts wait for this line.
  std::printf("listening on %s:%u\n", address.host.c_str(), static_cast<unsigned>(simulator.port()));
  std::fflush(stdout);
  options.common.run_simulator(simulator);
}

}  // namespace

void add_modbus_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("modbus", "Modbus TCP server with the registers of real wind sensors");
  command->add_option("--tcp", options->tcp, "HOST:PORT to listen on; port 0 takes a free one")->capture_default_str();
  command->add_option("--profile", options->profile, "device: one of the simulator's own")
      ->check(CLI::IsMember(modbus_device_names()))
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { simulate(*options); });
}

}  // namespace yuragi::sim
