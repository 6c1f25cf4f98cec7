#include "daemon/service/service.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/alerts/alerts.hpp"
#include "daemon/animation/animation.hpp"
#include "daemon/animation/animation_loop.hpp"
#include "daemon/animation/led_steps.hpp"
#include "daemon/animation/recent_lateness.hpp"
#include "daemon/animation/scene_director.hpp"
#include "daemon/animation/scene_exchange.hpp"
#include "daemon/feeds/feeds.hpp"
#include "daemon/follow/company.hpp"
#include "daemon/history/history_json.hpp"
#include "daemon/history/history_reader.hpp"
#include "daemon/history/wind_history.hpp"
#include "daemon/recording/recorder.hpp"
#include "daemon/sensing/held_clock.hpp"
#include "daemon/sensing/player_director.hpp"
#include "daemon/sensing/recorded_source.hpp"
#include "daemon/sensing/recording_folders.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/service/config_check.hpp"
#include "daemon/service/hand_director.hpp"
#include "daemon/service/hangup.hpp"
#include "daemon/service/lead_in.hpp"
#include "daemon/service/moment_source.hpp"
#include "daemon/service/parameter_director.hpp"
#include "daemon/service/reload.hpp"
#include "daemon/service/reload_report.hpp"
#include "daemon/service/resumption.hpp"
#include "daemon/service/service_manager.hpp"
#include "daemon/settings/config_file.hpp"
#include "daemon/settings/page_file.hpp"
#include "daemon/shaping/wind_shaper.hpp"
#include "daemon/state/attention.hpp"
#include "daemon/stream/tcp_stream.hpp"
#include "daemon/web/access.hpp"
#include "daemon/web/installed_files.hpp"
#include "daemon/web/web_server.hpp"
#include "engine/base/address.hpp"
#include "engine/base/contain.hpp"
#include "engine/base/count_text.hpp"
#include "engine/base/latest.hpp"
#include "engine/base/version.hpp"
#include "engine/output/output.hpp"
#include "engine/platform/clock_watch.hpp"
#include "engine/platform/secret_file.hpp"
#include "engine/wire/lead/wind_tick.hpp"

namespace yuragi::daemon::service {
namespace {

namespace asio = boost::asio;

constexpr auto kStatusInterval = std::chrono::milliseconds(500);
/// The interval at which what could not be opened at the start is tried again.
constexpr auto kTryAgainAfter = std::chrono::seconds(2);
constexpr auto kReportInterval = std::chrono::seconds(1);
constexpr auto kMeansInterval = std::chrono::hours(1);
/// Until the answer to the request for a restart has been sent.
constexpr auto kRestartAfter = std::chrono::milliseconds(500);
/// What is shown has settled after a leader's state was loaded (animation::SettlingPoses).
constexpr auto kSettled = std::chrono::seconds(2);
constexpr std::string_view kLedRefusal =
    "this daemon shows what its leader shows ([wind] follow): show and hide scenes there";

static_assert(settings::kMaxSensors + 1 <= wire::kMaxSensors && settings::kMaxScenes <= wire::kMaxScenes);

/// Signals that would end the program without closing the recording. SIGPIPE: nobody reads the log any more. SIGXFSZ: a
/// file has reached its limit, which the recorder also gets as an error. The others have no meaning here.
void ignore_what_need_not_end_it() {
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGUSR1, SIGUSR2}) std::signal(signal, SIG_IGN);
}

wire::RecorderStatus to_wire(const recording::RecorderStatus& status) {
  static_assert(static_cast<int>(wire::RecorderState::kHanging) ==
                static_cast<int>(recording::RecorderState::kHanging));
  return {.state = static_cast<wire::RecorderState>(status.state),
          .written = status.written,
          .waiting = status.waiting,
          .lost = status.lost,
          .free_bytes = status.free_bytes,
          .error = status.error,
          .clock_doubt = status.clock_doubt ? recording::text_of(*status.clock_doubt) : std::string(),
          .recorded_elsewhere = status.recorded_elsewhere};
}

wire::FeedStatus to_wire(const feeds::Status& feed, MonoTime now) {
  wire::FeedStatus status{.kind = feed.kind,
                          .name = feed.name,
                          .target = feed.target,
                          .sends = feed.sends,
                          .messages = feed.messages,
                          .bytes = feed.bytes,
                          .last_sent_age_s = {},
                          .trouble = feed.trouble};
  if (feed.last_sent) status.last_sent_age_s = std::max(0.0, seconds(now - *feed.last_sent));
  return status;
}

feeds::Status as_feed(const follow::Company::Status& company) {
  return {.kind = "nats",
          .name = company.channel,
          .target = company.server,
          .sends = company.part,
          .messages = company.messages,
          .bytes = company.bytes,
          .last_sent = company.last,
          .trouble = company.trouble};
}

std::vector<look::Camera> cameras_of(const settings::Config& config) {
  std::vector<look::Camera> cameras;
  for (const settings::CameraConfig& camera : config.cameras) cameras.push_back(camera.camera);
  return cameras;
}

std::vector<std::string> names_of(const std::vector<look::Camera>& cameras) {
  std::vector<std::string> names;
  names.reserve(cameras.size());
  for (const look::Camera& camera : cameras) names.push_back(camera.name);
  return names;
}

