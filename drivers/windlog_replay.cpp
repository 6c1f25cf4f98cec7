// A recording in place of a sensor: plays a .windlog (drivers/windlog) against the clock.
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "drivers/driver.hpp"
#include "drivers/windlog/windlog_playback.hpp"

namespace yuragi {
namespace {

constexpr Nanoseconds kFirstBackOff = std::chrono::seconds(1);
constexpr Nanoseconds kMaxBackOff = std::chrono::seconds(30);
// Later than this (the machine was suspended) it goes on from where it was, rather than pour out what it missed.
constexpr Nanoseconds kMaxLateness = std::chrono::seconds(1);
// A poll() ends after so many readings at the latest, whatever the rate.
constexpr int kMaxReadingsPerPoll = 4096;
// What is due later than this never comes: a clock could not hold it. About 30 years.
constexpr double kMaxWait_s = 1e9;
// Nothing comes after the end; a clock can add this to any time.
constexpr Nanoseconds kAfterTheEnd = std::chrono::hours(24);

const std::array<Parameter, 5> kWindlogParameters = {
    Parameter{.name = "file",
              .unit = "",
              .default_value = std::string{},
              .help = "the recording (.windlog); required; `yuragi import` makes one of a CSV"},
    Parameter{.name = "rate",
              .unit = "",
              .default_value = 1.0,
              .min = 0.01,
              .max = 1000.0,
              .help = "how many seconds of the recording are played in one second"},
    Parameter{.name = "loop", .unit = "", .default_value = false, .help = "begin again at the end"},
    Parameter{.name = "start",
              .unit = "",
              .default_value = std::string{},
              .help = "where to begin: seconds from the first reading, or a moment such as 2018-07-20T14:05:00Z"},
    Parameter{.name = "sensor",
              .unit = "",
              .default_value = std::string{},
              .help = "which recorded sensor, by its name; empty: the one that spoke first; *: all of them as one"},
};

class WindlogReplay final : public Sensor {
 public:
  WindlogReplay(std::filesystem::path file, PlaybackOptions options, double rate)
      : file_(std::move(file)), options_(std::move(options)), rate_(rate) {}

  MonoTime poll(const Clock& clock, SensorSink& sink) override {
    const Instant now = clock.now();
    if (finished_) return now.mono + kAfterTheEnd;
    try {
      if (!playback_) {
        playback_.emplace(file_, options_);
        origin_ = now.mono;
      }
      return play(now, sink);
    } catch (const std::exception& error) {
      // The playback, if there is one, keeps its place.
      sink.link(LinkState::kConnecting, error.what());
      answers_ = false;
      back_off_ = back_off_ == Nanoseconds{0} ? kFirstBackOff : std::min(2 * back_off_, kMaxBackOff);
      return now.mono + back_off_;
    }
  }

 private:
  /// Publishes what is due by now, each reading with the moment at which it was; answers when the next one is.
  MonoTime play(const Instant& now, SensorSink& sink) {
    for (int published = 0;; ++published) {
      if (!upcoming_) upcoming_ = playback_->next();
      if (!answers_) connect(sink);
      if (!upcoming_) return finish(now, sink);

      MonoTime due = due_time();
      if (due > now.mono || published == kMaxReadingsPerPoll) return due;
      if (now.mono - due > kMaxLateness) {
        origin_ += now.mono - due;
        due = now.mono;
      }
      WindReading reading = upcoming_->reading;
      reading.time = {due, now.utc - (now.mono - due)};
      upcoming_.reset();
      sink.reading(reading);
    }
  }

  void connect(SensorSink& sink) {
    answers_ = true;
    back_off_ = Nanoseconds{0};
    sink.link(LinkState::kConnected, "playing " + file_.string());
  }

  MonoTime finish(const Instant& now, SensorSink& sink) {
    finished_ = true;
    sink.link(LinkState::kFinished, file_.string() + " is played; `loop = true` would begin it again");
    return now.mono + kAfterTheEnd;
  }

  MonoTime due_time() const {
    const std::chrono::duration<double> wait(std::min(upcoming_->log_time_s / rate_, kMaxWait_s));
    return origin_ + std::chrono::round<Nanoseconds>(wait);
  }

  std::filesystem::path file_;
  PlaybackOptions options_;
  double rate_;

  std::optional<WindlogPlayback> playback_;
  std::optional<PlayedReading> upcoming_;
  MonoTime origin_{};  ///< when log time zero is, or was, due
  Nanoseconds back_off_{0};
  bool answers_ = false;
  bool finished_ = false;
};

std::unique_ptr<Sensor> open_windlog(const ParameterValues& values) {
  const std::filesystem::path file = values.text("file");
  if (file.empty()) throw std::runtime_error("windlog: file: name the recording to play");
  if (!std::filesystem::exists(file)) {
    throw std::runtime_error("windlog: file: " + file.string() +
                             ": there is no such recording; `yuragi run --record FILE` or `yuragi import` makes one");
  }
  PlaybackOptions options{values.text("start"), values.flag("loop"), values.text("sensor")};
  if (const auto start = check_playback_start(options.start); !start) {
    throw std::runtime_error("windlog: start: " + start.error().message);
  }
  return std::make_unique<WindlogReplay>(file, std::move(options), values.number("rate"));
}

}  // namespace

extern const DriverDescription kWindlogDriver;
const DriverDescription kWindlogDriver{.name = "windlog",
                                       .summary = "a recorded wind, played again",
                                       .parameters = kWindlogParameters,
                                       .open = open_windlog,
                                       .plays_recordings = true};

}  // namespace yuragi
