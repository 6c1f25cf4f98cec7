// A recording in place of a sensor: plays a .windlog (drivers/windlog) against the clock.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "drivers/recording/recording_player.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "drivers/windlog/windlog_player.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::recording {
namespace {

constexpr Nanoseconds kFirstBackOff = std::chrono::seconds(1);
constexpr Nanoseconds kMaxBackOff = std::chrono::seconds(30);
constexpr std::size_t kMaxWaitingOrders = 64;

using windlog::PlaybackOptions;
using windlog::PlayerOptions;

struct ReplayKeys {
  std::string file;
  PlayerOptions options;
  std::string utc_offset;
};

auto of_options(auto member) {
  return member_of(&ReplayKeys::options, member);
}
auto of_playback(auto member) {
  return member_of(&ReplayKeys::options, &PlayerOptions::playback, member);
}

const Fields<ReplayKeys> kWindlogFields = {
    {{.name = "file",
      .default_value = std::string{},
      .help = "the recording (.windlog); required; `yuragi import` makes one from CSV"},
     &ReplayKeys::file},
    {{.name = "rate",
      .default_value = 1.0,
      .min = 0.01,
      .max = 1000.0,
      .help = "speed of playing: 2 plays two seconds of the recording each second",
      .change = KeyChange::kAtOnce},
     of_options(&PlayerOptions::rate)},
    {{.name = "loop", .default_value = false, .help = "start again at the end"}, of_playback(&PlaybackOptions::loop)},
    {{"seam", "s", 5.0, 0.0, 600.0, "duration of the cross-fade at the end of a loop and at a seek; 0: none"},
     of_options(&PlayerOptions::seam_s)},
    {{.name = "start",
      .default_value = std::string{},
      .help = "where to begin: seconds from the first reading, or a time such as 2018-07-20T14:05:00Z"},
     of_playback(&PlaybackOptions::start)},
    {{.name = "same_time_of_day",
      .default_value = false,
      .help = "start, and restart, at the present local time of day: on the first day from `start` on with a reading "
              "then, otherwise at the next later reading"},
     of_options(&PlayerOptions::at_time_of_day)},
    {{.name = "utc_offset",
      .default_value = std::string{},
      .help = "for same_time_of_day: the time zone of the recording's place, in hours ahead of UTC (1, -3.5); empty: "
              "this machine's time zone"},
     &ReplayKeys::utc_offset},
    {{.name = "paused", .default_value = false, .help = "start paused, at the first reading"},
     of_options(&PlayerOptions::is_paused)},
    {{.name = "sensor",
      .default_value = std::string{},
      .help = "name of the recorded sensor; empty: the one with the first reading; *: all, as one"},
     of_playback(&PlaybackOptions::sensor)},
};

class WindlogReplay final : public sensor::Sensor, public Player {
 public:
  WindlogReplay(std::filesystem::path file, windlog::PlayerOptions options)
      : file_(std::move(file)), options_(std::move(options)) {
    report_.file = file_.string();
  }

  MonoTime poll(const sensor::Clock& clock, sensor::Sink& sink) override {
    const Instant now = clock.now();
    auto next = play(now, sink);
    std::string failure;
    if (next) {
      back_off_ = Nanoseconds{0};
      report(sink);
    } else {
      // The player, if there is one, keeps its place.
      failure = next.error().message;
      sink.link(wind::LinkState::kConnecting, failure);
      reported_.reset();
      back_off_ = back_off_ == Nanoseconds{0} ? kFirstBackOff : std::min(2 * back_off_, kMaxBackOff);
      next = now.mono + back_off_;
    }
    publish_report(now.mono, std::move(failure));
    return *next;
  }

  void interrupt() noexcept override { stop_.request_stop(); }

  /// The place that belongs to a time of day is early as it is.
  void begin_early(double lead_s) override {
    if (!options_.at_time_of_day) options_.lead_s = lead_s * options_.rate;
  }

  std::optional<std::uint64_t> order(const PlayerOrder& order) override {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() == kMaxWaitingOrders) return std::nullopt;
    waiting_.push_back(order);
    return ++orders_given_;
  }

  PlayerReport report() const override {
    const std::lock_guard lock(mutex_);
    return report_;
  }

 private:
  /// The states that are reported by the link.
  enum class Doing : std::uint8_t { kPlaying, kPaused, kFinished };

  /// Plays the readings that are due; returns when the next one is due.
  Result<MonoTime, Failure> play(const Instant& now, sensor::Sink& sink) {
    if (!player_) {
      auto opened = windlog::Player::open(file_, options_, now, stop_.get_token());
      if (!opened) return opened.error();
      player_.emplace(std::move(*opened));
    }
    carry_out_orders(now);
    return player_->play(now, [&sink](const wind::Reading& reading) { sink.reading(reading); });
  }

  void carry_out_orders(const Instant& now) {
    std::vector<PlayerOrder> orders;
    {
      const std::lock_guard lock(mutex_);
      orders.swap(waiting_);
    }
    for (const PlayerOrder& order : orders) {
      const auto done = carry_out(order, now);
      refusal_ = done ? std::string{} : done.error().message;
      ++orders_done_;
    }
  }

