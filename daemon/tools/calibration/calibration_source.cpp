#include "daemon/tools/calibration/calibration_source.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "daemon/sensing/sensor_runner.hpp"
#include "daemon/stream/stream_client.hpp"
#include "drivers/windlog/windlog_reader.hpp"

namespace yuragi::daemon::tools::calibration {
namespace {

using SensorConfigs = std::vector<const settings::SensorConfig*>;

constexpr auto kDaemonConnectTimeout = std::chrono::seconds(2);
constexpr auto kDaemonSilence = std::chrono::seconds(5);
constexpr auto kDevicePause = std::chrono::milliseconds(20);
constexpr double kFirstReadingTimeout_s = 90.0;  // a radio station sends every 48 s
constexpr double kMaxLost_s = 5.0;               // for longer, and a calibration has too few readings to be trusted
constexpr double kProgressInterval_s = 0.25;
constexpr std::size_t kReadingsPerProgress = 200'000;  // a second of work or less

Failure unavailable(const std::string& message) {
  return {message, FailureKind::kUnavailable};
}

/// A sensor's connection, as far as a stretch must know it.
struct LinkNow {
  std::string detail;  ///< for a person
  bool is_lost = false;
};

bool all_have_readings(const CollectedReadings& collected) {
  return std::ranges::none_of(collected, [](const SensorReadings& sensor) { return sensor.readings.empty(); });
}

/// One live stretch: its beginning, its end, and its progress.
class LiveStretch {
 public:
  LiveStretch(const SensorConfigs& sensors, double duration_s, const drivers::sensor::Clock& clock,
              const Source::Progress& progress)
      : sensors_(sensors),
        duration_s_(duration_s),
        clock_(clock),
        progress_(progress),
        begun_(clock.now().mono),
        collected_(sensors.size()),
        lost_from_s_(sensors.size()) {}

  void add(std::size_t sensor, const wind::Reading& reading) {
    collected_[sensor].readings.push_back({seconds(clock_.now().mono - begun_), reading});
  }

  /// Returns true if it is over. Fails if a sensor stays silent, or is lost meanwhile; `link_of`: the LinkNow of one.
  template <class LinkOf>
  Result<bool, Failure> is_over(const LinkOf& link_of) {
    const double now_s = seconds(clock_.now().mono - begun_);
    if (!all_live_from_s_ && all_have_readings(collected_)) all_live_from_s_ = now_s;
    const double elapsed_s = all_live_from_s_ ? now_s - *all_live_from_s_ : 0.0;
    const bool is_over = all_live_from_s_ && elapsed_s >= duration_s_;
    if (auto lost = all_live_from_s_ ? lost_sensor(now_s, link_of) : std::nullopt) return std::move(*lost);
    if (is_over || now_s >= next_progress_s_) {
      progress_(elapsed_s, collected_);
      next_progress_s_ = now_s + kProgressInterval_s;
    }
    if (!all_live_from_s_ && now_s >= kFirstReadingTimeout_s) return silent(link_of);
    return is_over;
  }

  CollectedReadings take() { return std::move(collected_); }

 private:
  template <class LinkOf>
  std::optional<Failure> lost_sensor(double now_s, const LinkOf& link_of) {
    for (std::size_t sensor = 0; sensor < sensors_.size(); ++sensor) {
      const LinkNow link = link_of(sensor);
      if (!link.is_lost) {
        lost_from_s_[sensor].reset();
      } else if (now_s - lost_from_s_[sensor].value_or(now_s) >= kMaxLost_s) {
        return unavailable(
            fmt::format("the sensor \"{}\" was lost meanwhile ({}); start again", sensors_[sensor]->name, link.detail));
      } else if (!lost_from_s_[sensor]) {
        lost_from_s_[sensor] = now_s;
      }
    }
    return std::nullopt;
  }

  template <class LinkOf>
  Failure silent(const LinkOf& link_of) const {
    std::size_t sensor = 0;
    while (!collected_[sensor].readings.empty()) ++sensor;
    return unavailable(
        fmt::format("the sensor \"{}\" has sent nothing for {:.0f} s ({}); `yuragi sensors watch --raw {}` shows its "
                    "messages",
                    sensors_[sensor]->name, kFirstReadingTimeout_s, link_of(sensor).detail, sensors_[sensor]->name));
  }

  const SensorConfigs& sensors_;
  double duration_s_;
  const drivers::sensor::Clock& clock_;
  const Source::Progress& progress_;
  MonoTime begun_;
  CollectedReadings collected_;
  std::vector<std::optional<double>> lost_from_s_;  ///< of each sensor; nullopt: it is there
  std::optional<double> all_live_from_s_;
  double next_progress_s_ = 0.0;
};

/// The devices, opened here. They stay open between two stretches, so that the second begins at once.
class DeviceSource final : public Source {
 public:
  DeviceSource(SensorConfigs sensors, const drivers::sensor::Clock& clock)
      : sensors_(std::move(sensors)), clock_(clock) {
    std::vector<std::unique_ptr<drivers::sensor::Sensor>> opened;
    for (const settings::SensorConfig* sensor : sensors_) opened.push_back(settings::open_sensor(*sensor));
    for (auto& sensor : opened) runners_.push_back(std::make_unique<sensing::SensorRunner>(std::move(sensor), clock_));
  }