/// The page's address for other machines.
std::string page_url(const web::Server& server) {
  Address address = parse_address(server.local_endpoint()).value();
  if (address.host == "0.0.0.0" || address.host == "::") address.host = asio::ip::host_name();
  const std::string local = server.address();
  return local.substr(0, local.size() - server.local_endpoint().size()) + to_string(address) + "/";
}

wire::Lateness lateness_of(const animation::RecentLateness& recent) {
  return {.p50_s = recent.percentile_s(0.5), .p99_s = recent.percentile_s(0.99), .max_s = recent.max_s()};
}

}  // namespace

class Service::Io {
 public:
  Io(const settings::Config& config, const Options& options)
      : options_(options),
        rate_hz_(config.animation.rate_hz),
        hello_{.software = with_version("yuragi"),
               .tick_rate_hz = rate_hz_,
               .wind_from_deg = config.wind.default_direction_deg},
        http_(config.http),
        least_free_bytes_(config.recording.least_free_bytes),
        page_file_trouble_(config.page_trouble),
        gusts_(sensing::make_gust_noise(config)),
        animation_(options.with_scenes ? std::make_unique<animation::Animation>(config, gusts_) : nullptr),
        director_(config, [this](const animation::SceneCue& cue) { return send(cue); }),
        stream_(io_, config.stream.listen, stream_settings(config)),
        hub_(config, clock_, gusts_, listener(), animation_ ? animation_->reach_m() : 0.0,
             options.lead_s > 0.0 ? sensing::SensorThread::kOfCaller : sensing::SensorThread::kOwn),
        shaper_(config, gusts_),
        moments_(config, gusts_),
        look_(config.look),
        cameras_(cameras_of(config)),
        clock_of_cameras_(config.clock),
        players_(config.stream.control, hub_.players()),
        folders_(config, options.record),
        hand_(config.stream.control, names_of(cameras_)),
        control_(config.stream.control),
        reload_(config, reload_parts(config)),
        resumption_(motion_file(config, options)),
        parameters_(reload_, animation_ ? &director_ : nullptr, config.stream.control,
                    static_cast<std::uint64_t>(started_.utc.time_since_epoch().count())) {
    if (animation_) {
      shaper_.keep_site_file(
          hub_.site(),
          {.gains = {.learnt = [this] { return hub_.relative_gains(); },
                     .restore = [this](const auto& learnt) { return hub_.restore_relative_gains(learnt); }},
           .reach = {.learnt = [this] { return hub_.gust_reach(); },
                     .restore = [this](const auto& learnt) { return hub_.restore_gust_reach(learnt); }}});
      if (config.wind.lead.is_in_company() && !options.recorded_from) join_company(config);
      loop_ = std::make_unique<animation::Loop>(*animation_, wind_, clock_, rate_hz_, led_ ? &*led_ : nullptr);
      recent_tick_lateness_.emplace(loop_->counters().lateness);
      scenes_ = std::make_unique<animation::SceneExchange>(*animation_, *loop_, director_);
      frame_ready_.assign(fcntl(loop_->frame_ready_fd(), F_DUPFD_CLOEXEC, 0));
    }
    if (std::ranges::any_of(config.outputs,
                            [](const output::Table& table) { return table.output.delay_s.has_value(); }))
      clock_watch_.emplace([] { return std::chrono::system_clock::now(); });
    if (options.record) {
      history_ = make_history(*options.record);
      long_history_ = make_history(*options.record);
    }
    read_token();
    open_page();
    for (const std::string& trouble : troubles()) spdlog::warn("{}; it is tried again", trouble);
    // A replay's events are in the past.
    if (!options.recorded_from) {
      alerts_.emplace(config.alerts, asio::ip::host_name(), settings::state_file(options.config_file, "alerts.json"),
                      clock_.now());
    }
    feeds_.emplace(config.feeds, surroundings());
    if (options.record) {
      recorder_ = make_recorder(config, *options.record);
      hub_.listen_to_quantities([this](std::size_t sensor, const wind::StationQuantities& quantities) {
        recorder_->push(sensor, quantities);
      });
    }
  }

  bool run() {
    if (options_.lead_s > 0.0) {
      spdlog::info("warming up: the scenes run through the {:g} s before the beginning", options_.lead_s);
      lead_in(
          options_.lead_s, rate_hz_, clock_, hub_, [this] { return shaped(next_real_wind()); }, *animation_);
    }
    // Not before: during the set-up, which may wait for a disk or a network, these signals end the program at once.
    for (const int signal : {SIGINT, SIGTERM}) signals_.add(signal);
    ignore_what_need_not_end_it();
    spdlog::info("listening on {}", stream_.local_endpoint());
    if (web_) spdlog::info("answering at {}", web_->address());
    if (recorder_ && recorder_->status().error.empty()) spdlog::info("recording to {}", options_.record->string());
    if (animation_) spdlog::info("{} nodes at {} Hz", animation_->node_count(), rate_hz_);

    signals_.async_wait([this](const boost::system::error_code& error, int signal) {
      if (!error) end(signal == SIGINT ? "interrupted" : "terminated");
    });
    wait_for_hangup();
    if (options_.duration_s) {
      end_timer_.expires_after(from_seconds(*options_.duration_s));
      end_timer_.async_wait([this](const boost::system::error_code& error) {
        if (!error) end("the duration has elapsed");
      });
    }
    resume();
    next_wind_ = asio::steady_timer::clock_type::now();
    step_wind();
    send_status();
    try_again_later();
    if (long_history_) keep_means_later();
    if (loop_) {
      wait_for_frame();
      loop_->start();
    } else {
      is_up_ = true;
      report_ready();
    }

    while (!contain("a task of the I/O thread", [this] { io_.run(); })) {
    }

    // Readings until now are recorded, too.
    hub_.advance();
    if (recorder_) recorder_->close();
    log_summary();
    if (failure_) throw std::runtime_error(*failure_);
    return is_restart_;
  }

