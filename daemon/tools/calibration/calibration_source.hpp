#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/settings/config.hpp"
#include "drivers/sensor/clock.hpp"
#include "engine/base/result.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::calibration {

/// A reading before calibration, and its time in seconds since collecting began, or since the recording began.
struct TimedReading {
  double time_s = 0.0;
  wind::Reading reading;
};

/// The readings collected from one sensor.
struct SensorReadings {
  std::vector<TimedReading> readings;  ///< in the order of time
  std::set<std::string> settings;      ///< of a recording: each different TOML text of its driver's values
};

/// One for each sensor of the source, in the same order.
using CollectedReadings = std::vector<SensorReadings>;

/// What to collect: live for a duration; of a recording a part, or all of it.
struct Stretch {
  double duration_s = 30.0;
  std::optional<double> from_s = std::nullopt;
  std::optional<double> to_s = std::nullopt;
};

/// Where the readings for a calibration come from. They are raw: before any [sensor.calibration].
class Source {
 public:
  /// Called about four times a second while collecting live, and once at the end; of a recording at
  /// intervals, with the log time.
  using Progress = std::function<void(double elapsed_s, const CollectedReadings& so_far)>;

  virtual ~Source() = default;

  /// For a person: "the running daemon at 127.0.0.1:7410".
  virtual std::string description() const = 0;
  virtual bool is_live() const = 0;

  /// Collects readings from now on; live, the duration begins with the last sensor's first reading. Fails if a
  /// sensor stays silent, the daemon ends, or the recording is damaged. Always ends in bounded time.
  virtual Result<CollectedReadings, Failure> collect(const Stretch& stretch, const Progress& progress) = 0;
};

/// Live readings: from the running daemon at `address` if it has all of these sensors, else from the devices
/// themselves. `sensors` and `clock` must outlive it. `daemon_has_these_settings`: the daemon is known to have a
/// microphone open with the settings that are given here, from which the level is computed. Fails if a daemon has the
/// sensors, but does not send raw readings, or if that is not known of a microphone.
Result<std::unique_ptr<Source>, Failure> make_live_source(std::vector<const settings::SensorConfig*> sensors,
                                                          const std::string& address,
                                                          const drivers::sensor::Clock& clock,
                                                          bool daemon_has_these_settings = false);

/// A recording. Fails if it cannot be read or has not all of these sensors.
Result<std::unique_ptr<Source>, Failure> make_recorded_source(std::vector<const settings::SensorConfig*> sensors,
                                                              const std::filesystem::path& file);

}  // namespace yuragi::daemon::tools::calibration
