#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/bus/byte_port.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::commands {

/// A yuragi-sim that listens at a free port. It is killed with this object, and by the system when the thread that
/// started it ends in any other way.
class SimulatorProcess {
 public:
  /// Waits until it listens, for at most 10 s. Fails if it is not installed (beside this program, or in the system's
  /// folders of programs), or cannot play what was asked for.
  static Result<SimulatorProcess, Failure> start(const std::vector<std::string>& arguments);

  std::uint16_t port() const { return port_; }

 private:
  SimulatorProcess(std::unique_ptr<drivers::bus::BytePort> process, std::uint16_t port)
      : process_(std::move(process)), port_(port) {}

  std::unique_ptr<drivers::bus::BytePort> process_;
  std::uint16_t port_;
};

}  // namespace yuragi::daemon::commands
