#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"
#include "simulators/modbus/modbus_simulator.hpp"

namespace yuragi::simulators::modbus {
namespace {

struct Options {
  std::string tcp = "127.0.0.1:1502";
  bool is_rtu = false;
  std::string link;
  std::vector<std::string> devices;
  std::optional<int> fault_id;
  double late_s = FaultOptions{}.late_s;
  core::CommonOptions common;
};

/// The slaves of all devices. Throws CLI::ValidationError for an unknown device.
std::vector<Slave> slaves_of(std::vector<std::string> devices) {
  if (devices.empty()) devices.emplace_back("renke-rs-fsjt-rs-fxjt-n01");
  std::vector<Slave> slaves;
  try {
    for (const std::string& device : devices) {
      const auto more = modbus_slaves(device);
      slaves.insert(slaves.end(), more.begin(), more.end());
    }
  } catch (const std::runtime_error& error) {
    throw CLI::ValidationError("--device", error.what());
  }
  return slaves;
}

void simulate_modbus(const Options& options) {
  const std::vector<Slave> slaves = slaves_of(options.devices);
  std::unique_ptr<Port> port;
  if (options.is_rtu) {
    port = make_modbus_rtu_port(options.link);
  } else {
    const Address address = core::address_option("--tcp", options.tcp);
    port = make_modbus_tcp_port(address.host, address.port);
  }
  FaultOptions faults{.id = std::nullopt, .late_s = options.late_s, .seed = options.common.synthetic.seed};
  if (options.fault_id) faults.id = static_cast<std::uint8_t>(*options.fault_id);
  Simulator simulator(slaves, std::move(port), options.common.make_wind(), faults);

  // Scripts wait for this line.
  std::printf("%s %s\n", options.is_rtu ? "serving" : "listening on", simulator.name().c_str());
  std::fflush(stdout);
  options.common.run_simulator(simulator);
}

}  // namespace

extern const core::Command kModbusCommand;
const core::Command kModbusCommand{[](CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("modbus", "Modbus line, over TCP or serial (RTU), with the registers of real wind sensors");
  CLI::Option* tcp = command->add_option("--tcp", options->tcp, "HOST:PORT to listen on; port 0 takes a free one");
  tcp->capture_default_str();
  CLI::Option* rtu = command->add_flag("--rtu", options->is_rtu, "simulate a serial port (a pseudo terminal) instead");
  rtu->excludes(tcp);
  command->add_option("--link", options->link, "with --rtu: create this link to the port")->needs(rtu);
  command->add_option("--device,--profile", options->devices,
                      fmt::format("NAME or NAME@ID, with the id of its first slave; can be repeated, for several "
                                  "devices on one line. NAME is one of {} (default renke-rs-fsjt-rs-fxjt-n01)",
                                  fmt::join(modbus_device_names(), ", ")));
  command->add_option("--fault-id", options->fault_id, "apply the faults to this slave only; default: to all")
      ->check(CLI::Range(1, 247));
  command->add_option("--late-by", options->late_s, "delay of a reply under the fault late, s")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { simulate_modbus(*options); });
}};

}  // namespace yuragi::simulators::modbus
