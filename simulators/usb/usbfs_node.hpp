#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "simulators/usb/emulated_node.hpp"
#include "simulators/usb/readiness_node.hpp"
#include "simulators/usb/usb_host.hpp"

namespace yuragi::simulators::usb {

/// /dev/bus/usb/BBB/DDD of a simulated device, as far as libusb uses it: transfers are submitted, discarded and reaped.
/// A program that waits for a transfer's end really waits: the node becomes writable when it has completed. Source:
/// Linux 6.1, drivers/usb/core/devio.c and include/uapi/linux/usbdevice_fs.h; libusb 1.0.26, os/linux_usbfs.c.
class UsbfsNode final : public EmulatedNode {
 public:
  /// `path`: the node's file inside the testbed. `host` must outlive unplug().
  UsbfsNode(Host& host, const std::string& path);

  void serve(double time_s) override;
  void unplug() override;

 private:
  /// A URB of the program.
  struct Urb {
    ProgramMemory memory;  // its struct usbdevfs_urb
    ProgramMemory buffer;
    std::size_t header_size = 0;  // size of a control transfer's setup at the beginning of the buffer
    std::uint64_t transfer = 0;
  };

  void obey(ProgramCall call);
  void submit(ProgramCall call);
  void discard(ProgramCall call);
  void reap(ProgramCall call);
  void finish(std::uintptr_t address, const Outcome& outcome);
  void finish(std::uintptr_t address, int status, std::size_t size);

  Host* host_;
  ReadinessNode readiness_;
  std::map<std::uintptr_t, Urb> under_way_;  // by the URB's address in the program
  std::deque<Urb> done_;
};

}  // namespace yuragi::simulators::usb