  std::string description() const override { return "the devices themselves"; }
  bool is_live() const override { return true; }

  Result<CollectedReadings, Failure> collect(const Stretch& stretch, const Progress& progress) override {
    LiveStretch live(sensors_, stretch.duration_s, clock_, progress);
    for (const auto& runner : runners_) runner->drain([](const wind::Reading&) {});  // discards earlier readings
    for (;;) {
      std::this_thread::sleep_for(kDevicePause);
      for (std::size_t index = 0; index < runners_.size(); ++index) {
        runners_[index]->drain([&](const wind::Reading& reading) { live.add(index, reading); });
      }
      const auto is_over = live.is_over([this](std::size_t sensor) {
        const sensing::LinkReport link = runners_[sensor]->link();
        return LinkNow{.detail = link.detail, .is_lost = link.state != wind::LinkState::kConnected};
      });
      if (!is_over) return is_over.error();
      if (*is_over) return live.take();
    }
  }

 private:
  SensorConfigs sensors_;
  const drivers::sensor::Clock& clock_;
  std::vector<std::unique_ptr<sensing::SensorRunner>> runners_;
};

const wire::SensorStatus* find_status(const wire::Sensors& all, const settings::SensorConfig& sensor) {
  const auto found = std::ranges::find_if(all.sensors, [&](const wire::SensorStatus& status) {
    return status.name == sensor.name && status.driver == sensor.driver->name;
  });
  return found != all.sensors.end() ? &*found : nullptr;
}

/// A client of the daemon, subscribed to the sensors. Nullopt if no daemon replies.
std::optional<stream::Client> connect_to_daemon(const std::string& address) {
  auto client = stream::Client::connect(address, kDaemonConnectTimeout);
  if (!client || !client->subscribe({.poses = false, .sensors = true, .client = "calibrate"})) return std::nullopt;
  return std::move(*client);
}

/// The daemon's next message about its sensors. Fails if the connection ends.
Result<wire::Sensors, Failure> next_sensors(stream::Client& client, const std::string& address) {
  for (;;) {
    auto message = client.receive(kDaemonSilence);
    if (!message) return stream::connection_lost(address, message.error());
    if (const auto refusal = stream::refusal_in(*message, address)) return *refusal;
    if (auto* sensors = std::get_if<wire::Sensors>(&*message)) return std::move(*sensors);
  }
}

/// The daemon as the source: it sends each sensor's last raw reading about twice a second.
class DaemonSource final : public Source {
 public:
  DaemonSource(SensorConfigs sensors, std::string address, const drivers::sensor::Clock& clock)
      : sensors_(std::move(sensors)), address_(std::move(address)), clock_(clock) {}

  std::string description() const override { return "the running daemon at " + address_; }
  bool is_live() const override { return true; }

  Result<CollectedReadings, Failure> collect(const Stretch& stretch, const Progress& progress) override {
    // A new connection: an old one would deliver readings from before the stretch.
    auto client = connect_to_daemon(address_);
    if (!client) return unavailable("the daemon at " + address_ + " no longer replies");
    std::vector<std::optional<std::uint64_t>> counted(sensors_.size());
    std::vector<LinkNow> links(sensors_.size(), {.detail = "unknown to the daemon", .is_lost = true});

    LiveStretch live(sensors_, stretch.duration_s, clock_, progress);
    for (;;) {
      const auto all = next_sensors(*client, address_);
      if (!all) return all.error();
      for (std::size_t index = 0; index < sensors_.size(); ++index) {
        const wire::SensorStatus* status = find_status(*all, *sensors_[index]);
        if (status == nullptr) continue;
        const bool is_lost = status->state == wind::judging::SensorState::kDisconnected ||
                             status->state == wind::judging::SensorState::kStale;
        links[index] = {.detail = is_lost ? status->state_reason : status->detail, .is_lost = is_lost};
        // The first message may contain an older reading.
        const bool is_new = counted[index] && *counted[index] != status->readings && status->raw_speed_m_s;
        counted[index] = status->readings;
        if (is_new) live.add(index, reading_of(*status));
      }
      const auto is_over = live.is_over([&links](std::size_t sensor) { return links[sensor]; });
      if (!is_over) return is_over.error();
      if (*is_over) return live.take();
    }
  }

