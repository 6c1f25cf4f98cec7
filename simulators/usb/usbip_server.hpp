#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulators/core/simulator.hpp"
#include "simulators/usb/usb_port.hpp"

namespace yuragi::simulators::usb {

/// Simulated USB devices as a USB/IP server: any Linux machine with the module vhci_hcd can attach them as if they were
/// plugged in, by `usbip attach -r HOST -b 1-1` (the first; the second is 1-2, and so on). A device is given to one
/// host at a time. Unplugged, it is not offered, and the connection of the host that has it is closed.
class UsbipServer final : public core::Simulator {
 public:
  /// Listens at once; port 0 takes a free one. Throws std::runtime_error for an address that cannot be listened on.
  UsbipServer(const std::string& host, std::uint16_t port, std::vector<std::unique_ptr<Port>> ports);
  ~UsbipServer() override;

  /// The port that it listens on.
  std::uint16_t port() const;

  std::span<const core::FaultKind> known_faults() const override;
  std::vector<int> descriptors() const override;
  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) override;
  std::string status() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The faults that any of these devices can play; a device ignores a fault that it does not know.
std::vector<core::FaultKind> faults_of(std::span<const std::unique_ptr<Port>> ports);

}  // namespace yuragi::simulators::usb
