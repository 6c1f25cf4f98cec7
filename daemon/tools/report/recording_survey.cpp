#include "daemon/tools/report/recording_survey.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/settings/recorded_sensor.hpp"
#include "engine/wind/blend/source_record.hpp"

namespace yuragi::daemon::tools::report {
namespace {

constexpr std::size_t kMaxIntervals = 100'000;
constexpr double kClockSet_s = 2.0;
constexpr std::uint64_t kReadingsPerWord = 50'000;

/// Surveys one sensor, reading by reading.
class Surveyor {
 public:
  explicit Surveyor(const drivers::windlog::LoggedSensor& sensor)
      : survey_{.name = sensor.name,
                .driver = sensor.driver,
                .unchanged_for_s = settings::recorded_source(sensor.driver, sensor.options).unchanged_for_s},
        record_(survey_.unchanged_for_s) {}

  void add(Nanoseconds log_time, wind::Reading reading) {
    if (survey_.readings == 0) run_begin_ = last_ = log_time;
    const double interval_s = seconds(log_time - last_);
    if (survey_.readings > 0 && intervals_s_.size() < kMaxIntervals) intervals_s_.push_back(interval_s);

    // A run continues while the interval is that of the last readings.
    reading.time.mono = MonoTime(log_time);
    record_.take(reading);
    if (interval_s > kBridgedIntervals * record_.interval_s()) {
      longest_run_ = std::max(longest_run_, last_ - run_begin_);
      run_begin_ = log_time;
    } else if (interval_s > 0.0) {
      steady_s_ += interval_s;
      ++steady_;
    }
    last_ = log_time;
    ++survey_.readings;
    if (reading.direction_deg) ++survey_.directed;
    if (reading.gust_m_s) ++survey_.gusts;
  }

  SensorSurvey finish() {
    longest_run_ = std::max(longest_run_, last_ - run_begin_);
    if (!intervals_s_.empty()) {
      const auto middle = intervals_s_.begin() + static_cast<std::ptrdiff_t>(intervals_s_.size() / 2);
      std::nth_element(intervals_s_.begin(), middle, intervals_s_.end());
      survey_.interval_s = *middle;
    }
    if (steady_ > 0) {
      survey_.step_s = steady_s_ / static_cast<double>(steady_);
      survey_.longest_run = 1 + static_cast<std::uint64_t>(seconds(longest_run_) / survey_.step_s + 1e-3);
    }
    return survey_;
  }

 private:
  SensorSurvey survey_;
  wind::blend::SourceRecord record_;
  std::vector<double> intervals_s_;
  Nanoseconds last_{0};
  Nanoseconds run_begin_{0};
  Nanoseconds longest_run_{0};
  double steady_s_ = 0.0;
  std::uint64_t steady_ = 0;
};

/// Counts how often the recorder's clock was set: the difference of UTC and log time then changes.
class ClockWatch {
 public:
  void add(const drivers::windlog::LoggedReading& logged, RecordingSurvey& survey) {
    const double offset_s = seconds(logged.reading.time.utc.time_since_epoch()) - seconds(logged.log_time);
    const double step_s = has_begun_ ? offset_s - offset_s_ : 0.0;
    has_begun_ = true;
    offset_s_ = offset_s;
    if (std::abs(step_s) <= kClockSet_s) return;
    ++survey.clock_sets;
    if (std::abs(step_s) > std::abs(survey.largest_clock_set_s)) survey.largest_clock_set_s = step_s;
  }

 private:
  bool has_begun_ = false;
  double offset_s_ = 0.0;
};

}  // namespace

Result<void, Failure> for_each_reading(drivers::windlog::Reader& reader, const LogRange& range,
                                       const std::function<void(const drivers::windlog::LoggedReading&)>& use) {
  reader.seek(range.from);
  for (;;) {
    const auto logged = reader.next();
    if (!logged) return logged.error();
    if (!*logged || (*logged)->log_time >= range.to) return {};
    use(**logged);
  }
}

Result<RecordingSurvey, Failure> survey_recording(drivers::windlog::Reader& reader, const LogRange& range,
                                                  const ReadingProgress& progress) {
  RecordingSurvey survey;
  survey.sensor_of.assign(reader.sensors().size(), RecordingSurvey::kNone);
  std::vector<Surveyor> surveyors;
  std::vector<std::string> names;
  ClockWatch clock;
  const auto read = for_each_reading(reader, range, [&](const drivers::windlog::LoggedReading& logged) {
    std::size_t& index = survey.sensor_of[logged.sensor];
    if (index == RecordingSurvey::kNone) {
      const drivers::windlog::LoggedSensor& sensor = reader.sensors()[logged.sensor];
      index = static_cast<std::size_t>(std::ranges::find(names, sensor.name) - names.begin());
      if (index == names.size()) {
        names.push_back(sensor.name);
        surveyors.emplace_back(sensor);
      }
    }
    surveyors[index].add(logged.log_time, logged.reading);
    clock.add(logged, survey);

    if (survey.readings++ == 0) {
      survey.begin = logged.log_time;
      survey.first = logged.reading.time.utc;
    }
    survey.end = logged.log_time;
    survey.last = logged.reading.time.utc;
    if (progress && survey.readings % kReadingsPerWord == 0) progress(survey.readings);
  });
  if (!read) return read.error();
  survey.skipped = reader.skipped();
  for (Surveyor& surveyor : surveyors) survey.sensors.push_back(surveyor.finish());
  return survey;
}

}  // namespace yuragi::daemon::tools::report
