#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/bus/hid_device.hpp"
#include "drivers/hid/hid_exchange.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::hid {

/// The state of a station after one step.
enum class StationHealth : std::uint8_t {
  kSame,    ///< as before
  kWell,    ///< it sent a valid wind
  kUnwell,  ///< it is there, but sends no valid wind
};

/// The result of one step of the protocol.
struct StationStep {
  MonoTime next;  ///< when the next step is due
  StationHealth health = StationHealth::kSame;
  std::string trouble = {};  ///< for kUnwell: the trouble, and what to do

  static StationStep same(MonoTime next) { return {next}; }
  static StationStep well(MonoTime next) { return {next, StationHealth::kWell}; }
  static StationStep unwell(MonoTime next, std::string trouble) {
    return {next, StationHealth::kUnwell, std::move(trouble)};
  }
};

/// The protocol of one family of stations; a new object each time that the device is opened.
class Station {
 public:
  virtual ~Station() = default;

  /// The next step of the protocol, no longer than the station's own time-out. On failure the device must be opened
  /// again; the text is the reason, empty if it is gone or accepts nothing.
  virtual Result<StationStep, Failure> step(Exchange& exchange) = 0;
};

/// The timing of a station.
struct StationTiming {
  double pace = 1.0;             ///< speed relative to a real station: above 1 for simulated ones only
  Nanoseconds poll_interval{0};  ///< from one request to the next; 0: the station's own

  /// A duration of the real station, divided by the pace.
  Nanoseconds paced(Nanoseconds duration) const { return from_seconds(seconds(duration) / pace); }
  Nanoseconds interval_or(Nanoseconds own) const {
    return poll_interval > Nanoseconds::zero() ? poll_interval : paced(own);
  }
};

/// A family of stations.
struct StationKind {
  std::string_view name;   ///< in a configuration
  std::string_view title;  ///< for people
  bus::HidId id;
  std::unique_ptr<Station> (*make)(const StationTiming& timing);
};

// Each in its own file. The protocols are described in drivers/decode.
std::unique_ptr<Station> make_wmr100_station(const StationTiming& timing);
std::unique_ptr<Station> make_wmr300_station(const StationTiming& timing);
std::unique_ptr<Station> make_fineoffset_station(const StationTiming& timing);
std::unique_ptr<Station> make_acurite_station(const StationTiming& timing);
std::unique_ptr<Station> make_te923_station(const StationTiming& timing);

/// Every family.
std::span<const StationKind> station_kinds();

/// The result of step() when the device is disconnected.
inline Failure station_is_gone() {
  return {""};
}

}  // namespace yuragi::drivers::hid
