#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "daemon/tools/report/even_series.hpp"
#include "daemon/tools/report/gust_means.hpp"
#include "daemon/tools/report/recording_survey.hpp"
#include "daemon/tools/report/report_numbers.hpp"
#include "daemon/tools/report/site_tally.hpp"
#include "daemon/tools/report/speed_statistics.hpp"
#include "daemon/tools/report/state_history.hpp"
#include "daemon/tools/report/welch_spectrum.hpp"
#include "engine/wind/blend/source_record.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi::daemon::tools::report {

/// How a recording is judged, and the zone of its local time.
struct Settings {
  LogRange range;
  std::vector<std::string> sensors;  ///< by name; none: all
  double stale_intervals = 5.0;      ///< [wind] stale_intervals
  wind::judging::JudgeSettings judge;
  /// The prior of the gusts for a sensor of this name; none: turbulence::Prior's default.
  std::function<wind::turbulence::Prior(const std::string& sensor)> prior;
  /// Local time minus UTC at a moment; none: UTC.
  std::function<Nanoseconds(UtcTime)> utc_offset;
};

/// Computes all numbers of one sensor in one pass, in bounded memory. Thread-safe: no.
class SensorTally {
 public:
  /// `begin_s` and `end_s`: of the whole recording, log time. `settings` must outlive the tally.
  SensorTally(const SensorSurvey& survey, double begin_s, double end_s, const Settings& settings);

  /// Takes the sensor's next reading, in the order of log time.
  void add(Nanoseconds log_time, const wind::Reading& reading);

  /// The numbers; call it once, after the last reading.
  SensorNumbers finish();

 private:
  void plan_spectrum(const SensorSurvey& survey);
  void mark(RecordedState state, double from_s, double to_s);
  void add_believed(Nanoseconds log_time, const wind::Reading& reading);
  void add_to_bin(double time_s, const wind::Reading& reading, const std::optional<double>& gust_m_s);
  std::size_t bin_of(double time_s) const;
  std::size_t hour_of(UtcTime moment);

  const Settings& settings_;
  double begin_s_;
  double end_s_;
  bool has_gusts_;
  double unchanged_for_s_;
  SensorNumbers numbers_;

  wind::blend::SourceRecord record_;
  wind::judging::ReadingJudge judge_;
  StateHistory states_;
  RecordedState state_ = RecordedState::kLive;
  SiteTally lesson_;
  bool was_interrupted_ = false;  ///< since the last believed reading

  SpeedStatistics speeds_;
  RoseTally rose_;
  ThreeSecondMean three_seconds_;
  TenMinuteBlocks blocks_;
  wind::Vector wind_sum_;
  double directed_speed_sum_m_s_ = 0.0;
  double next_direction_s_ = 0.0;
  std::optional<double> held_direction_deg_;

  std::optional<EvenSeries> series_;
  std::optional<WelchSpectrum> spectrum_;
  std::optional<IntegralTime> integral_time_;

  std::optional<std::int64_t> known_quarter_;  ///< of an hour, for which the local hour has been computed
  std::size_t known_hour_ = 0;
};

}  // namespace yuragi::daemon::tools::report
