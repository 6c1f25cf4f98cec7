#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/decode/refusal.hpp"
#include "drivers/sensor/clock.hpp"
#include "engine/wind/link_state.hpp"
#include "engine/wind/station_quantities.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::sensor {

/// The direction of a message.
enum class RawDirection : std::uint8_t { kReceived, kSent };

/// Receives a sensor's readings, link state, refusals and raw messages. Called on the thread that polls; strings are
/// valid during the call only.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void reading(const wind::Reading& reading) = 0;
  /// Receives the station's other quantities, for the recording. Values outside their physical range are left out.
  virtual void quantities(const wind::StationQuantities& /*quantities*/) {}
  virtual void refused(decode::Refusal why, std::uint64_t times = 1) = 0;
  /// Called at each change, and for each failed attempt: what happened, and what to do about it.
  virtual void link(wind::LinkState state, std::string_view detail) = 0;
  /// Each message from or to the device, before it is decoded: a line, a report, a request. Received ones count as
  /// frames; a trace shows the bytes.
  virtual void raw(RawDirection direction, std::span<const std::uint8_t> message) = 0;
};

/// A sensor, real or not. It owns the connection to its device, and reconnects without limit.
class Sensor {
 public:
  virtual ~Sensor() = default;

  /// Does the next piece of work: one exchange with the device, or one attempt to open it. Blocks no longer than the
  /// device's own time-out. Returns when it wants to be called again (at once, if that has passed). Never throws for
  /// anything that a device does.
  virtual MonoTime poll(const Clock& clock, Sink& sink) = 0;

  /// Ends a poll() that waits, from another thread, so that shutting down is quick. No poll() follows.
  virtual void interrupt() noexcept {}
};

}  // namespace yuragi::drivers::sensor
