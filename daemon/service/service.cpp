#include "daemon/service/service.hpp"

#include <csignal>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/animation/animation.hpp"
#include "daemon/animation/animation_loop.hpp"
#include "daemon/animation/scene_director.hpp"
#include "daemon/recording/recorder.hpp"
#include "daemon/sensing/player_director.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/sensing/system_clock.hpp"
#include "daemon/shaping/wind_shaper.hpp"
#include "daemon/stream/tcp_stream.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/latest.hpp"
#include "engine/base/version.hpp"

namespace yuragi::daemon::service {
namespace {

namespace asio = boost::asio;

constexpr auto kStatusInterval = std::chrono::milliseconds(500);

static_assert(settings::kMostSensors + 1 <= wire::kMaxSensors && settings::kMostScenes <= wire::kMaxScenes);

/// Signals that would end the program without closing the recording. SIGPIPE: nobody reads the log any more. SIGXFSZ: a
/// file has reached its limit, which the recorder is told of, too. The others have no meaning here.
void ignore_what_need_not_end_it() {
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGUSR1, SIGUSR2}) std::signal(signal, SIG_IGN);
}

}  // namespace

class Service::Io {
 public:
  Io(const settings::Config& config, const ServiceOptions& options)
      : options_(options),
        rate_hz_(config.animation.rate_hz),
        gusts_(sensing::make_gust_noise(config)),
        animation_(options.with_scenes ? std::make_unique<animation::Animation>(config, gusts_) : nullptr),
        director_(config, [this](const animation::SceneCue& cue) { return loop_ && loop_->cue(cue); }),
        stream_(io_, config.stream.listen, stream_settings(config)),
        recorder_(options.record ? make_recorder(config, *options.record) : nullptr),
        hub_(config, clock_, gusts_, listener(), animation_ ? animation_->reach_m() : 0.0),
        shaper_(config, gusts_),
        players_(config.stream.control, hub_.players()) {
    if (animation_) {
      shaper_.keep_site_file(hub_.site());
      loop_ = std::make_unique<animation::AnimationLoop>(*animation_, wind_, clock_, rate_hz_);
      frame_ready_.assign(dup(loop_->frame_ready_fd()));
    }
  }

  void run() {
    ignore_what_need_not_end_it();
    spdlog::info("listening on {}", stream_.local_endpoint());
    if (recorder_) spdlog::info("recording to {}", options_.record->string());
    if (animation_) spdlog::info("{} nodes at {} Hz", animation_->node_count(), rate_hz_);

    signals_.async_wait([this](const boost::system::error_code& error, int signal) {
      if (!error) end(signal == SIGINT ? "interrupted" : "terminated");
    });
    if (options_.duration_s) {
      end_timer_.expires_after(from_seconds(*options_.duration_s));
      end_timer_.async_wait([this](const boost::system::error_code& error) {
        if (!error) end("the duration has elapsed");
      });
    }
    next_wind_ = asio::steady_timer::clock_type::now();
    step_wind();
    send_status();
    if (loop_) {
      wait_for_frame();
      loop_->start();
    }

    io_.run();

    // Readings until now are recorded, too.
    hub_.advance();
    if (recorder_) recorder_->close();
    log_summary();
  }

 private:
  /// Throws where the scenes exceed the stream's limits: clients would refuse them.
  static void refuse_what_no_client_takes(const wire::Scenes& scenes) {
    const wire::Bytes message = wire::encode(scenes);
    if (wire::decode(std::span(message).subspan(wire::kSizePrefixBytes))) return;
    throw settings::ConfigError(
        fmt::format("[[scene]]: the scenes are larger than the stream allows; allowed in total: {} scenes, {} strands, "
                    "joints of cloth and points of surfaces",
                    wire::kMaxScenes, wire::kMaxStrands));
  }

  stream::TcpStreamSettings stream_settings(const settings::Config& config) {
    stream::TcpStreamSettings settings;
    settings.hello.software = with_version("yuragi");
    settings.hello.tick_rate_hz = rate_hz_;
    if (animation_) {
      settings.scenes = animation_->describe();
      refuse_what_no_client_takes(settings.scenes);
    }
    settings.on_control = [this](const wire::Control& control, bool is_local) { return handle(control, is_local); };
    settings.max_clients = config.stream.max_clients;
    return settings;
  }

  wire::ControlReply handle(const wire::Control& control, bool is_local) {
    if (control.player) return players_.handle(*control.player, is_local);
    if (animation_) return director_.handle(control, is_local);
    return {.done = false, .message = "this daemon has no scenes", .scenes = {}};
  }

  std::unique_ptr<recording::Recorder> make_recorder(const settings::Config& config,
                                                     const std::filesystem::path& file) const;

  sensing::SensorHub::Listener listener() {
    if (!recorder_) return {};
    return [this](std::size_t sensor, const wind::WindReading& reading) { recorder_->push(sensor, reading); };
  }

