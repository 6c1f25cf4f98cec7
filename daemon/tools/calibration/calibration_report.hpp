#pragma once

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "daemon/settings/config.hpp"
#include "daemon/settings/config_edit.hpp"
#include "daemon/tools/calibration/calibration_effect.hpp"
#include "daemon/tools/calibration/calibration_source.hpp"
#include "engine/wind/judging/calibration.hpp"

namespace yuragi::daemon::tools::calibration {

/// A calibration for a program: after each change a line of JSON on standard output with all that is known so far.
/// `before` and `after` are null until values are found, and stay null if nothing is to be changed. Throws FailureError
/// if standard output cannot be written.
class Report {
 public:
  /// `duration_s`: of a stretch. `sensors` must outlive it.
  Report(std::vector<const settings::SensorConfig*> sensors, double duration_s);

  /// At most so many lines of progress in a stretch, and one a second.
  static constexpr double kMaxProgressLines = 600.0;
  void progress(double elapsed_s, const CollectedReadings& so_far);
  /// A sentence for a person.
  void note(std::string text);
  /// A known wind, and what the sensor read in it.
  void point(const wind::judging::CalibrationPoint& point);
  /// The values that are found. `before`: those that they replace, in the same order.
  void found(std::span<const settings::ConfigChange> before, std::span<const settings::ConfigChange> after,
             const Effect& effect);

 private:
  void print() const;

  std::vector<const settings::SensorConfig*> sensors_;
  double duration_s_;
  double next_line_s_ = 0.0;
  nlohmann::ordered_json state_;
};

/// For each sensor of `config` how it can be calibrated, and its values now: a list. Pure.
nlohmann::ordered_json calibrations_json(const settings::Config& config);

}  // namespace yuragi::daemon::tools::calibration