 private:
  stream::TcpStreamSettings stream_settings(const settings::Config& config) {
    stream::TcpStreamSettings settings;
    settings.hello = hello_;
    if (animation_) {
      settings.scenes = animation_->describe();
      animation::checked_scenes_message(settings.scenes);
    }
    settings.on_control = [this](const wire::Control& control, bool is_local) { return handle(control, is_local); };
    settings.on_reload = [this](const wire::ReloadCommand& command, bool is_local, const auto& reply) {
      request_reload(command, is_local, reply);
    };
    settings.on_parameters = [this](const wire::ParameterCommand& command, bool is_local, const auto& reply) {
      parameters_.handle(command, is_local, reply);
    };
    settings.raw_refusal = [this](bool is_local) {
      return daemon::settings::control_refusal(control_, is_local, "raw messages cannot be watched");
    };
    settings.trusts_this_machine = !takes_token_;
    if (takes_token_) {
      settings.is_token = [this](const std::string& given) {
        return !token_.is_empty() && web::Access(token_).is_token(given);
      };
    }
    settings.admission = admission_of(config.stream);
    return settings;
  }

  web::Settings web_settings() {
    web::Settings settings{.listen = http_.listen,
                           .hosts = http_.hosts,
                           .takes_token = takes_token_,
                           .token = token_,
                           .pairings_file = pairings_file(),
                           .reading_takes_token = http_.reading_takes_token,
                           .proxies = http_.proxies,
                           .origins = http_.origins,
                           .folder = http_.folder,
                           .archive = {.recording = options_.record.value_or(std::filesystem::path()),
                                       .least_free_bytes = least_free_bytes_,
                                       .configuration = options_.config_file,
                                       .stream = stream_.local_endpoint(),
                                       .page = settings::page_file(options_.config_file),
                                       .sensors = reload_.running().sensors},
                           .certificate = http_.certificate,
                           .key = http_.key,
                           .guide = web::installed_folder("guide"),
                           .viewer = web::installed_folder("wall"),
                           .hello = hello_};
    settings.hosts.push_back(asio::ip::host_name());
    settings.ask = [this](const wire::Control& control, bool is_local, std::function<void(wire::ControlReply)> reply) {
      asio::post(io_, [this, control, is_local, reply = std::move(reply)] {
        if (control.reload) return request_reload(*control.reload, is_local, reply);
        if (control.parameters) return parameters_.handle(*control.parameters, is_local, reply);
        reply(handle(control, is_local));
      });
    };
    if (history_) {
      settings.history = [this](unsigned hours, const history::Reader::Reply& reply) {
        (history::is_of_means(hours) ? long_history_ : history_)->ask(hours, reply);
      };
    }
    if (options_.can_be_restarted && !options_.config_file.empty()) {
      settings.archive.taking_over = {.restart = [this] { asio::post(io_, [this] { restart_soon(); }); },
                                      .reload = [this] { asio::post(io_, [this] { reload({}, {}); }); }};
    }
    settings.log = options_.log_tail;
    settings.faults = options_.fault_counter;
    return settings;
  }

  /// A replay beside the daemon does not write the daemon's file.
  std::filesystem::path pairings_file() const {
    if (!takes_token_ || options_.recorded_from) return {};
    return settings::state_file(options_.config_file, "pairings.json");
  }

  /// Empty where no service manager provides a folder: who starts the daemon by hand finds no new file beside his
  /// configuration. A recording that plays begins at rest: what it shows follows from the recording alone.
  static std::filesystem::path motion_file(const settings::Config& config, const Options& options) {
    const bool plays =
        std::ranges::any_of(config.sensors, [](const auto& sensor) { return sensor.driver->plays_recordings; });
    if (!config.animation.resumes || plays || options.recorded_from) return {};
    return settings::state_file({}, "motion.snapshot");
  }
  Motion motion() { return {hub_, shaper_, *animation_}; }
  void resume() {
    if (!animation_ || !resumption_.load(reload_.running(), motion(), clock_.now().mono)) return;
    director_.resume(*animation_->roster());
  }

  // ---- one wind for several daemons ----

  void join_company(const settings::Config& config) {
    follow::check_company(config);
    const Nanoseconds delay = from_seconds(config.wind.lead.delay_s);
    const double begun_s = std::max(0.0, seconds(started_.utc.time_since_epoch() - delay));
    led_.emplace(static_cast<std::uint64_t>(begun_s * rate_hz_), rate_hz_, delay);
    std::vector<std::uint8_t> state;
    animation_->save_state(state, started_.mono);
    company_.emplace(
        config, asio::ip::host_name(), state.size(), *led_, started_,
        [this] { asio::post(io_, [this] { take_from_company(); }); },
        follow::Follower::Listener{.loaded =
                                       [this](const std::vector<std::uint8_t>& shown) {
                                         loaded_at_ = clock_.now().mono;
                                         director_.note_shown(shown);
                                         parameters_.note_change();
                                       },
                                   .cued =
                                       [this](const animation::SceneCue& cue) {
                                         director_.note(cue);
                                         parameters_.note_change();
                                       }});
  }

