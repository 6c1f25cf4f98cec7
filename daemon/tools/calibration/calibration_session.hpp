#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/sensing/system_clock.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/config_edit.hpp"
#include "daemon/tools/calibration/calibration_dialog.hpp"
#include "daemon/tools/calibration/calibration_source.hpp"
#include "engine/wind/judging/calibration_fit.hpp"

namespace yuragi {

/// What every `yuragi calibrate` is asked for.
struct CalibrationRequest {
  std::filesystem::path config_file;
  std::string sensor;     ///< empty: the only one that the file has
  std::string reference;  ///< a sensor that is right; empty: none
  std::optional<double> duration_s;
  std::filesystem::path recording;     ///< empty: live
  std::vector<std::string> parts;      ///< "FROM,TO" of it, one for each stretch; none: all of it
  std::optional<std::string> connect;  ///< where the daemon listens; empty: as configured
  bool takes_yes = false;
  bool is_dry_run = false;
};

/// One calibration of one sensor: opens what is needed, listens stretch by stretch, and writes what came of it. Throws
/// ConfigError or FailureError from every function; then nothing has been written.
class CalibrationSession {
 public:
  /// Reads the configuration and finds the sensors. `default_duration_s`: of a live stretch.
  CalibrationSession(const CalibrationRequest& request, double default_duration_s);

  const SensorConfig& sensor() const { return config_.sensors[sensor_]; }
  /// nullptr: there is none.
  const SensorConfig* reference() const { return reference_ ? &config_.sensors[*reference_] : nullptr; }
  const Calibration& calibration() const { return sensor().calibration; }
  bool is_live() const { return request_.recording.empty(); }
  std::size_t part_count() const { return request_.parts.size(); }
  CalibrationDialog& dialog() { return dialog_; }

  /// Listens for one stretch: the sensor is first, then the reference. `preparation` says what has to be so first; it
  /// is not asked of a recording.
  CollectedReadings collect(const std::string& preparation);

  /// Shows what changes, with `effect` below, asks, and writes it. Values that are as wanted already are left alone.
  void finish(std::vector<ConfigChange> wanted, const std::vector<std::string>& effect);

  /// The effect of new calibration values on what the sensor says, m/s (its unit counted): a table, line by line.
  std::vector<std::string> speed_effect(std::span<const ConfigChange> wanted,
                                        std::span<const double> indicated_m_s) const;

 private:
  void open_source();
  std::size_t find(const std::string& name) const;
  void beware(const CollectedReadings& collected) const;  ///< says what may be wrong with readings for a calibration
  ParameterValue value_now(const ConfigChange& change) const;
  std::string progress_line(double elapsed_s, const CollectedReadings& collected) const;

  CalibrationRequest request_;
  CalibrationDialog dialog_;
  SystemClock clock_;
  double duration_s_;
  std::string text_;  ///< of the configuration
  Config config_;
  std::size_t sensor_ = 0;
  std::optional<std::size_t> reference_;
  std::unique_ptr<CalibrationSource> source_;  ///< opened when it is first listened to
  std::size_t stretches_ = 0;
};

/// The speeds that a sensor said, m/s, its unit counted and nothing else of its calibration.
std::vector<double> indicated_speeds_m_s(const SensorReadings& collected, const Calibration& calibration);

/// Sensor and reference (collect() with one), as means over blocks that are long enough for the slower of the two, at
/// least `least_block_s`. What the reference says is calibrated, and brought to the sensor's height where both are
/// known.
struct ReferencePairs {
  double block_s = 0.0;
  std::vector<TimedSpeed> truth{};
  std::vector<CalibrationPoint> pairs{};
};
ReferencePairs pair_with_reference(const CalibrationSession& session, const CollectedReadings& collected,
                                   double least_block_s);

/// Throws FailureError (kBadData) with what a fit says is wrong.
[[noreturn]] void refuse(const Failure& failure);

/// A result, or the end.
template <class Value>
Value value_or_refuse(Result<Value, Failure> result) {
  if (!result) refuse(result.error());
  return std::move(*result);
}

/// Rounded to `step`, and never -0.
double rounded(double value, double step) noexcept;

}  // namespace yuragi
