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

namespace yuragi {

/// A reading before calibration, and when it came: seconds since listening began, or since the recording did.
struct TimedReading {
  double time_s = 0.0;
  WindReading reading;
};

/// What one sensor said while it was listened to.
struct SensorReadings {
  std::vector<TimedReading> readings;  ///< in the order of time
  std::set<std::string> settings;      ///< of a recording: its driver's values, each different TOML text that there was
};

/// One of those for each sensor that is listened to, in the same order.
using CollectedReadings = std::vector<SensorReadings>;

/// How long to listen: live for a duration; of a recording a part, or all of it.
struct Stretch {
  double duration_s = 30.0;
  std::optional<double> from_s = std::nullopt;
  std::optional<double> to_s = std::nullopt;
};

/// Where the readings come from that a calibration is made of. Each kind gives them as the sensors said them, before
/// any [sensor.calibration].
class CalibrationSource {
 public:
  /// Told about four times a second while listening, and once at the end; of a recording after each so many readings,
  /// with the time that they are of.
  using Progress = std::function<void(double elapsed_s, const CollectedReadings& so_far)>;

  virtual ~CalibrationSource() = default;

  /// For a person: "the running daemon at 127.0.0.1:7410".
  virtual std::string description() const = 0;
  virtual bool is_live() const = 0;

  /// Listens, from now on. Live it waits for every sensor's first reading first. Fails where a sensor stays silent,
  /// the daemon ends, or the recording is damaged; ends in time whatever happens.
  virtual Result<CollectedReadings, Failure> collect(const Stretch& stretch, const Progress& progress) = 0;
};

/// The sensors themselves: the running daemon's word where it listens at `address` and has all of them, else their
/// devices. `sensors` and `clock` must outlive it. Fails where a daemon has them and cannot give raw
/// readings.
Result<std::unique_ptr<CalibrationSource>, Failure> make_live_source(std::vector<const SensorConfig*> sensors,
                                                                     const std::string& address, const Clock& clock);

/// A recording. Fails where it cannot be read or has not all of these sensors.
Result<std::unique_ptr<CalibrationSource>, Failure> make_recorded_source(std::vector<const SensorConfig*> sensors,
                                                                         const std::filesystem::path& file);

}  // namespace yuragi
