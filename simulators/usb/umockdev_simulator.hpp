#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulators/core/simulator.hpp"
#include "simulators/usb/usb_port.hpp"

namespace yuragi::simulators::usb {

/// Simulated USB devices in a testbed of umockdev's: programs that run beside it in that testbed find them with libusb,
/// and stations with hidapi's hidraw backend, as if they were plugged in. An unplugged device disappears with its
/// nodes, and returns with new ones; udev's listeners get a uevent each time.
class UmockdevSimulator final : public core::Simulator {
 public:
  /// Throws std::runtime_error if this program does not run in umockdev (see is_in_umockdev()).
  explicit UmockdevSimulator(std::vector<std::unique_ptr<Port>> ports);
  ~UmockdevSimulator() override;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::simulators::usb
