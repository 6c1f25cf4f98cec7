#include "simulators/text/text_options.hpp"

#include <cstdio>

namespace yuragi::simulators::text {

CLI::Option_group& SerialOrTcpOptions::add_to(CLI::App& command, const std::string& what_tcp_is) {
  CLI::Option_group* wire = command.add_option_group("wire", "how it is connected");
  CLI::Option* pty_flag = wire->add_flag("--pty", pty, "a serial port (a pseudo terminal)");
  wire->add_option("--tcp", tcp, what_tcp_is + "; port 0 takes a free one");
  wire->require_option(1);
  command
      .add_option("--link", link, "with --pty: create this link to the port, which stays when the device is unplugged")
      ->needs(pty_flag);
  return *wire;
}

std::unique_ptr<Wire> SerialOrTcpOptions::make_wire() const {
  if (pty) return make_pty_wire(link);
  const Address address = core::address_option("--tcp", tcp);
  return make_tcp_wire(address.host, address.port);
}

void print_place(const Wire& wire) {
  std::printf("%s\n", wire.place().c_str());
  std::fflush(stdout);
}

CLI::Option_group& Options::add_to(CLI::App& command) {
  CLI::Option_group& wire = line.add_to(command);
  wire.add_option("--udp", udp, "datagrams to HOST:PORT");
  command.add_option("--rate", rate_hz, "messages per second; 0: on request only")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  common.add_to(command);
  return wire;
}

void Options::add_websocket_to(CLI::App& command) {
  CLI::Option* const place =
      command.get_option_group("wire")->add_option("--websocket", websocket_place, "a WebSocket server at HOST:PORT");
  command.add_option("--token", websocket.token, "with --websocket: refuse clients without this token")->needs(place);
}

std::unique_ptr<Wire> Options::make_wire() const {
  if (!can.empty()) return make_can_wire(can);
  if (!websocket_place.empty()) {
    const Address address = core::address_option("--websocket", websocket_place);
    WebSocketWireOptions options = websocket;
    options.host = address.host;
    options.port = address.port;
    return make_websocket_wire(options);
  }
  if (udp.empty()) return line.make_wire();
  const Address address = core::address_option("--udp", udp);
  return make_udp_wire(address.host, address.port);
}

void Options::run(std::unique_ptr<Device> device) const {
  if (rate_hz <= 0.0 && !(udp.empty() && can.empty()))
    throw CLI::ValidationError("--rate", "this connection cannot receive requests; give a rate");
  Simulator simulator(std::move(device), make_wire(), rate_hz, common.make_wind(), common.synthetic.seed);
  print_place(simulator.wire());
  common.run_simulator(simulator);
}

}  // namespace yuragi::simulators::text