  /// Takes readings and advances the wind, at the rate of the animation.
  void step_wind() {
    wind::ground::DrivingWind wind{hub_.advance(), hub_.ground(), hub_.stroke()};
    shaper_.shape(wind, clock_.now().utc, hub_.is_any_live());
    wind_.publish(wind);
    hub_.trace([this](std::string_view sensor) { return stream_.wants_trace(sensor); });
    hub_.drain_traces([this](const wire::RawTrace& trace) { stream_.publish_trace(trace); });
    if (options_.end_with_recordings && hub_.is_finished()) return end("the recording has ended");

    // Steps are at fixed times; those missed while the machine was halted are skipped.
    const auto period = from_seconds(1.0 / rate_hz_);
    next_wind_ = std::max(next_wind_ + period, asio::steady_timer::clock_type::now() - period);
    wind_timer_.expires_at(next_wind_);
    wind_timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) step_wind();
    });
  }

  void wait_for_frame() {
    frame_ready_.async_read_some(asio::buffer(&frames_made_, sizeof frames_made_),
                                 [this](const boost::system::error_code& error, std::size_t) {
                                   if (error) return;
                                   if (const wire::Bytes* frame = loop_->take_frame()) {
                                     stream_.publish(std::make_shared<const wire::Bytes>(*frame));
                                   }
                                   wait_for_frame();
                                 });
  }

  void send_status() {
    wire::Sensors status;
    status.sensors = hub_.status();
    status.wind = hub_.wind();
    status.shaping = shaper_.status();
    status.late_ticks = loop_ ? loop_->counters().skipped_ticks.load(std::memory_order_relaxed) : 0;
    status.clients = static_cast<std::uint32_t>(stream_.client_count());
    stream_.publish_sensors(std::make_shared<const wire::Bytes>(wire::encode(status)));

    status_timer_.expires_after(kStatusInterval);
    status_timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) send_status();
    });
  }

  void log_summary() const;

  void end(const char* why) {
    spdlog::info("ending: {}", why);
    if (loop_) loop_->stop();
    stream_.close();
    signals_.cancel();
    end_timer_.cancel();
    wind_timer_.cancel();
    status_timer_.cancel();
    frame_ready_.close();
    io_.stop();
  }

  ServiceOptions options_;
  double rate_hz_;
  sensing::SystemClock clock_;
  asio::io_context io_{1};
  asio::signal_set signals_{io_, SIGINT, SIGTERM, SIGHUP};
  asio::steady_timer end_timer_{io_}, wind_timer_{io_}, status_timer_{io_};
  asio::steady_timer::time_point next_wind_;
  asio::posix::stream_descriptor frame_ready_{io_};
  std::uint64_t frames_made_ = 0;

  // In this order, so that a second daemon fails at the address in use before it touches the recording or a sensor.
  std::shared_ptr<const wind::turbulence::GustNoise> gusts_;
  std::unique_ptr<animation::Animation> animation_;
  animation::SceneDirector director_;
  stream::TcpStream stream_;
  std::unique_ptr<recording::Recorder> recorder_;
  sensing::SensorHub hub_;
  shaping::WindShaper shaper_;
  sensing::PlayerDirector players_;
  Latest<wind::ground::DrivingWind> wind_;
  std::unique_ptr<animation::AnimationLoop> loop_;
};

std::unique_ptr<recording::Recorder> Service::Io::make_recorder(const settings::Config& config,
                                                                const std::filesystem::path& file) const {
  recording::RecordingInfo info{.started = clock_.now(),
                                .software = with_version("yuragi"),
                                .configuration = settings::to_toml(config),
                                .sensors = {}};
  for (const settings::SensorConfig& sensor : config.sensors) {
    info.sensors.push_back({sensor.name, std::string(sensor.driver->name), settings::to_toml(sensor.values)});
  }
  return std::make_unique<recording::Recorder>(file, std::move(info),
                                               [](std::string_view news) { spdlog::warn("recording: {}", news); });
}

void Service::Io::log_summary() const {
  hub_.log_summary();
  if (recorder_) {
    const recording::RecorderStatus status = recorder_->status();
    spdlog::info("recorded {}, lost {}", count_text(status.written, "reading"), status.lost);
  }
  if (!loop_) return;
  const animation::LoopCounters& counters = loop_->counters();
  spdlog::info("{} ticks, {} skipped; lateness p50 {:.3f} ms, p99 {:.3f} ms; work p50 {:.3f} ms, p99 {:.3f} ms",
               counters.ticks.load(), counters.skipped_ticks.load(), 1e3 * counters.lateness.percentile_s(0.5),
               1e3 * counters.lateness.percentile_s(0.99), 1e3 * counters.work.percentile_s(0.5),
               1e3 * counters.work.percentile_s(0.99));
}

Service::Service(const settings::Config& config, const ServiceOptions& options)
    : io_(std::make_unique<Io>(config, options)) {}
Service::~Service() = default;
void Service::run() {
  io_->run();
}

}  // namespace yuragi::daemon::service
