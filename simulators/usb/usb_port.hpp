#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "simulators/faults.hpp"
#include "simulators/played_wind.hpp"
#include "simulators/usb/usb_device.hpp"
#include "simulators/usb/usb_standard.hpp"

namespace yuragi::sim {

/// What a host asks of an end point. Number 0 is the control pipe; there `setup` counts.
struct UsbTransfer {
  std::uint64_t id = 0;  ///< the carrier's own
  std::uint8_t endpoint = 0;
  bool is_to_host = false;
  UsbSetup setup;
  UsbBytes data;             ///< what the host sends
  std::size_t max_size = 0;  ///< how much it would take
};

/// What became of it.
struct UsbOutcome {
  std::uint64_t id = 0;
  bool is_refused = false;  ///< stalled; what follows is empty
  UsbBytes data;            ///< what the host gets
  std::size_t size = 0;     ///< how much went, whichever way
};

/// A simulated device in its wind, as whatever attaches it to a host sees it: transfers go in, outcomes come out, at
/// once or when the device has something to say. Two faults are played here, for every device alike: a silent device
/// hears and says nothing (but still tells what it is), an unplugged one is not there; what it would have said is lost.
/// It computes; thread-safe: no.
class UsbPort {
 public:
  UsbPort(std::unique_ptr<UsbDevice> device, MeasuredWind wind);

  const UsbSummary& summary() const noexcept { return summary_; }
  const UsbDescriptors& descriptors() const { return device_->descriptors(); }
  const PlayedMoment& moment() const noexcept { return moment_; }
  /// What the device can suffer, and what its port can.
  std::span<const FaultKind> known_faults() const noexcept { return known_faults_; }

  /// Goes on to a moment. Unplugging forgets all transfers.
  void advance(double time_s, std::optional<FaultKind> fault);
  bool is_plugged_in() const noexcept { return is_plugged_in_; }

  void submit(UsbTransfer transfer);
  /// Forgets a transfer that has no outcome yet; false: it is not waiting.
  bool cancel(std::uint64_t id);
  /// Forgets all transfers: the host is gone.
  void cancel_all();

  /// What has come about since the last call. Transfers to one end point end in the order in which they came.
  std::vector<UsbOutcome> take_outcomes();

 private:
  std::optional<UsbOutcome> attempt(const UsbTransfer& transfer);
  void lose_what_waits();

  std::unique_ptr<UsbDevice> device_;
  UsbControlPipe control_pipe_;
  UsbSummary summary_;
  std::vector<FaultKind> known_faults_;
  std::vector<FaultKind> device_faults_;
  MeasuredWind wind_;
  PlayedMoment moment_;
  bool is_plugged_in_ = true;
  bool is_silent_ = false;
  std::deque<UsbTransfer> waiting_;
};

}  // namespace yuragi::sim