  void report_to_company(const wire::Sensors& status) {
    const Instant now = clock_.now();
    if (now.mono < next_report_) return;
    next_report_ = now.mono + kReportInterval;
    wire::Sensors told = status;
    folders_.remove_from(told);
    company_->report({.name = {},
                      .software = {},
                      .part = {},
                      .wind_m_s = speed_of(status.wind.wind),
                      .wind_from_deg = wind::direction_from_deg(status.wind.wind),
                      .tick = 0,
                      .behind_s = 0.0,
                      .clock_offset_s = clock_watch_ ? clock_watch_->latest().offset_s : std::nullopt,
                      .attention = state::needs_attention(told)},
                     now);
  }

  void take_from_company() {
    contain("what came from other daemons", [this] {
      if (company_) company_->take(clock_.now());
    });
  }

  /// A leader's cues come with its ticks.
  bool send(const animation::SceneCue& cue) {
    if (company_ && company_->leads()) return company_->cue(cue);
    return loop_ && loop_->cue(cue);
  }

  /// The poses of all that are in its company are made from this. Then the leader's wind is the one that is shown here.
  void advance_company(wind::ground::DrivingWind& real, wind::ground::DrivingWind& driving) {
    if (!company_) return;
    const Nanoseconds late = std::chrono::steady_clock::now() - wind_due_;
    Instant now = clock_.now();
    now.mono -= late;
    now.utc -= late;
    company_->advance(driving, now, wind_periods_);
    if (const wind::ground::DrivingWind* const led = company_->wind()) real = driving = *led;
  }

  /// Reads what the daemon records itself; it owns all that it uses.
  static std::unique_ptr<history::Reader> make_history(const std::filesystem::path& file) {
    return std::make_unique<history::Reader>(
        [file](unsigned hours, const std::stop_token& stop) -> Result<std::string, Failure> {
          const auto history = history::read_wind_history(file, std::chrono::system_clock::now(), hours, stop);
          if (!history) return history.error();
          return {boost::system::in_place_value, history::history_json(*history)};
        });
  }

  // ---- the token and the page: if they fail at the start, they are tried again ----

  /// Reads the token, unless it is known. Returns true if it was not known before.
  bool read_token() {
    token_trouble_.clear();
    if (!takes_token_ || !token_.is_empty()) return false;
    auto token = platform::secret_in_file(http_.token_file);
    std::string why = token ? "" : token.error().message;
    if (token && token->reveal().size() < web::Access::kMinToken) why = "\"" + http_.token_file + "\" is too short";
    if (why.empty()) {
      token_ = std::move(*token);
      return true;
    }
    token_trouble_ = "[http] token_file: " + why +
                     "; until it can be read, all changes are refused. `yuragi token --new` makes a token";
    return false;
  }

  void open_page() {
    page_trouble_.clear();
    if (http_.listen.empty()) return;
    try {
      web_ = std::make_unique<web::Server>(web_settings());
      web_->publish_scenes(stream_.scenes());
    } catch (const FailureError& error) {
      page_trouble_ = "the page and HTTP are not served: " + std::string(error.what());
    }
  }

  std::vector<std::string> troubles() const {
    std::vector<std::string> all;
    for (const std::string* const trouble : {&token_trouble_, &page_trouble_}) {
      if (!trouble->empty()) all.push_back(*trouble);
    }
    return all;
  }

