#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulators/usb/emulated_node.hpp"
#include "simulators/usb/readiness_node.hpp"
#include "simulators/usb/usb_host.hpp"

namespace yuragi::simulators::usb {

/// /dev/hidrawN of a simulated device, with the kernel's usbhid behind it: reports are read while a program has it
/// open, and kept until it reads them; writes become SET_REPORT, or go to the interrupt OUT end point if there is one.
/// Source: Linux 6.1, drivers/hid/hidraw.c and drivers/hid/usbhid/hid-core.c.
class HidrawNode final : public EmulatedNode {
 public:
  /// `path`: the node's file inside the testbed. `host` must outlive unplug().
  HidrawNode(Host& host, const std::string& path);

  void serve(double time_s) override;
  void unplug() override;

 private:
  void obey(ProgramCall call);
  void obey_ioctl(ProgramCall call);
  void get_report(ProgramCall call, const ProgramMemory& buffer, std::uint16_t type);
  void set_report(ProgramCall call, std::span<const std::uint8_t> report, std::uint16_t type);
  /// Submits a control transfer; the program that waits in `call` waits for kTimeout_s at most.
  void submit(const std::shared_ptr<ProgramCall>& call, Transfer transfer, Host::Then then);
  void give_up_late_ones();
  void read_reports();
  void hand_out_reports();

  /// A call that waits for a transfer.
  struct Pending {
    std::uint64_t transfer = 0;
    double deadline_s = 0.0;
    std::weak_ptr<ProgramCall> call;  // expires when it is completed
  };

  Host* host_;
  ReadinessNode readiness_;
  std::uint8_t in_endpoint_ = 0;
  std::uint8_t out_endpoint_ = 0;
  std::size_t report_size_ = 0;
  std::optional<std::uint64_t> reading_;  // the transfer that waits for the next report
  std::deque<Bytes> reports_;
  std::deque<ProgramCall> readers_;
  std::vector<Pending> pending_;
  double time_s_ = 0.0;
};

}  // namespace yuragi::simulators::usb
