#include "daemon/tools/report/measure_recording.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace yuragi::daemon::tools::report {
namespace {

constexpr std::uint64_t kReadingsBetweenWords = 50'000;

std::string names_of(const RecordingSurvey& survey) {
  constexpr std::size_t kMaxNamed = 20;
  std::string names;
  for (std::size_t i = 0; i < std::min(survey.sensors.size(), kMaxNamed); ++i) {
    names += (i == 0 ? "\"" : ", \"") + survey.sensors[i].name + '"';
  }
  return names + (survey.sensors.size() > kMaxNamed ? ", ..." : "");
}

/// Which of the survey's sensors are selected.
Result<std::vector<bool>, Failure> chosen_sensors(const RecordingSurvey& survey,
                                                  const std::vector<std::string>& wanted) {
  std::vector<bool> is_chosen(survey.sensors.size(), wanted.empty());
  for (const std::string& name : wanted) {
    const auto found = std::ranges::find(survey.sensors, name, &SensorSurvey::name);
    if (found == survey.sensors.end()) {
      return Failure{fmt::format("--sensor: there are no readings of \"{}\"; there are readings of {}", name,
                                 survey.sensors.empty() ? "nobody" : names_of(survey))};
    }
    is_chosen[static_cast<std::size_t>(found - survey.sensors.begin())] = true;
  }
  if (const auto count = std::ranges::count(is_chosen, true);
      count > static_cast<std::ptrdiff_t>(kMaxReportedSensors)) {
    return Failure{fmt::format("{} sensors are too many for one page; choose at most {} with --sensor, from {}", count,
                               kMaxReportedSensors, names_of(survey))};
  }
  return is_chosen;
}

}  // namespace

Result<RecordingNumbers, Failure> measure_recording(drivers::windlog::Reader& reader, const Settings& settings,
                                                    const ReadingProgress& progress) {
  // First the survey, then the numbers.
  const auto survey = survey_recording(reader, settings.range, progress);
  if (!survey) return survey.error();
  const auto is_chosen = chosen_sensors(*survey, settings.sensors);
  if (!is_chosen) return is_chosen.error();

  RecordingNumbers numbers;
  numbers.readings = survey->readings;
  numbers.skipped = survey->skipped;
  numbers.sessions = reader.sessions().size();
  numbers.begin_s = seconds(survey->begin);
  numbers.end_s = seconds(survey->end);
  numbers.first = survey->first;
  numbers.last = survey->last;
  numbers.clock_sets = survey->clock_sets;
  numbers.largest_clock_set_s = survey->largest_clock_set_s;
  numbers.stale_intervals = settings.stale_intervals;

  std::vector<std::optional<SensorTally>> tallies(survey->sensors.size());
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    if ((*is_chosen)[i]) tallies[i].emplace(survey->sensors[i], numbers.begin_s, numbers.end_s, settings);
  }
  // A recording that is still being written has grown meanwhile: stop at the end of the survey.
  LogRange range = settings.range;
  if (survey->readings > 0) range.to = std::min(range.to, survey->end + Nanoseconds{1});
  std::uint64_t count = survey->readings;
  const auto read = for_each_reading(reader, range, [&](const drivers::windlog::LoggedReading& logged) {
    const std::size_t index = survey->sensor_of[logged.sensor];
    if (index != RecordingSurvey::kNone && tallies[index]) tallies[index]->add(logged.log_time, logged.reading);
    if (progress && ++count % kReadingsBetweenWords == 0) progress(count);
  });
  if (!read) return read.error();
  for (std::optional<SensorTally>& tally : tallies) {
    if (tally) numbers.sensors.push_back(tally->finish());
  }
  return numbers;
}

}  // namespace yuragi::daemon::tools::report