  /// Adds what was recorded to its means from time to time, also if no page is open: what is deleted later is in them.
  void keep_means_later() {
    means_timer_.expires_after(kMeansInterval);
    means_timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      contain("keeping the means of the recording",
              [this] { long_history_->ask(history::kMaxHistory_h, [](const Result<std::string, Failure>&) {}); });
      keep_means_later();
    });
  }

  void try_again_later() {
    if (troubles().empty()) return;
    again_timer_.expires_after(kTryAgainAfter);
    again_timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      contain("opening the page", [this] { try_again(); });
      try_again_later();
    });
  }

  void try_again() {
    if (read_token()) {
      spdlog::info("the token in {} is valid from now on", http_.token_file);
      if (web_) web_->set_token(token_);
    }
    if (page_trouble_.empty()) return;
    open_page();
    if (web_) spdlog::info("answering at {}", web_->address());
  }

  static stream::AdmissionLimits admission_of(const settings::StreamConfig& stream) {
    return {.max_clients = stream.max_clients, .max_clients_per_address = stream.max_clients_per_address};
  }

  // ---- reading the configuration again ----

  ReloadParts reload_parts(const settings::Config& config) {
    ReloadParts parts;
    parts.post = [this](std::function<void()> work) { asio::post(io_, std::move(work)); };
    if (options_.read_config) {
      parts.file = settings::absolute_path(options_.config_file);
      parts.read = [read = options_.read_config, running = std::make_shared<const settings::Config>(config)] {
        settings::Config wanted = read();
        check_restart(*running, wanted);
        return wanted;
      };
      parts.rehearse = options_.rehearse;
    }
    parts.apply = [this](const settings::ReloadPlan& plan) { apply(plan); };
    parts.apply_edits = [this](const settings::ReloadPlan& plan) { show_look(plan.next.look); };
    if (options_.with_scenes) {
      parts.make_scenes = [this](const settings::Config& next, const auto&) -> ReloadParts::Adopt {
        auto change = std::make_shared<std::unique_ptr<animation::SceneChange>>(
            animation::make_scene_change(*scenes_->present(), next));
        return [this, change] {
          hub_.set_reach((*change)->reach_m);
          next_scenes_ = std::move(*change);
          exchange_scenes();
        };
      };
      parts.is_settling = [this] { return next_scenes_ || scenes_->is_changing(); };
    }
    return parts;
  }

  void wait_for_hangup() {
    hangups_.signals.async_wait([this](const boost::system::error_code& error, int) {
      if (error) return;
      if (terminal_.is_closed()) return end("its terminal was closed");
      spdlog::info("reload: asked by SIGHUP");
      contain("a reload", [this] { reload({}, {}); });
      wait_for_hangup();
    });
  }

  void request_reload(const wire::ReloadCommand& command, bool is_local,
                      const std::function<void(const wire::ControlReply&)>& reply) {
    const auto answer = [is_local, reply](const wire::ReloadReport& report) {
      const wire::ReloadReport told = is_local ? report : without_folders(report);
      reply({.done = told.outcome == wire::ReloadOutcome::kDone,
             .message = summary_of(told),
             .scenes = {},
             .players = {},
             .reload = told});
    };
    if (auto why = settings::control_refusal(control_, is_local, "the configuration cannot be read again")) {
      return answer({.outcome = wire::ReloadOutcome::kNotAllowed, .mistakes = {std::move(*why)}});
    }
    reload(command.file, answer);
  }

  void reload(const std::string& expected_file, Reload::Reply reply) {
    if (web_) web_->renew_certificate();
    reload_.request(expected_file, std::move(reply));
    if (reload_.is_under_way()) manager_.report_reloading();
  }

  /// Passes waiting scenes to the animation, unless too many cues wait; then with the next frame. The replaced scenes
  /// are freed once they have faded out.
  void exchange_scenes() {
    const bool is_settling = loaded_at_ && clock_.now().mono - *loaded_at_ < kSettled;
    if (next_scenes_ && !is_settling && scenes_->begin(next_scenes_)) parameters_.note_change();
    if (scenes_->take_finished()) reload_.go_on();
  }

  /// All at once, between two steps of the wind.
  void apply(const settings::ReloadPlan& plan) {
    const settings::Config& next = plan.next;
    page_file_trouble_ = next.page_trouble;
    hub_.change(next);
    if (company_) company_->change(next, clock_.now());
    if (plan.changes_shaping) shaper_.change(next.shaping);
    cameras_ = cameras_of(next);
    clock_of_cameras_ = next.clock;
    control_ = next.stream.control;
    director_.allow(control_);
    players_.allow(control_);
    hand_.allow(control_);
    hand_.set_cameras(names_of(cameras_));
    parameters_.allow(control_);
    show_look(next.look);
    if (alerts_) alerts_->change(next.alerts);
    moments_.change(next.shaping);
    if (plan.changes_feeds) {
      moments_.change(next.feeds);
      feeds_->change(next.feeds);
    }
    stream_.set_admission(admission_of(next.stream));
    if (options_.set_log_level) options_.set_log_level(next.log.level);
    if (recorder_) recorder_->begin_session(recording_info(next, clock_.now()), next.recording);
  }

  /// Viewers need not wait for the next status.
  void show_look(const look::Look& look) {
    look_ = look;
    parameters_.note_change();
    publish_status();
  }

  wire::ControlReply handle(const wire::Control& control, bool is_local) {
    wire::ControlReply reply = carry_out(control, is_local);
    if (!is_local) folders_.remove_from(reply);
    return reply;
  }

  wire::ControlReply carry_out(const wire::Control& control, bool is_local) {
    if (control.player) return players_.handle(*control.player, is_local);
    if (animation_ && control.hand) return set_by_hand(*control.hand, is_local);
    if (animation_) {
      if (!control.scene.empty() && is_led()) return {.done = false, .message = std::string(kLedRefusal), .scenes = {}};
      if (!control.scene.empty()) parameters_.note_change();
      return director_.handle(control, is_local);
    }
    return {.done = false, .message = "this daemon has no scenes", .scenes = {}};
  }

  bool is_led() const { return company_ && company_->is_led(clock_.now().mono); }

  /// Viewers need not wait for the next status. Who it was is logged by the stream or by web.
  wire::ControlReply set_by_hand(const wire::HandCommand& command, bool is_local) {
    wire::ControlReply reply = hand_.handle(command, is_local, clock_.now().mono);
    if (command.part == wire::HandPart::kReport || !reply.done) return reply;
    spdlog::info("by hand: {}", reply.message);
    publish_status();
    return reply;
  }

  /// Feeds show and hide scenes by a right of their own.
  feeds::Surroundings surroundings() {
    return {.page_url = web_ ? page_url(*web_) : std::string(),
            .page_listen = http_.listen,
            .show_scene = [this](const std::string& scene, bool shown) {
              asio::post(io_, [this, scene, shown] { show_scene({.scene = scene, .shown = shown}); });
            }};
  }

  void show_scene(const wire::Control& control) {
    if (!animation_) return;
    if (is_led()) return spdlog::warn("a feed's command: {}", kLedRefusal);
    parameters_.note_change();
    const wire::ControlReply reply = director_.handle_permitted(control);
    if (!reply.done) spdlog::warn("a feed's command: {}", reply.message);
  }

  std::unique_ptr<recording::Recorder> make_recorder(const settings::Config& config,
                                                     const std::filesystem::path& file) const;
  static recording::Info recording_info(const settings::Config& config, Instant started);

  sensing::SensorHub::Listener listener() {
    if (!options_.record) return {};
    return [this](std::size_t sensor, const wind::Reading& reading) { recorder_->push(sensor, reading); };
  }

  /// Takes readings and advances the wind.
  wind::ground::DrivingWind next_real_wind() { return {hub_.advance(), hub_.ground(), hub_.stroke()}; }

  wind::ground::DrivingWind shaped(wind::ground::DrivingWind wind) {
    shaper_.shape(wind, time_for_the_hours(), hub_.is_any_live(), hand_.shaping(clock_.now().mono));
    return wind;
  }

  /// Gives the animation the next wind, and other programs what they get of it.
  void advance_wind() {
    wind::ground::DrivingWind real = next_real_wind();
    wind::ground::DrivingWind driving = shaped(real);
    wind_.publish(driving);
    contain("the wind for other daemons", [&] { advance_company(real, driving); });
    contain("what other programs get of the wind", [&] {
      const auto moment = moments_.make(real, driving, shaper_.report(), clock_.now(), hub_.values());
      feeds_->publish(moment);
      if (web_) web_->publish_moment(moment);
    });
    hub_.trace([this](std::string_view sensor) { return stream_.wants_trace(sensor); });
    hub_.drain_traces([this](const wire::RawTrace& trace) { stream_.publish_trace(trace); });
    manager_.went_round(clock_.now().mono, loop_ ? loop_->counters().ticks.load(std::memory_order_relaxed) : 0);
    if (options_.end_with_recordings && hub_.is_finished()) end("the recording has ended");
  }

  /// Advances the wind at the rate of the animation.
  void step_wind() {
    wind_due_ = next_wind_;
    contain("a step of the wind", [this] { advance_wind(); });

    // Steps are at fixed times; those missed while the machine was halted are skipped.
    const auto period = from_seconds(1.0 / rate_hz_);
    next_wind_ = std::max(next_wind_ + period, asio::steady_timer::clock_type::now() - period);
    wind_periods_ = static_cast<std::uint32_t>(std::clamp<std::int64_t>(
        std::llround(seconds(next_wind_ - wind_due_) * rate_hz_), 1, wire::lead::kMaxTickPeriods));
    wind_timer_.expires_at(next_wind_);
    wind_timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      io_lateness_.add(asio::steady_timer::clock_type::now() - next_wind_);
      step_wind();
    });
  }

  UtcTime time_for_the_hours() const {
    if (!options_.recorded_from) return clock_.now().utc;
    return players_.recorded_clock().value_or(*options_.recorded_from);
  }

  void wait_for_frame() {
    frame_ready_.async_read_some(asio::buffer(&frames_made_, sizeof frames_made_),
                                 [this](const boost::system::error_code& error, std::size_t) {
                                   if (error) return;
                                   contain("passing on a frame", [this] { pass_on_frame(); });
                                   if (const auto why = loop_->failure()) return end_with_failure(*why);
                                   wait_for_frame();
                                 });
  }

  void pass_on_frame() {
    const animation::PublishedFrame* frame = loop_->take_frame();
    if (frame == nullptr) return;
    if (const auto scenes = scenes_->new_scenes(frame->generation)) {
      stream_.publish_scenes(scenes);
      if (web_) web_->publish_scenes(scenes);
    }
    const auto bytes = std::make_shared<const wire::Bytes>(frame->bytes);
    stream_.publish(bytes);
    if (web_) web_->publish(bytes);
    moments_.note_frame(*frame, *scenes_);
    exchange_scenes();
    is_up_ = true;
    report_ready();
  }

  /// At first, and again after each reload.
  void report_ready() {
    if (is_up_ && !reload_.is_under_way()) manager_.report_ready();
  }

  void send_status() {
    contain("giving up a reload", [this] { reload_.give_up_late(clock_.now().mono); });
    contain("the status", [this] {
      const wire::Sensors status = publish_status();
      manager_.report_status(status);
      if (company_) report_to_company(status);
      report_ready();
      if (alerts_) alerts_->judge(status, ticks_made(), clock_.now());
      if (feeds_ && !feeds_->is_empty()) {
        moments_.set_health({.alerts = alerts_ ? alerts_->states() : std::vector<values::AlertState>(),
                             .needs_attention = !state::needs_attention(status).empty()});
      }
    });

    status_timer_.expires_after(kStatusInterval);
    status_timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) send_status();
    });
  }

  std::optional<std::uint64_t> ticks_made() const {
    if (!loop_) return std::nullopt;
    return loop_->counters().ticks.load(std::memory_order_relaxed);
  }

  /// Returns the status for clients of this machine.
  wire::Sensors publish_status() {
    wire::Sensors status;
    status.sensors = hub_.status();
    status.wind = hub_.wind();
    if (const wind::ground::DrivingWind* const led = company_ ? company_->wind() : nullptr) status.wind = led->state;
    status.gust_reach_across = hub_.gust_reach().across();
    status.gust_reach_along = hub_.gust_reach().along();
    status.shaping = shaper_.status();
    status.look = look_;
    status.cameras = cameras_;
    for (const std::string& ended : hand_.take_ended(clock_.now().mono)) spdlog::info("by hand: {}", ended);
    status.by_hand = hand_.status(clock_.now().mono);
    if (const std::string text = by_hand_text(status.by_hand); !text.empty())
      status.shaping.text = status.shaping.text.empty() ? text : text + "; " + status.shaping.text;
    status.camera = hand_.camera(clock_.now().mono)
                        .value_or(look::camera_at(cameras_, clock_of_cameras_.hour_of_day(clock_.now().utc)));
    status.parameters_revision = parameters_.revision();
    status.late_ticks = loop_ ? loop_->counters().skipped_ticks.load(std::memory_order_relaxed) : 0;
    status.clients = static_cast<std::uint32_t>(stream_.client_count());
    const stream::ClientCounts& counts = stream_.counts();
    status.given_up = stream_.given_up();
    status.refused_clients = counts.refused;
    status.stuck_clients = counts.stuck;
    status.idle_clients = counts.idle;
    const MonoTime now = clock_.now().mono;
    recent_io_lateness_.advance(now);
    status.io_lateness = lateness_of(recent_io_lateness_);
    if (loop_) {
      recent_tick_lateness_->advance(now);
      status.tick_lateness = lateness_of(*recent_tick_lateness_);
      status.recent_ticks = recent_tick_lateness_->count();
      status.recent_skipped_ticks = status.late_ticks - skipped_before_.begin_at(now, status.late_ticks);
      status.animation = animation_status();
    }
    if (recorder_) status.recorder = to_wire(recorder_->status());
    status.troubles = troubles();
    if (auto trouble = web_ ? web_->certificate_trouble() : std::nullopt)
      status.troubles.push_back(std::move(*trouble));
    if (!page_file_trouble_.empty())
      status.troubles.push_back("what the page has set up is left out: " + page_file_trouble_);
    if (clock_watch_) {
      if (std::string trouble = state::clock_trouble(clock_watch_->latest()); !trouble.empty())
        status.troubles.push_back(std::move(trouble));
    }
    if (const auto worst = stream_.worst_clock()) {
      if (std::string trouble = state::clock_trouble_of_viewer(worst->client, worst->offset_s); !trouble.empty())
        status.troubles.push_back(std::move(trouble));
    }
    for (const feeds::Status& feed : feeds_->status()) status.feeds.push_back(to_wire(feed, now));
    if (company_) {
      const follow::Company::Status company = company_->status(now);
      status.feeds.push_back(to_wire(as_feed(company), now));
      if (web_)
        web_->publish_fleet(company_->leads() ? std::make_shared<const std::string>(follow::nodes_text(company.fleet))
                                              : nullptr);
      status.troubles.insert(status.troubles.end(), company.nodes.begin(), company.nodes.end());
    }
    const auto here = std::make_shared<const wire::Bytes>(wire::encode(status));
    stream::SharedBytes elsewhere;
    if (stream_.has_untrusted_clients() || (web_ && web_->has_untrusted_clients())) {
      wire::Sensors told = status;
      folders_.remove_from(told);
      elsewhere = std::make_shared<const wire::Bytes>(wire::encode(told));
    }
    stream_.publish_sensors(here, elsewhere);
    if (web_) web_->publish_sensors(here, elsewhere);
    return status;
  }

  wire::AnimationStatus animation_status() const {
    const animation::LoopCounters& counters = loop_->counters();
    const std::uint64_t ticks =
        counters.ticks.load(std::memory_order_relaxed) + counters.skipped_ticks.load(std::memory_order_relaxed);
    wire::AnimationStatus status{.running_s = static_cast<double>(ticks) / rate_hz_,
                                 .period_s = 1.0 / rate_hz_,
                                 .tick_s = counters.tick_time.mean_s(),
                                 .scenes = {}};
    const animation::SceneRoster& roster = *scenes_->present();
    for (std::size_t i = 0; i < roster.scenes.size(); ++i)
      status.scenes.push_back({roster.configs[i].name, roster.scenes[i]->step_time.mean_s()});
    return status;
  }

  void log_summary() const;

  /// The scenes do not move any more: the service manager restarts the daemon.
  void end_with_failure(const std::string& why) {
    failure_ = "the animation has failed (" + why + ")";
    spdlog::critical("{}: a fault of this program; it ends, so that it is started again", *failure_);
    end("the animation has failed");
  }

  /// For what the page has set up, once its answer is on its way.
  void restart_soon() {
    restart_timer_.expires_after(kRestartAfter);
    restart_timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      is_restart_ = true;
      manager_.report_restarting();
      end("the page has changed the sensors: it is started again");
    });
  }

  void end(const char* why) {
    spdlog::info("ending: {}", why);
    if (!is_restart_) manager_.report_stopping(why);
    if (loop_) loop_->stop();
    if (animation_ && !failure_) resumption_.save(reload_.running(), motion());
    stream_.close();
    if (web_) web_->close();
    feeds_.reset();
    company_.reset();
    signals_.cancel();
    hangups_.signals.cancel();
    end_timer_.cancel();
    restart_timer_.cancel();
    wind_timer_.cancel();
    status_timer_.cancel();
    again_timer_.cancel();
    means_timer_.cancel();
    frame_ready_.close();
    io_.stop();
  }

  Options options_;
  double rate_hz_;
  wire::Hello hello_;
  sensing::HeldClock clock_;
  const Instant started_ = clock_.now();
  asio::io_context io_{1};
  asio::signal_set signals_{io_};
  Hangups hangups_{io_};
  Terminal terminal_;
  asio::steady_timer end_timer_{io_}, restart_timer_{io_}, wind_timer_{io_}, status_timer_{io_}, again_timer_{io_},
      means_timer_{io_};
  asio::steady_timer::time_point next_wind_;
  std::chrono::steady_clock::time_point wind_due_ = std::chrono::steady_clock::now();  ///< of the present step
  std::uint32_t wind_periods_ = 1;                                                     ///< that the next step takes
  animation::DurationHistogram io_lateness_;                                           ///< of each step of the wind
  animation::RecentLateness recent_io_lateness_{io_lateness_};
  std::optional<animation::RecentLateness> recent_tick_lateness_;  ///< nullopt: no scenes
  animation::RecentWindow<std::uint64_t> skipped_before_;
  asio::posix::stream_descriptor frame_ready_{io_};
  std::uint64_t frames_made_ = 0;
  bool is_restart_ = false;             ///< it ends to be started again
  std::optional<std::string> failure_;  ///< why it ends although nobody asked it to

  settings::HttpConfig http_;
  std::uint64_t least_free_bytes_;
  std::string page_file_trouble_;  ///< empty: none
  const bool takes_token_ = !http_.token_file.empty();
  Secret token_;                              ///< empty: there is none, or it cannot be read
  std::string token_trouble_, page_trouble_;  ///< empty: none

  // In this order, so that a second daemon fails at the used address before it opens a sensor. The recording is opened
  // last, once nothing else can fail: a start that fails writes nothing into it.
  std::shared_ptr<const wind::turbulence::GustNoise> gusts_;
  std::unique_ptr<animation::Animation> animation_;
  animation::SceneDirector director_;
  stream::TcpStream stream_;
  sensing::SensorHub hub_;
  shaping::WindShaper shaper_;
  MomentSource moments_;
  std::optional<feeds::Feeds> feeds_;
  look::Look look_;                    // for the viewers
  std::vector<look::Camera> cameras_;  // for them, too
  settings::LocalClock clock_of_cameras_;
  sensing::PlayerDirector players_;
  sensing::RecordingFolders folders_;
  HandDirector hand_;
  Latest<wind::ground::DrivingWind> wind_;
  std::optional<animation::LedSteps> led_;  ///< nullopt: its ticks are its own
  std::unique_ptr<animation::Loop> loop_;
  std::unique_ptr<animation::SceneExchange> scenes_;
  std::unique_ptr<animation::SceneChange> next_scenes_;  ///< of a reload, not yet the animation's
  std::unique_ptr<recording::Recorder> recorder_;
  /// Null: not recorded. The second reads what is_of_means(): so the first time, which is long, delays no other.
  std::unique_ptr<history::Reader> history_, long_history_;
  std::unique_ptr<web::Server> web_;                 ///< null: no [http] listen
  std::optional<platform::ClockWatch> clock_watch_;  ///< if screens are in step by this machine's clock
  std::optional<alerts::Alerts> alerts_;             ///< nullopt: no alerts
  Manager manager_{options_.with_scenes};
  MonoTime next_report_{};
  std::optional<MonoTime> loaded_at_;       ///< a leader's state
  std::optional<follow::Company> company_;  ///< nullopt: it neither leads nor follows
  bool is_up_ = false;                      ///< it has begun, with its first frame if it has scenes

  settings::ControlPermission control_;
  Reload reload_;  ///< it uses all of the above
  Resumption resumption_;
  ParameterDirector parameters_;
};

