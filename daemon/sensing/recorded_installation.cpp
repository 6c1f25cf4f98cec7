#include "daemon/sensing/recorded_installation.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "drivers/recording/recording_player.hpp"
#include "drivers/windlog/log_moment.hpp"
#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/version.hpp"

namespace yuragi::daemon::sensing {
namespace {

using drivers::windlog::LoggedSession;

/// So many changes of the configuration are named in the log.
constexpr std::size_t kMaxChangesNamed = 5;

/// A sensor of the installation of which the recording has no reading.
class SilentSensor final : public drivers::sensor::Sensor {
 public:
  MonoTime poll(const drivers::sensor::Clock& clock, drivers::sensor::Sink& sink) override {
    if (!std::exchange(has_reported_, true)) {
      sink.link(wind::LinkState::kFinished, "the recording has no reading of it");
    }
    return clock.now().mono + std::chrono::hours(1);
  }

 private:
  bool has_reported_ = false;
};

/// Returns a failure to read a recording as a failure of its data, with any error code of SQLite.
Failure of_recorded_data(const Failure& failure) {
  return {failure.message, failure.kind == FailureKind::kOther ? FailureKind::kBadData : failure.kind};
}

Result<Nanoseconds, Failure> begin_in(drivers::windlog::Reader& reader, const std::string& start) {
  const auto moment = drivers::windlog::parse_log_moment(start);
  if (!moment) return moment.error();
  const auto begin = drivers::windlog::log_time_of(reader, *moment);
  if (!begin) return of_recorded_data(begin.error());
  if (reader.sessions().empty()) {
    return Failure{reader.file().string() + ": there is no reading in this recording", FailureKind::kBadData};
  }
  if (!*begin || **begin > reader.duration()) {
    return Failure{reader.file().string() + ": ends before " + start, FailureKind::kBadData};
  }
  return **begin;
}

Result<settings::Config, Failure> configuration_of(const drivers::windlog::Reader& reader,
                                                   const LoggedSession& session) {
  const std::string place = fmt::format("{}: configuration of session {}", reader.file().string(), session.id);
  const auto text = reader.configuration(session.id);
  if (!text) return of_recorded_data(text.error());
  if (text->find_first_not_of(" \t\r\n") == std::string::npos) {
    return Failure{place + ": is empty, because the recording was imported; replay it with --config FILE",
                   FailureKind::kBadData};
  }
  try {
    return settings::parse_config(*text, place);
  } catch (const settings::ConfigError& error) {
    throw settings::ConfigError(fmt::format(
        "{}\n{}: was written by {}; this is {}. Save it in a file, change these keys, and replay with --config FILE",
        error.what(), place, session.software, with_version("yuragi")));
  }
}

/// A recording does not decide where this machine listens, who controls it, or what it runs.
void leave_out_what_acts_outside(settings::Config& config, std::vector<std::string>& remarks) {
  const settings::Config own = settings::default_config();
  if (config.stream.listen != own.stream.listen || config.stream.control != own.stream.control) {
    remarks.push_back("its [stream] listen and control are not used: it listens at " + own.stream.listen +
                      "; --listen HOST:PORT changes that");
  }
  if (!config.http.listen.empty()) remarks.push_back("its [http] is not used: no page is served");
  if (!config.alerts.empty()) remarks.push_back("its alerts are not used");
  config.stream = own.stream;
  config.http = own.http;
  config.alerts.clear();
  if (!config.lists.empty() || !config.feeds.mqtt.host.empty())
    remarks.push_back("its feeds to other programs are not used");
  config.lists.clear();
  config.feeds = {};
  config.by_name.at("mqtt") = own.by_name.at("mqtt");
}

/// Returns true if this sensor has a reading from a log time on.
Result<bool, Failure> has_readings_after(drivers::windlog::Reader& reader, const std::string& sensor,
                                         Nanoseconds begin) {
  std::vector<bool> is_it;
  for (const auto& candidate : reader.sensors()) is_it.push_back(candidate.name == sensor);
  if (std::ranges::find(is_it, true) == is_it.end()) return false;
  const auto last = reader.last_log_time(is_it);
  if (!last) return of_recorded_data(last.error());
  return *last && **last >= begin;
}

/// Returns a sentence for each time at which the recording comes to a configuration that is neither that of the first
/// session nor the last one named.
Result<std::vector<std::string>, Failure> changes_after(const drivers::windlog::Reader& reader,
                                                        const LoggedSession& first) {
  const auto replayed = reader.configuration(first.id);
  if (!replayed) return of_recorded_data(replayed.error());
  std::vector<std::string> sentences;
  std::string before = *replayed;
  std::size_t count = 0;
  for (const LoggedSession& session : reader.sessions()) {
    if (session.log_begin <= first.log_begin) continue;
    auto text = reader.configuration(session.id);
    if (!text) return of_recorded_data(text.error());
    if (*text != *replayed && *text != before && ++count <= kMaxChangesNamed) {
      sentences.push_back(fmt::format(
          "from {:%Y-%m-%dT%H:%M:%S}Z on (session {}) it was recorded with another configuration; it is replayed with "
          "that of session {}",
          std::chrono::floor<std::chrono::seconds>(session.first.utc), session.id, first.id));
    }
    before = std::move(*text);
  }
  if (count > kMaxChangesNamed) {
    sentences.push_back(fmt::format("{} further changes of the configuration", count - kMaxChangesNamed));
  }
  return sentences;
}

}  // namespace

Result<RecordedInstallation, Failure> recorded_installation(const std::filesystem::path& recording,
                                                            const drivers::windlog::PlayerOptions& options) {
  auto reader = drivers::windlog::Reader::open(recording);
  if (!reader) return reader.error();
  const auto begin = begin_in(*reader, options.playback.start);
  if (!begin) return begin.error();
  const auto sessions = reader->sessions();
  const auto session = std::ranges::find_if(sessions, [&](const auto& each) { return each.log_end() >= *begin; });

  auto config = configuration_of(*reader, *session);
  if (!config) return config.error();
  RecordedInstallation installation{
      .config = std::move(*config), .begin = session->first.utc + (*begin - session->log_begin), .remarks = {}};
  installation.config.wind.fallback.reset();
  installation.config.shaping.site_file.clear();
  leave_out_what_acts_outside(installation.config, installation.remarks);

  bool is_any_played = false;
  for (settings::SensorConfig& sensor : installation.config.sensors) {
    const auto has_readings = has_readings_after(*reader, sensor.name, *begin);
    if (!has_readings) return has_readings.error();
    is_any_played = is_any_played || *has_readings;
    if (!*has_readings)
      installation.remarks.push_back(fmt::format("sensor {} has no reading, and is silent", sensor.name));
    sensor.blend.unchanged_for_s /= options.rate;
    drivers::windlog::PlayerOptions of_sensor = options;
    of_sensor.playback.sensor = sensor.name;
    of_sensor.stays_with_others = true;
    sensor.stand_in = settings::StandIn{
        .recording = recording,
        .open = [recording, of_sensor, has_readings = *has_readings]() -> std::unique_ptr<drivers::sensor::Sensor> {
          if (!has_readings) return std::make_unique<SilentSensor>();
          return drivers::recording::play_recording(recording, of_sensor);
        }};
  }
  if (!is_any_played) {
    return Failure{
        recording.string() + ": has no reading of a sensor of its configuration; replay it with --config FILE",
        FailureKind::kBadData};
  }
  auto changes = changes_after(*reader, *session);
  if (!changes) return changes.error();
  std::ranges::move(*changes, std::back_inserter(installation.remarks));
  return installation;
}

}  // namespace yuragi::daemon::sensing