  Result<void, Failure> carry_out(const PlayerOrder& order, const Instant& now) {
    switch (order.kind) {
      case PlayerOrder::Kind::kPause:
        player_->pause(now);
        break;
      case PlayerOrder::Kind::kResume:
        player_->resume(now);
        break;
      case PlayerOrder::Kind::kStep:
        return player_->step(now, order.count);
      case PlayerOrder::Kind::kSeek:
        return player_->seek(now, order.place);
      case PlayerOrder::Kind::kRate:
        player_->set_rate(now, order.rate);
        break;
    }
    return {};
  }

  /// Reports the link state when it has changed.
  void report(sensor::Sink& sink) {
    const Doing doing = player_->is_finished() ? Doing::kFinished
                        : player_->is_paused() ? Doing::kPaused
                                               : Doing::kPlaying;
    if (doing == reported_) return;
    reported_ = doing;
    switch (doing) {
      case Doing::kPlaying:
        return sink.link(wind::LinkState::kConnected, "playing " + file_.string());
      case Doing::kPaused:
        return sink.link(wind::LinkState::kConnected, "paused: " + file_.string() + " is paused, and its wind is held");
      case Doing::kFinished:
        return sink.link(wind::LinkState::kFinished, file_.string() + " has ended; `loop = true` would repeat it");
    }
  }

  /// Orders together with the position that they have led to: who waits for an order reads that.
  void publish_report(MonoTime now, std::string failure) {
    const std::lock_guard lock(mutex_);
    report_.orders_done = orders_done_;
    report_.refusal = refusal_;
    report_.failure = std::move(failure);
    report_.position.reset();
    if (player_) report_.position = player_->position(now);
  }

  std::filesystem::path file_;
  windlog::PlayerOptions options_;
  std::stop_source stop_;

  // Of the sensor's thread.
  std::optional<windlog::Player> player_;
  Nanoseconds back_off_{0};
  std::optional<Doing> reported_;
  std::uint64_t orders_done_ = 0;
  std::string refusal_;  ///< of the last order

  mutable std::mutex mutex_;  // for the members below; seldom locked, and never by the animation
  std::vector<PlayerOrder> waiting_;
  std::uint64_t orders_given_ = 0;
  PlayerReport report_;
};

/// The result of `parse` for a parameter's text; throws an exception that names the parameter.
template <class T>
T value_of(const char* parameter, Result<T, Failure> parsed) {
  if (!parsed) throw std::runtime_error(std::string("windlog: ") + parameter + ": " + parsed.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*parsed);
}

std::unique_ptr<sensor::Sensor> open_windlog(const ParameterValues& values) {
  ReplayKeys keys = kWindlogFields.of(values);
  const std::filesystem::path file = keys.file;
  if (file.empty()) throw std::runtime_error("windlog: file: name the recording to play");
  if (!windlog::recording_exists(file)) {
    throw std::runtime_error("windlog: file: " + file.string() +
                             ": the recording does not exist; `yuragi run --record FILE` or `yuragi import` makes one");
  }
  value_of("start", windlog::check_playback_start(keys.options.playback.start));
  keys.options.recorded_offset = value_of("utc_offset", windlog::parse_utc_offset(keys.utc_offset));
  return play_recording(file, std::move(keys.options));
}

/// The same readings can be played from two positions.
sensor::ValueSelection windlog_selection(const ParameterValues& values) {
  const ReplayKeys keys = kWindlogFields.of(values);
  std::error_code error;
  const auto behind_links = std::filesystem::weakly_canonical(keys.file, error);
  const PlaybackOptions& playback = keys.options.playback;
  return {.device = "recording " + (error ? keys.file : behind_links.string()),
          .device_keys = "file",
          .parts = {{.key = "sensor", .value = playback.sensor == "*" ? "" : playback.sensor},
                    {.key = "start", .value = playback.start.empty() ? "the first reading" : playback.start}}};
}

std::vector<sensor::Endpoint> windlog_endpoints(const ParameterValues& values) {
  return {{.kind = sensor::EndpointKind::kFile, .name = kWindlogFields.of(values).file}};
}

}  // namespace

std::unique_ptr<sensor::Sensor> play_recording(std::filesystem::path file, windlog::PlayerOptions options) {
  return std::make_unique<WindlogReplay>(std::move(file), std::move(options));
}

extern const sensor::DriverDescription kWindlogDriver;
const sensor::DriverDescription kWindlogDriver{
    .name = "windlog",
    .summary = "plays a recording",
    .parameters = kWindlogFields.parameters(),
    .open = open_windlog,
    .endpoints = windlog_endpoints,
    .selection = windlog_selection,
    .simulated = [](const ParameterValues&) -> Result<sensor::SimulatedDevice, Failure> {
      return Failure{"the driver windlog has no simulated device, because it plays a recording"};
    },
    .plays_recordings = true};

}  // namespace yuragi::drivers::recording
