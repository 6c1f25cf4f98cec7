#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "simulators/core/faults.hpp"
#include "simulators/core/played_wind.hpp"
#include "simulators/usb/usb_device.hpp"
#include "simulators/usb/usb_standard.hpp"

namespace yuragi::simulators::usb {

/// A transfer of the host to or from an end point. Number 0 is the control pipe; only there `setup` is used.
struct Transfer {
  std::uint64_t id = 0;  ///< chosen by the submitter
  std::uint8_t endpoint = 0;
  bool is_to_host = false;
  SetupPacket setup;
  Bytes data;                ///< what the host sends
  std::size_t max_size = 0;  ///< the most that it would receive
};

/// The outcome of a transfer.
struct Outcome {
  std::uint64_t id = 0;
  bool is_refused = false;  ///< stalled; the members below are empty
  Bytes data;               ///< what the host receives
  std::size_t size = 0;     ///< bytes transferred, in either direction
};

/// A simulated device in its wind, for the code that attaches it to a host (USB/IP, umockdev): transfers go in,
/// outcomes come out, at once or when the device has data. Two faults are played here, for every device alike: a silent
/// device receives and sends nothing (except its descriptors), an unplugged one does not exist, and its data is lost.
/// Pure. Thread-safe: no.
class Port {
 public:
  Port(std::unique_ptr<Device> device, core::MeasuredWind wind);

  const Summary& summary() const noexcept { return summary_; }
  const Descriptors& descriptors() const { return device_->descriptors(); }
  const core::PlayedMoment& moment() const noexcept { return moment_; }
  /// The faults of the device, and those of its port.
  std::span<const core::FaultKind> known_faults() const noexcept { return known_faults_; }

  /// Advances to `time_s` after the start. Unplugging drops all transfers.
  void advance(double time_s, std::optional<core::FaultKind> fault);
  bool is_plugged_in() const noexcept { return is_plugged_in_; }

  void submit(Transfer transfer);
  /// Drops a transfer that has no outcome yet; false: it is not waiting.
  bool cancel(std::uint64_t id);
  /// Drops all transfers, when the host has disconnected.
  void cancel_all();

  /// The outcomes since the last call. Transfers to one end point complete in the order in which they were submitted.
  std::vector<Outcome> take_outcomes();

 private:
  std::optional<Outcome> attempt(const Transfer& transfer);
  void lose_what_waits();

  std::unique_ptr<Device> device_;
  ControlPipe control_pipe_;
  Summary summary_;
  std::vector<core::FaultKind> known_faults_;
  std::vector<core::FaultKind> device_faults_;
  core::MeasuredWind wind_;
  core::PlayedMoment moment_;
  bool is_plugged_in_ = true;
  bool is_silent_ = false;
  std::deque<Transfer> waiting_;
};

}  // namespace yuragi::simulators::usb
