#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "drivers/windlog/recording_files.hpp"
#include "drivers/windlog/series_lock.hpp"
#include "drivers/windlog/windlog_writer.hpp"
#include "engine/base/version.hpp"
#include "simulators/core/command.hpp"
#include "simulators/core/common_options.hpp"

namespace yuragi::simulators::core {
namespace {

constexpr FaultKind kRecordingFaults[] = {FaultKind::kSilence, FaultKind::kFreeze, FaultKind::kSpike};

constexpr const char* kRecordingFooter =
    "The same options give the same recording; it begins at noon (UTC) of 1 June 2025. Its readings are marked as\n"
    "simulated.\n"
    "\n"
    "  yuragi-sim recording -o storm.windlog --speed 17 --turbulence 0.3 --seed 2\n"
    "  yuragi-sim recording -o both.windlog --sensor roof:0.95 --sensor mast    the roof measures 5 % too little";

struct RecordingOptions {
  std::string output;
  std::vector<std::string> sensors = {"mast"};
  double interval_s = 1.0;
  bool overwrites = false;
  CommonOptions common;
};

struct RecordedSensor {
  std::string name;
  double gain = 1.0;    ///< what it measures over the wind
  std::int64_t id = 0;  ///< in the recording
};

/// "NAME" or "NAME:GAIN".
RecordedSensor parse_sensor(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  RecordedSensor sensor{.name = text.substr(0, colon)};
  bool is_number = true;
  if (colon < text.size()) {
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + colon + 1, end, sensor.gain);
    is_number = error == std::errc() && rest == end;
  }
  if (!is_number || sensor.name.empty() || !(sensor.gain >= 0.0 && sensor.gain <= 10.0)) {
    throw CLI::ValidationError("--sensor", "is \"" + text + "\"; allowed: NAME or NAME:GAIN with a gain of 0 to 10");
  }
  return sensor;
}

void write_readings(drivers::windlog::Writer& writer, std::vector<RecordedSensor>& sensors, MeasuredWind& wind,
                    Faults& faults, const RecordingOptions& options) {
  constexpr std::size_t kStepsPerCommit = 100'000;
  constexpr double kHour_s = 3600.0;
  const Instant start{MonoTime(std::chrono::hours(1)),
                      UtcTime(std::chrono::sys_days(std::chrono::year(2025) / 6 / 1) + std::chrono::hours(12))};
  writer.begin_session({start, with_version("yuragi-sim"), ""}).value();
  for (RecordedSensor& sensor : sensors) sensor.id = writer.add_sensor(sensor.name, "simulated", "").value();

  const double duration_s = options.common.run.duration_s.value_or(kHour_s);
  for (std::size_t step = 0;; ++step) {
    const double time_s = static_cast<double>(step) * options.interval_s;
    if (time_s >= duration_s) return;
    const auto fault = faults.at(time_s);
    const PlayedMoment moment = wind.at(time_s, fault);
    if (fault == FaultKind::kSilence) continue;
    for (const RecordedSensor& sensor : sensors) {
      wind::Reading reading;
      reading.time = {start.mono + from_seconds(time_s), start.utc + from_seconds(time_s)};
      reading.speed_m_s = sensor.gain * moment.speed_m_s;
      reading.direction_deg = moment.direction_deg;
      reading.quality = wind::ReadingQuality::kSimulated;
      writer.append(sensor.id, reading).value();
    }
    if (step % kStepsPerCommit == kStepsPerCommit - 1) writer.commit().value();
  }
}

/// Writes the recording beside its place first: it is there whole, or not at all. Fails if another program records to
/// the file.
void make_recording(const RecordingOptions& options) {
  const std::filesystem::path file = options.output;
  if (std::filesystem::exists(file) && !options.overwrites) {
    throw CLI::ValidationError("--output", options.output + " exists; --force overwrites it");
  }
  const auto lock = drivers::windlog::SeriesLock::take(file).value();
  std::vector<RecordedSensor> sensors;
  for (const std::string& text : options.sensors) sensors.push_back(parse_sensor(text));
  MeasuredWind wind = options.common.make_wind();
  Faults faults = options.common.make_faults(kRecordingFaults);

  std::filesystem::path working = file;
  working += ".part";
  std::filesystem::remove(working);
  try {
    auto writer = drivers::windlog::Writer::open(working).value();
    write_readings(writer, sensors, wind, faults, options);
    writer.close().value();
    drivers::windlog::remove_recording(file);  // with what SQLite left beside it: it would take that for the new one's
    std::filesystem::rename(working, file);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(working, ignored);
    throw;
  }
}

}  // namespace

extern const Command kRecordingCommand;
const Command kRecordingCommand{[](CLI::App& app) {
  auto options = std::make_shared<RecordingOptions>();
  CLI::App* command = app.add_subcommand("recording", "write an hour of wind to a recording (.windlog) at once");
  command->footer(kRecordingFooter);
  command->add_option("-o,--output", options->output, "the recording to write")->required();
  command->add_flag("--force", options->overwrites, "overwrite the file if it exists");
  command->add_option("--interval", options->interval_s, "seconds between two readings")
      ->check(CLI::Range(0.01, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--sensor", options->sensors, "NAME or NAME:GAIN; can be repeated for more sensors in the same wind")
      ->capture_default_str();
  options->common.add_to(*command);
  command->callback([options] { make_recording(*options); });
}};

}  // namespace yuragi::simulators::core
