#pragma once

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "simulators/core/common_options.hpp"
#include "simulators/text/text_simulator.hpp"

namespace yuragi::simulators::text {

/// The options of a wire that is a serial port or a server of TCP.
struct SerialOrTcpOptions {
  bool pty = false;
  std::string link;
  std::string tcp;

  /// Returns the group of options of which one selects the connection of the device.
  CLI::Option_group& add_to(CLI::App& command, const std::string& what_tcp_is = "a server at HOST:PORT");
  /// Throws CLI::ValidationError, std::runtime_error for an address that cannot be listened on.
  std::unique_ptr<Wire> make_wire() const;
};

/// Prints a simulator's address, for scripts that wait for that line.
void print_place(const Wire& wire);

/// The options of simulators that send text: over which transport, and how often.
struct Options {
  SerialOrTcpOptions line = {};
  std::string udp;
  std::string can;                      ///< of the commands whose device sends frames
  WebSocketWireOptions websocket = {};  ///< its path: what clients request
  std::string websocket_place;          ///< HOST:PORT; empty: no WebSocket
  double rate_hz = 4.0;
  core::CommonOptions common;

  /// Returns the group of options of which one selects the connection of the device.
  CLI::Option_group& add_to(CLI::App& command);
  /// Adds the options of a device that also has a WebSocket server; after add_to().
  void add_websocket_to(CLI::App& command);

  /// Prints the device's address, for scripts that wait for that line, and runs it to its end. Throws
  /// CLI::ValidationError for options that contradict each other, std::runtime_error for an address that cannot be
  /// listened on.
  void run(std::unique_ptr<Device> device) const;

 private:
  std::unique_ptr<Wire> make_wire() const;
};

}  // namespace yuragi::simulators::text