 private:
  wind::Reading reading_of(const wire::SensorStatus& status) const {
    wind::Reading reading;
    reading.time = clock_.now();
    reading.speed_m_s = status.raw_speed_m_s.value_or(0.0);
    reading.direction_deg = status.raw_direction_deg;
    reading.quality = status.simulated ? wind::ReadingQuality::kSimulated : wind::ReadingQuality::kGood;
    return reading;
  }

  SensorConfigs sensors_;
  std::string address_;
  const drivers::sensor::Clock& clock_;
};

/// A recording, read from its beginning for each stretch.
class RecordedSource final : public Source {
 public:
  RecordedSource(SensorConfigs sensors, std::filesystem::path file)
      : sensors_(std::move(sensors)), file_(std::move(file)) {}

  /// Checks that it can be read and has all of the sensors.
  Result<void, Failure> check() const {
    const auto reader = opened();
    if (!reader) return reader.error();
    const auto& known = reader->sensors();
    for (const settings::SensorConfig* sensor : sensors_) {
      if (std::ranges::find(known, sensor->name, &drivers::windlog::LoggedSensor::name) != known.end()) continue;
      std::set<std::string> names;
      for (const drivers::windlog::LoggedSensor& one : known) names.insert(one.name);
      return Failure{
          fmt::format("{}: has no sensor \"{}\"; there are: {}", file_.string(), sensor->name, fmt::join(names, ", ")),
          FailureKind::kBadData};
    }
    return {};
  }

  std::string description() const override { return "the recording " + file_.string(); }
  bool is_live() const override { return false; }

  Result<CollectedReadings, Failure> collect(const Stretch& stretch, const Progress& progress) override {
    auto open = opened();
    if (!open) return open.error();
    drivers::windlog::Reader& reader = *open;
    if (stretch.from_s) reader.seek(from_seconds(*stretch.from_s));
    CollectedReadings collected(sensors_.size());
    for (std::size_t count = 1;; ++count) {
      auto logged = reader.next();
      if (!logged) return Failure{logged.error().message, FailureKind::kBadData};
      if (!*logged) break;
      const double time_s = seconds((*logged)->log_time);
      if (stretch.to_s && time_s >= *stretch.to_s) break;
      if (count % kReadingsPerProgress == 0) progress(time_s, collected);
      const drivers::windlog::LoggedSensor& from = reader.sensors()[(*logged)->sensor];
      for (std::size_t index = 0; index < sensors_.size(); ++index) {
        if (sensors_[index]->name != from.name) continue;
        collected[index].readings.push_back({time_s, (*logged)->reading});
        if (from.driver == sensors_[index]->driver->name) collected[index].settings.insert(from.options);
      }
    }
    return collected;
  }

 private:
  Result<drivers::windlog::Reader, Failure> opened() const { return drivers::windlog::Reader::open(file_); }

  SensorConfigs sensors_;
  std::filesystem::path file_;
};

}  // namespace

Result<std::unique_ptr<Source>, Failure> make_live_source(SensorConfigs sensors, const std::string& address,
                                                          const drivers::sensor::Clock& clock,
                                                          bool daemon_has_these_settings) {
  auto client = connect_to_daemon(address);
  if (!client) return std::make_unique<DeviceSource>(std::move(sensors), clock);

  const auto received = next_sensors(*client, address);
  if (!received) return received.error();
  const wire::Sensors& all = *received;
  const auto held = std::ranges::count_if(
      sensors, [&all](const settings::SensorConfig* sensor) { return find_status(all, *sensor) != nullptr; });
  if (held == 0) return std::make_unique<DeviceSource>(std::move(sensors), clock);
  for (const settings::SensorConfig* sensor : sensors) {
    const wire::SensorStatus* status = find_status(all, *sensor);
    std::string obstacle;
    if (status == nullptr) {
      obstacle = fmt::format("does not have the sensor \"{}\"", sensor->name);
    } else if (status->replayed) {
      obstacle = "plays a recording; use --recording with it";
    } else if (status->readings > 0 && !status->raw_speed_m_s) {
      obstacle = "is an older version, which sends calibrated readings only";
    } else if (sensor->driver->calibration == drivers::sensor::CalibrationMeans::kSoundLevel &&
               !daemon_has_these_settings) {
      // Its readings were computed with the gain and exponent, or the curve, of when the daemon was started.
      obstacle =
          "uses the microphone, perhaps with other settings than the file has now (add --unchanged if they were not "
          "changed since it was started)";
    }
    if (!obstacle.empty()) {
      return unavailable(fmt::format("the daemon at {} {}: stop it for the calibration", address, obstacle));
    }
  }
  return std::make_unique<DaemonSource>(std::move(sensors), address, clock);
}

Result<std::unique_ptr<Source>, Failure> make_recorded_source(SensorConfigs sensors,
                                                              const std::filesystem::path& file) {
  auto source = std::make_unique<RecordedSource>(std::move(sensors), file);
  if (const auto checked = source->check(); !checked) return checked.error();
  return source;
}

}  // namespace yuragi::daemon::tools::calibration
