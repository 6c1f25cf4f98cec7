#pragma once

#include <cstdint>
#include <string>

#include "drivers/sensor/sensor.hpp"
#include "engine/base/result.hpp"
#include "engine/platform/backoff.hpp"

namespace yuragi::drivers::sensor {

/// A sensor whose device may come and go: finds and opens it, works with it until it fails, and opens it again, without
/// limit, after waits that double from 0.25 s up to 10 s, each a little shorter at random. A driver implements the
/// device.
///
/// The waits begin small again once the device has sent a valid message, not when it merely opened.
class ReopeningSensor : public Sensor {
 public:
  MonoTime poll(const Clock& clock, Sink& sink) final;

 protected:
  /// `seed` makes the waits of several sensors differ.
  explicit ReopeningSensor(std::uint32_t seed);

  /// Finds the device by its stable name and opens it. Returns when to call work() first. The failure's text: what is
  /// missing and what to do.
  virtual Result<MonoTime, Failure> open(const Clock& clock) = 0;

  /// One exchange with the open device, no longer than the device's own time-out. Returns when to call it next. On
  /// failure the device is closed and opened again; its text is the reason.
  virtual Result<MonoTime, Failure> work(const Clock& clock, Sink& sink) = 0;

  /// Closes the device. Called after a failed work() too; never twice.
  virtual void close() noexcept = 0;

  /// Returns true if the device has returned, as far as can be seen without waiting. Called at each poll() before the
  /// next attempt to open it is due; if true, the attempt is made at once.
  virtual bool poll_for_return() { return false; }

  /// For work(): the device sends valid messages. `detail` is for people: what it is, and where.
  void report_connected(Sink& sink, const std::string& detail);
  /// For work(): the device is open, but sends no valid messages; why, and what to do.
  void report_unusable(Sink& sink, const std::string& detail);
  /// For work(): the input has been read to its end.
  void report_finished(Sink& sink, const std::string& detail);

 private:
  void report(Sink& sink, wind::LinkState state, const std::string& detail);

  platform::Backoff backoff_;
  bool is_open_ = false;
  MonoTime next_poll_{};
  wind::LinkState reported_state_ = wind::LinkState::kConnecting;
  std::string reported_detail_;
};

/// A seed for a sensor of this name: numbers that differ among the sensors of an installation.
std::uint32_t seed_of(std::string_view name) noexcept;

}  // namespace yuragi::drivers::sensor
