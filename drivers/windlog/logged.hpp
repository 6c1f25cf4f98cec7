#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/base/time.hpp"
#include "engine/wind/station_quantities.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::windlog {

// What a recording consists of. Log time is the recording's own: zero is its first reading, whichever sensor's that is;
// it follows the monotonic clock inside a session, and UTC from one session to the next (at least zero).

/// A session that has readings.
struct LoggedSession {
  std::int64_t id = 0;
  std::string software;
  Instant first;             ///< of its first reading
  Instant last;              ///< of its last one, when the file was opened
  Nanoseconds log_begin{0};  ///< the log time of its first reading

  Nanoseconds log_end() const { return log_begin + (last.mono - first.mono); }
};

/// A sensor of one session.
struct LoggedSensor {
  std::int64_t id = 0;
  std::int64_t session = 0;
  std::string name;
  std::string driver;
  std::string options;
};

struct LoggedReading {
  Nanoseconds log_time{0};
  std::size_t sensor = 0;  ///< index into Reader::sensors()
  wind::Reading reading;   ///< with the times of the recording machine
};

/// The other quantities of a sensor's station in one second.
struct LoggedQuantities {
  Nanoseconds log_time{0};             ///< below zero if it came before the first reading
  std::size_t sensor = 0;              ///< index into Reader::sensors()
  wind::StationQuantities quantities;  ///< with the times of the recording machine
};

}  // namespace yuragi::drivers::windlog
