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
#include "daemon/tools/calibration/calibration_effect.hpp"
#include "daemon/tools/calibration/calibration_report.hpp"
#include "daemon/tools/calibration/calibration_source.hpp"
#include "daemon/tools/calibration/calibration_ways.hpp"
#include "engine/wind/judging/calibration_fit.hpp"

namespace yuragi::daemon::tools::calibration {

/// The options that every `yuragi calibrate` has.
struct Request {
  std::filesystem::path config_file;
  std::string sensor;     ///< empty: the only one in the file
  std::string reference;  ///< a sensor whose readings are taken as true; empty: none
  std::optional<double> duration_s;
  std::filesystem::path recording;         ///< empty: live
  std::vector<std::string> parts;          ///< "FROM,TO" of the recording, one for each stretch; none: all of it
  std::optional<std::string> connect;      ///< where the daemon listens; empty: as configured
  bool daemon_has_these_settings = false;  ///< make_live_source()
  bool takes_yes = false;
  bool is_dry_run = false;
  bool as_json = false;  ///< a dry run that is printed as a Report
};

/// One calibration of one sensor: opens the sources, collects readings stretch by stretch, and writes the new values to
/// the configuration. Any function may throw ConfigError or FailureError; then nothing has been written.
class Session {
 public:
  /// Reads the configuration, with what the page has set up, and finds the sensors.
  Session(const Request& request, const Way& way);

  const settings::SensorConfig& sensor() const { return config_.sensors[sensor_]; }
  /// nullptr: no reference.
  const settings::SensorConfig* reference() const { return reference_ ? &config_.sensors[*reference_] : nullptr; }
  const wind::judging::Calibration& calibration() const { return sensor().calibration; }
  bool is_live() const { return request_.recording.empty(); }
  std::size_t part_count() const { return request_.parts.size(); }
  Dialog& dialog() { return dialog_; }

  /// Collects the readings of one stretch: those of the sensor first, then of the reference. Before it, a person is
  /// led through the preparation, unless the source is a recording. `number`: the bearing or the speed that is given.
  CollectedReadings collect(double number = 0.0);

  /// A known wind that was measured, for a report.
  void report_point(const wind::judging::CalibrationPoint& point);

  /// Shows the changes and their `effect`, asks for confirmation, writes them, and has a running daemon apply them.
  /// Values that are unchanged are left out. What the page has calibrated goes into the configuration, too, whose
  /// values then count again.
  void finish(std::vector<settings::ConfigChange> wanted, const Effect& effect);

  /// The effect of new calibration values on indicated speeds in m/s.
  Effect speed_effect(std::span<const settings::ConfigChange> wanted, std::span<const double> indicated_m_s) const;

 private:
  void open_source();
  void apply_in_daemon();
  std::size_t find(const std::string& name) const;
  void beware(const CollectedReadings& collected) const;                 ///< warns of readings that are unsuitable
  ParameterValue value_now(const settings::ConfigChange& change) const;  ///< with what the page has set up
  ParameterValue value_in_file(const settings::ConfigChange& change) const;
  void take_over_page(std::vector<settings::ConfigChange>& wanted) const;
  std::string progress_line(double elapsed_s, const CollectedReadings& collected) const;

  Request request_;
  const Way& way_;
  sensing::SystemClock clock_;
  double duration_s_;
  std::string text_;                ///< of the configuration
  settings::Config configuration_;  ///< alone
  settings::Config config_;         ///< with what the page has set up
  std::size_t sensor_ = 0;
  std::optional<std::size_t> reference_;
  std::optional<Report> report_;
  Dialog dialog_;
  std::unique_ptr<Source> source_;  ///< opened by the first collect()
  std::size_t stretches_ = 0;
};

/// The speeds that a sensor indicated, converted to m/s, otherwise uncalibrated.
std::vector<double> indicated_speeds_m_s(const SensorReadings& collected,
                                         const wind::judging::Calibration& calibration);

/// Sensor and reference (collect() with one), as means over blocks that are long enough for the slower of the two, at
/// least `least_block_s`. The readings of the reference are calibrated, and scaled to the sensor's height if both
/// heights are known.
struct ReferencePairs {
  double block_s = 0.0;
  std::vector<wind::judging::TimedSpeed> truth{};
  std::vector<wind::judging::CalibrationPoint> pairs{};
};
ReferencePairs pair_with_reference(const Session& session, const CollectedReadings& collected, double least_block_s);

/// Throws the failure of a fit as a FailureError (kBadData).
[[noreturn]] void refuse(const Failure& failure);

/// The value, or else refuse().
template <class Value>
Value value_or_refuse(Result<Value, Failure> result) {
  if (!result) refuse(result.error());
  return std::move(*result);
}

/// Rounded to `step`, and never -0.
double rounded(double value, double step) noexcept;

}  // namespace yuragi::daemon::tools::calibration
