#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "daemon/config.hpp"
#include "daemon/fallback_recording.hpp"
#include "daemon/player_director.hpp"
#include "daemon/sensor_runner.hpp"
#include "engine/wind/wind_estimator.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi {

/// All sensors of an installation, and the estimator that makes one wind of what they say. Belongs to the I/O thread;
/// each sensor runs on a thread of its own.
class SensorHub {
 public:
  /// Sees each plausible reading, before calibration; the recorder listens here.
  using Listener = std::function<void(std::size_t sensor, const WindReading&)>;

  /// Opens and starts every sensor. `noise`: of the gusts. Throws ConfigError where a sensor cannot be made of its
  /// values.
  SensorHub(const Config& config, const Clock& clock, std::shared_ptr<const GustNoise> noise, Listener listener = {});

  /// Takes in what has arrived and says what the wind is now. Logs each change of a sensor's state once.
  const WindState& advance();

  /// The wind as of the last advance().
  const WindState& wind() const noexcept { return wind_; }
  const GroundWind& ground() const noexcept { return estimator_->ground(); }

  /// How each sensor does, for the stream and for `sensors watch`; and the fall-back, while it plays.
  std::vector<wire::SensorStatus> status() const;

  /// Decides for each sensor, by its name, whether the messages to and from its device are kept for drain_traces().
  void trace(const std::function<bool(std::string_view sensor)>& is_wanted);

  /// Hands on the messages that were kept since the last time: sensor by sensor, oldest first.
  void drain_traces(const std::function<void(const wire::RawTrace&)>& use);

  /// A line for each sensor in the log: what came of it since the start.
  void log_summary() const;

  /// The controls of the sensors that play a recording; they live as long as the hub.
  std::vector<NamedPlayer> players();

  /// True when every sensor is a recording that has come to its end.
  bool is_finished() const;

 private:
  struct Channel {
    SensorConfig config;
    Calibration calibration;
    std::unique_ptr<SensorRunner> runner;
    std::uint64_t readings = 0;
    SourceHealth logged_health = SourceHealth::kSilent;
    std::uint64_t logged_link_reports = 0;
    LinkState logged_link = LinkState::kConnecting;
  };

  void log_changes(std::size_t index);
  bool is_any_live() const;

  const Clock& clock_;
  Listener listener_;
  std::unique_ptr<WindEstimator> estimator_;
  std::vector<Channel> channels_;
  FallbackRecording fallback_;  ///< the estimator's source behind those of the channels
  WindState wind_;
};

/// The pattern of gusts of an installation: the estimator and the scenes share it. Set-up work of about 0.1 s.
std::shared_ptr<const GustNoise> make_gust_noise(const Config& config);

/// The estimator that a configuration asks for, with one source for each of its sensors, and one for the fall-back.
std::unique_ptr<WindEstimator> make_estimator(const Config& config, std::shared_ptr<const GustNoise> noise);

}  // namespace yuragi