std::unique_ptr<recording::Recorder> Service::Io::make_recorder(const settings::Config& config,
                                                                const std::filesystem::path& file) const {
  return std::make_unique<recording::Recorder>(
      file, recording_info(config, started_), [](std::string_view news) { spdlog::warn("recording: {}", news); },
      recording::RecorderLimits{}, config.recording, recording::kSynchronizedFile,
      // A wall runs without a recording; a program that only records has no other purpose.
      options_.with_scenes ? recording::RecorderStart::kRetries : recording::RecorderStart::kMustOpen);
}

recording::Info Service::Io::recording_info(const settings::Config& config, Instant started) {
  recording::Info info{.started = started,
                       .software = with_version("yuragi"),
                       .configuration = settings::to_recorded_toml(config),
                       .sensors = {}};
  for (const settings::SensorConfig& sensor : config.sensors) {
    info.sensors.push_back({sensor.name, std::string(sensor.driver->name), settings::to_toml(sensor.values)});
  }
  return info;
}

void Service::Io::log_summary() const {
  hub_.log_summary();
  if (recorder_) {
    const recording::RecorderStatus status = recorder_->status();
    spdlog::info("recorded {}, lost {}", count_text(status.written, "reading"), status.lost);
    if (status.recorded_elsewhere > 0)
      spdlog::info("{} recorded by another process", count_text(status.recorded_elsewhere, "reading"));
  }
  if (!loop_) return;
  const animation::LoopCounters& counters = loop_->counters();
  spdlog::info("{} ticks, {} skipped; lateness p50 {:.3f} ms, p99 {:.3f} ms; work p50 {:.3f} ms, p99 {:.3f} ms",
               counters.ticks.load(), counters.skipped_ticks.load(), 1e3 * counters.lateness.percentile_s(0.5),
               1e3 * counters.lateness.percentile_s(0.99), 1e3 * counters.work.percentile_s(0.5),
               1e3 * counters.work.percentile_s(0.99));
}

Service::Service(const settings::Config& config, const Options& options)
    : io_(std::make_unique<Io>(sensing::with_recorded_sources(config), options)) {}
Service::~Service() = default;
bool Service::run() {
  return io_->run();
}

}  // namespace yuragi::daemon::service
