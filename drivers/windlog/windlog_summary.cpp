#include "drivers/windlog/windlog_summary.hpp"

#include <algorithm>
#include <optional>

#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi::drivers::windlog {
namespace {

// As many intervals as settle a median; the length of a recording must not matter.
constexpr std::size_t kMaxIntervals = 100'000;

/// What is gathered for one sensor's name.
struct Tally {
  WindlogSummary::Sensor figures;
  double speed_sum_m_s = 0.0;
  std::vector<double> intervals_s;
  std::int64_t session = 0;
  MonoTime last{};

  void add(const LoggedSensor& sensor, const wind::WindReading& reading) {
    if (figures.count > 0 && session == sensor.session && intervals_s.size() < kMaxIntervals) {
      intervals_s.push_back(seconds(reading.time.mono - last));
    }
    session = sensor.session;
    last = reading.time.mono;
    ++figures.count;
    speed_sum_m_s += reading.speed_m_s;
    figures.max_speed_m_s = std::max(figures.max_speed_m_s, reading.speed_m_s);
  }

  WindlogSummary::Sensor finish() {
    figures.mean_speed_m_s = speed_sum_m_s / static_cast<double>(figures.count);
    if (!intervals_s.empty()) {
      const auto middle = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 2);
      std::nth_element(intervals_s.begin(), middle, intervals_s.end());
      figures.interval_s = *middle;
    }
    return figures;
  }
};

}  // namespace

Result<WindlogSummary, Failure> summarize(const std::filesystem::path& file) {
  auto reader = WindlogReader::open(file);
  if (!reader) return reader.error();

  WindlogSummary summary;
  summary.sessions = reader->sessions().size();
  std::vector<Tally> tallies;
  for (;;) {
    const auto logged = reader->next();
    if (!logged) return logged.error();
    if (!*logged) break;

    // A sensor is the same one in every session if its name is.
    const LoggedSensor& sensor = reader->sensors()[(*logged)->sensor];
    auto tally = std::find_if(tallies.begin(), tallies.end(),
                              [&](const Tally& candidate) { return candidate.figures.name == sensor.name; });
    if (tally == tallies.end()) {
      tallies.emplace_back();
      tally = tallies.end() - 1;
      tally->figures.name = sensor.name;
      tally->figures.driver = sensor.driver;
    }
    const wind::WindReading& reading = (*logged)->reading;
    tally->add(sensor, reading);

    if (summary.count++ == 0) summary.first = reading.time.utc;
    summary.last = reading.time.utc;
    summary.duration = (*logged)->log_time;
  }
  summary.skipped = reader->skipped();
  for (Tally& tally : tallies) summary.sensors.push_back(tally.finish());
  return summary;
}

}  // namespace yuragi::drivers::windlog
