#include "viewer/app/viewer.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "engine/base/address.hpp"
#include "engine/platform/clock_watch.hpp"
#include "viewer/app/overlay.hpp"
#include "viewer/app/own_token.hpp"
#include "viewer/app/panel.hpp"
#include "viewer/app/paused_moment.hpp"
#include "viewer/app/swap_log.hpp"
#include "viewer/app/watchdog.hpp"
#include "viewer/app/window.hpp"
#include "viewer/gl/dimmer.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/pace/pace_keeper.hpp"
#include "viewer/pace/pace_ladder.hpp"
#include "viewer/pace/quality.hpp"
#include "viewer/picture/gl_renderer.hpp"
#include "viewer/picture/headless.hpp"
#include "viewer/picture/picture_director.hpp"
#include "viewer/picture/picture_file.hpp"
#include "viewer/picture/viewer_exit.hpp"
#include "viewer/stream/picture_age.hpp"
#include "viewer/stream/scene_timeline.hpp"
#include "viewer/stream/stream_connection.hpp"
#include "viewer/stream/stream_notice.hpp"
#include "viewer/wall/outputs_file.hpp"
#include "viewer/wall/test_card.hpp"
#include "viewer/wall/wall.hpp"

namespace yuragi::viewer::app {
namespace {

constexpr double kIdleWait_s = 0.1;     // while there is nothing to draw on
constexpr double kBlackWait_s = 0.05;   // between two checks for news while the picture is black
constexpr double kBlackAgain_s = 0.5;   // a monitor that has returned is black soon
constexpr double kDarkest = 1.0 / 512;  // less than a step of a pixel's value
constexpr double kLookWait_s = 1.0;     // to wait for the daemon's first status, which has its look
constexpr int kOverlayPictures = 2;     // the overlay's size is known after the first
constexpr int kSamples = 4;             // a pixel
constexpr double kRateSmoothing = 0.05;
constexpr double kHandFade_s = 0.3;  // fade of the light while a person moves a handle of the panel
constexpr double kAgeLogInterval_s = stream::PictureAge::kSpan_s;
constexpr double kDoubtLogInterval_s = 60.0;
constexpr double kClockLogInterval_s = 600.0;
constexpr int kMeasuredEvery = 3;   // pictures of a graphics card: to wait for one costs a little
constexpr double kDimming_s = 0.5;  // the brightness continues for this long between two of the daemon's statuses

double now_s() {
  return seconds(std::chrono::steady_clock::now().time_since_epoch());
}

/// Since 1970, at a moment of now_s(). The later of two readings: a thread that the system stops between the two clocks
/// reads too early a time.
double utc_at(double moment_s) {
  const auto zero_s = [] { return seconds(std::chrono::system_clock::now().time_since_epoch()) - now_s(); };
  const double first_s = zero_s();
  return moment_s + std::max(first_s, zero_s());
}

stream::Options address_of(const picture::ViewerOptions& options) {
  const auto address = parse_address(options.connect, wire::kDefaultPort);
  if (!address) throw picture::ViewerExit(EX_USAGE, "--connect: " + address.error().message);
  if (address->port == 0) throw picture::ViewerExit(EX_USAGE, "--connect: port 0 cannot be connected to");
  return {.host = address->host, .port = address->port, .token = own_token()};
}

/// The outputs of the configuration; nullopt without one.
std::optional<output::Output> output_of(const picture::ViewerOptions& options) {
  if (options.config.empty()) return std::nullopt;
  return wall::load_output(options.config, options.output);
}

}  // namespace

class Viewer::Show {
 public:
  Show(const picture::ViewerOptions& options, const std::atomic<bool>& is_stopping)
      : options_(options),
        is_stopping_(is_stopping),
        connection_(address_of(options)),
        output_(output_of(options)),
        timeline_(output_ ? output_->delay_s : std::nullopt),
        began_s_(now_s()),
        last_s_(began_s_),
        brightness_(options.is_dark_when_closed || output_ ? 0.0 : 1.0),
        has_overlay_(options.overlay.value_or(options.screenshot.empty() && !output_)),
        has_panel_(options.has_panel) {
    std::unique_ptr<gl::HeadlessContext> context;
    if (options.screenshot.empty()) {
      window_.emplace(WindowOptions{.width_px = options.width_px,
                                    .height_px = options.height_px,
                                    .is_fullscreen = options.is_fullscreen,
                                    .monitor = options.monitor,
                                    .is_hidden = output_.has_value()});
      if (output_) wall_.emplace(window_->handle(), *output_);
    } else {
      context = picture::make_headless_context();
    }
#ifdef YURAGI_GL_DEBUG
    gl::report_gl_errors();
#endif
    is_software_ = gl::is_software_renderer();
    const bool is_slow = is_software_ && window_;
    renderer_.emplace(std::move(context), options.width_px, options.height_px,
                      options.samples.value_or(is_slow ? 1 : kSamples));
    const look::Quality first_quality = pace::quality_for(look::Quality::kAuto, is_software_);
    renderer_->set_own_quality(first_quality);
    if (window_) {
      const pace::Ladder ladder(look::Quality::kAuto, display_interval_s());
      pace_.emplace(ladder, is_software_ ? ladder.slowest_of(first_quality) : 0);
    }
    if (output_ && output_->screen) see_through(*output_->screen);
    director_.emplace(options_, *renderer_, options_.connect);
    dimmer_.emplace();
    if (options.has_test_card) test_card_.emplace();
    if (timeline_.fixed_delay() || options.logs_age)
      clock_watch_.emplace([] { return std::chrono::system_clock::now(); });
    if (!options.swaps.empty()) swap_log_.emplace(options.swaps);
    overlay_.emplace(window_ ? window_->handle() : nullptr);
    pass_clock_.emplace(is_software_ ? gl::PassClock::By::kProcessor : gl::PassClock::By::kGpu);
    const auto is_shown = [&](const char* panel) {
      return std::ranges::find(options.shown, panel) != options.shown.end();
    };
    has_help_ = is_shown("help");
    has_wind_ = is_shown("wind");
    if (is_shown("profiler")) toggle_profiler();
  }

  void run_window() {
    while (!is_stopping_ && !window_->is_closing()) {
      watchdog_.went_round(now_s());
      window_->poll();
      use_input();
      if (wall_) wall_->follow_monitors(now_s());
      advance();
      const PixelSize size = size_to_show();
      if (size.is_empty()) {
        window_->wait(kIdleWait_s);
        continue;
      }
      const bool is_black = is_picture_black();
      if (is_black && last_s_ < black_until_s_ && size == black_size_) {
        window_->wait(kBlackWait_s);
        continue;
      }
      black_until_s_ = is_black ? last_s_ + kBlackAgain_s : 0.0;
      black_size_ = size;
      const std::size_t compiled = gl::compiled_shaders();
      is_black ? draw_black(size) : draw(size);
      const bool is_usual = !is_black && !test_card_ && compiled == gl::compiled_shaders() && !is_in_transition();
      std::optional<double> work_s = is_usual && !is_software_ ? work_of_graphics_card_s() : std::nullopt;
      show(size);
      if (!is_black) log_swap();
      note_age(display_interval_s());
      if (gl::is_context_lost())
        throw picture::ViewerExit(EX_TEMPFAIL, "the graphics card was reset; start the viewer again");
      // If the processor draws, the picture is complete at this point.
      if (is_usual && is_software_) work_s = now_s() - last_s_;
      choose_pace(size, work_s);
      keep_pace();
    }
  }

  /// At the end.
  void log_last_age() {
    if (options_.logs_age) log_age();
  }

  void run_screenshot() {
    // Draws a picture for each arrival; with --at only those from that moment on.
    const PixelSize size{options_.width_px, options_.height_px};
    double first_pose_s = 0.0;
    int drawn = 0;
    if (options_.has_test_card) return draw_to_file(size);
    while (!is_stopping_) {
      connection_.wait_for_news(from_seconds(kIdleWait_s));
      advance();
      if (timeline_.playback() == stream::Playback::kNothing) {
        if (last_s_ - began_s_ > options_.wait_s) throw_no_daemon();
        continue;
      }
      if (first_pose_s == 0.0) first_pose_s = last_s_;
      if (!sensors_ && last_s_ - first_pose_s < longest_wait_for_status_s()) continue;
      director_->require_camera();
      if (options_.at_s && last_s_ - first_pose_s < *options_.at_s) continue;
      ++drawn;
      if (drawn >= (options_.at_s ? kOverlayPictures : options_.frames)) return draw_to_file(size);
      draw(size);
      note_age(0.0);
    }
  }

 private:
  void draw_to_file(const PixelSize& size) {
    draw(size);
    note_age(0.0);
    picture::write_picture(options_.screenshot, size.width_px, size.height_px, renderer_->read_rgb());
  }

  /// Returns an empty size if there is no monitor to show it on.
  PixelSize size_to_show() const {
    if (!wall_) return window_->framebuffer_size();
    const output::Size size = wall_->picture_size();
    return wall_->is_dark() ? PixelSize{} : PixelSize{.width_px = size.width_px, .height_px = size.height_px};
  }

  /// A black picture is not drawn. News is checked often enough that a new light, which fades in slowly, is not late.
  bool is_picture_black() const {
    return brightness_ == 0.0 && wanted_brightness() == 0.0 && !has_something_over() && !test_card_;
  }
  void draw_black(const PixelSize& size) {
    renderer_->resize(size.width_px, size.height_px);
    renderer_->target().bind_resolved();
    dimmer_->draw(0.0F);
  }

  void show(const PixelSize& size) {
    if (wall_) return wall_->show(renderer_->target(), options_.has_test_card);
    renderer_->target().show(size.width_px, size.height_px);
    window_->swap();
  }

  [[noreturn]] void throw_no_daemon() const {
    throw picture::ViewerExit(EX_UNAVAILABLE,
                              "no pose was received from " + options_.connect + " (" + connection_.status().text +
                                  ").\nStart a daemon with `yuragi run`, or give its address with --connect "
                                  "HOST:PORT, or wait longer with --wait SECONDS.");
  }

  /// A camera that was requested by its name must be received first.
  double longest_wait_for_status_s() const {
    return director_->is_camera_named() ? std::max(options_.wait_s, kLookWait_s) : kLookWait_s;
  }

  void see_through(const output::Screen& screen) {
    const auto place = [](const output::RoomPlace& of) { return glm::dvec3(of[0], of[1], of[2]); };
    renderer_->see_through(meshes::frustum_through(place(screen.lower_left_m), place(screen.lower_right_m),
                                                   place(screen.upper_left_m), place(screen.eye_m)));
  }

  /// Logs a change of the quality.
  void log_quality() {
    pace::Step step = pace_ ? pace_->step() : pace::Step{};
    step.quality = renderer_->quality();
    if (step == logged_step_) return;
    const std::string text = pace::quality_text(step.quality, step.part, step.refreshes);
    std::string reason;
    if (pace_ && pace_->is_held()) {
      reason = " (as another part of the wall)";
    } else if (pace_ && pace_->median_s() > 0.0) {
      reason = fmt::format(" (a picture took {:.0f} ms, and there are now {:.0f} for it)", 1e3 * pace_->median_s(),
                           1e3 * pace_->picture_s());
    }
    std::fprintf(stderr, "yuragi-viewer: %s%s\n", text.c_str(), reason.c_str());
    logged_step_ = step;
  }

  /// Returns true while two pictures are mixed for some seconds: of two cameras, or of scenes that fade.
  bool is_in_transition() const {
    return director_->is_fading() ||
           std::ranges::any_of(moment_->opacities, [](float opacity) { return opacity > 0.0F && opacity < 1.0F; });
  }

  /// How long it has worked at the picture that was begun at last_s_; null for most, for the card is waited for.
  std::optional<double> work_of_graphics_card_s() {
    if (++measured_pictures_ % kMeasuredEvery != 0) return std::nullopt;
    glFinish();
    return now_s() - last_s_;
  }

  /// All parts of a wall, whose viewers may run on several machines, are drawn at the quality of the slowest: the
  /// daemon passes on what each omits. It reports a clock that puts a screen out of step.
  void agree_with_wall() {
    pace_->hold(sensors_->given_up);
    wire::Display own{.given_up = pace_->given_up()};
    if (timeline_.fixed_delay()) own.clock_offset_s = clock_watch_->latest().offset_s;
    if (own == sent_display_ && own.given_up <= sensors_->given_up) return;
    connection_.send(own);
    sent_display_ = own;
  }

  /// How much is drawn of the next picture, after one of this size.
  void choose_pace(const PixelSize& size, std::optional<double> work_s) {
    pace_->set_ladder(pace::Ladder(renderer_->wanted_quality(), display_interval_s()));
    if (size != paced_size_) pace_->settle();
    paced_size_ = size;
    pace_->advance(picture_passed_s_, work_s);
    renderer_->set_own_quality(pace_->step().quality);
  }

  void use_input() {
    const WindowInput input = window_->take_input();
    if (input.moves_camera()) {
      meshes::OrbitCamera& camera = director_->take_camera();
      camera.orbit(input.orbit_right, input.orbit_down);
      camera.pan(input.pan_right, input.pan_down, renderer_->aspect());
      camera.zoom(input.zoom_notches);
    }
    for (const Key& key : input.keys) use_key(key);
    window_->set_taken(has_something_over() && overlay_->takes_mouse(), has_panel_ && overlay_->takes_keys());
  }

  void toggle_profiler() {
    has_profiler_ = !has_profiler_;
    renderer_->stage().mark_passes_for(has_profiler_ ? &*pass_clock_ : nullptr);
  }

  void use_key(const Key& key) {
    switch (key.action) {
      case Action::kHelp:
        has_help_ = !has_help_;
        break;
      case Action::kInfo:
        has_overlay_ = !has_overlay_;
        break;
      case Action::kProfiler:
        toggle_profiler();
        break;
      case Action::kWind:
        has_wind_ = !has_wind_;
        break;
      case Action::kFullScreen:
        window_->toggle_fullscreen();
        break;
      case Action::kPause:
        paused_.toggle();
        break;
      case Action::kHomeCamera:
        director_->show_home();
        break;
      case Action::kCamera:
        director_->show_camera(static_cast<std::size_t>(key.number));
        break;
      case Action::kNextCamera:
        director_->show_next_camera();
        break;
      case Action::kFirstCamera:
        director_->reset_camera();
        break;
      case Action::kTurning: {
        meshes::OrbitCamera& camera = director_->take_camera();
        camera.set_turning(!camera.is_turning());
        break;
      }
      case Action::kNextScene:
        renderer_->stage().show_next();
        pace_->settle();
        director_->frame_scenes(renderer_->stage().shows_all());
        break;
      case Action::kNextQuality:
        director_->show_next_quality(renderer_->quality());
        break;
      case Action::kPanel:
        has_panel_ = !has_panel_;
        break;
      case Action::kClose:
        window_->close();
        break;
    }
  }

  /// Takes what was received, and advances to now.
  void advance() {
    stream::Inbox inbox = connection_.take();
    if (inbox.wind_from_deg) {  // a new connection
      director_->set_wind_from(*inbox.wind_from_deg);
      sent_display_ = {};
    }
    if (inbox.scenes) timeline_.set_scenes(std::move(*inbox.scenes));
    const bool is_same_machine = connection_.status().is_same_machine;
    for (stream::TimedFrame& timed : inbox.frames) {
      const double arrival_s = seconds(timed.arrival.time_since_epoch());
      age_.take_frame(timed.frame.info, arrival_s, utc_at(arrival_s), is_same_machine);
      utc_s_ = 1e-9 * static_cast<double>(timed.frame.info.utc_ns);
      wind_trace_.hear(timed.frame.info.time_s, speed_of(timed.frame.info.wind.wind), measured_m_s());
      timeline_.accept(timed.frame, arrival_s);
    }
    advance_panel(inbox);
    const bool is_first_status = inbox.sensors && !sensors_;
    if (inbox.sensors) {
      sensors_ = std::move(inbox.sensors);
      if (wall_) agree_with_wall();
      director_->take_status(*sensors_, panel_.is_setting() ? kHandFade_s : light::SkyKeeper::kFade_s);
    }

    const double now = now_s();
    const double passed_s = now - last_s_;
    last_s_ = now;
    picture_passed_s_ = passed_s;
    picture_utc_s_ = utc_at(now);
    moment_ = &paused_.advance(timeline_.advance(now, picture_utc_s_), passed_s);
    log_doubt();
    log_clock();
    // A wall stays black, and a picture in a file is made only with a frame.
    if (window_ && !wall_) notice_ = notice_words_.advance(now, timeline_.playback(), connection_.status());
    follow_brightness(is_first_status ? kDimming_s : passed_s);
    // New scenes are shown when the pause ends.
    if (!paused_.is_paused()) {
      if (auto scenes = timeline_.take_new_scenes()) {
        director_->set_scenes(std::move(*scenes));
        if (pace_) pace_->settle();
      }
    }
    director_->advance(passed_s, utc_s_, moment_->wind.wind);
    log_quality();
    picture_s_ += kRateSmoothing * (passed_s - picture_s_);
    std::rotate(picture_times_ms_.begin(), picture_times_ms_.begin() + 1, picture_times_ms_.end());
    picture_times_ms_.back() = static_cast<float>(1e3 * passed_s);
  }

  /// Speed by the sensors that are believed; nullopt if there are none.
  std::optional<double> measured_m_s() const {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; sensors_ && i < sensors_->sensors.size(); ++i) {
      const wire::SensorStatus& sensor = sensors_->sensors[i];
      if (!is_believed(sensor.state) || !sensor.speed_m_s) continue;
      sum += *sensor.speed_m_s;
      ++count;
    }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
  }

  /// Returns true if anything is drawn over the picture.
  bool has_something_over() const {
    return has_overlay_ || has_panel_ || has_help_ || has_profiler_ || has_wind_ || paused_.is_paused() ||
           !notice_.empty();
  }

  /// Requests parameters only once a person opens the panel.
  void advance_panel(const stream::Inbox& inbox) {
    if (inbox.is_of_new_connection) panel_.set_connected(false);
    panel_.set_connected(connection_.status().state == stream::State::kConnected);
    for (const wire::ControlReply& reply : inbox.replies) panel_.take_reply(reply);
    if (inbox.sensors) panel_.take_revision(inbox.sensors->parameters_revision);
    if (!has_panel_) return;
    while (auto control = panel_.next(now_s())) connection_.send(*control);
  }

  /// Dark until the first status reports whether it is open, so that a wall that starts at night stays dark.
  void follow_brightness(double passed_s) {
    const double wanted = wanted_brightness();
    brightness_ += std::min(1.0, passed_s / kDimming_s) * (wanted - brightness_);
    if (wanted == 0.0 && brightness_ < kDarkest) brightness_ = 0.0;
  }

  double wanted_brightness() const {
    if (wall_ && timeline_.playback() == stream::Playback::kNothing) return 0.0;
    if (!options_.is_dark_when_closed) return 1.0;
    return sensors_ ? sensors_->shaping.openness : 0.0;
  }

  void draw(const PixelSize& size) {
    renderer_->resize(size.width_px, size.height_px);
    if (test_card_) {
      renderer_->target().bind_resolved();
      return test_card_->draw({.width_px = size.width_px, .height_px = size.height_px});
    }
    const pace::DrawnPart part = pace_ ? pace_->drawn() : pace::DrawnPart{};
    renderer_->set_drawn(part);
    director_->draw(*moment_);
    dimmer_->draw(static_cast<float>(brightness_));
    if (has_profiler_) passes_ = pass_clock_->end();
    if (!has_something_over()) return;
    const light::Sky sky = light::sky_of(director_->look(), utc_s_);
    const auto age = age_.figures(now_s());
    const double scale = overlay_scale(window_ ? window_->content_scale() : 1.0, size, options_.scale);
    overlay_->draw(size, scale,
                   {.wind = moment_->wind,
                    .playback = timeline_.playback(),
                    .stream = connection_.status(),
                    .sensors = sensors_ ? &*sensors_ : nullptr,
                    .pictures_per_s = 1.0 / picture_s_,
                    .nodes = renderer_->stage().node_count(),
                    .scenes = renderer_->scenes(),
                    .opacities = moment_->opacities,
                    .sky = &sky,
                    .quality = renderer_->quality(),
                    .drawn = part,
                    .refreshes = pace_ ? pace_->step().refreshes : 1,
                    .heading_deg = director_->heading_deg(),
                    .age = age ? age_text(*age) : std::string(),
                    .camera = director_->camera_text(),
                    .has_help = has_help_,
                    .is_paused = paused_.is_paused(),
                    .notice = notice_,
                    .wind_trace = has_wind_ ? &wind_trace_ : nullptr,
                    .passes = has_profiler_ ? &passes_ : nullptr,
                    .picture_times_ms = picture_times_ms_,
                    .has_texts = has_overlay_,
                    .panel = has_panel_ ? &panel_ : nullptr});
  }

  /// Call when the picture was handed to the display, which needs `display_s` to show it.
  void note_age(double display_s) {
    if (timeline_.playback() == stream::Playback::kLive) age_.take_picture(*moment_, now_s(), display_s);
    if (options_.logs_age && now_s() - age_logged_s_ >= kAgeLogInterval_s) log_age();
  }

  void log_age() {
    age_logged_s_ = now_s();
    const auto age = age_.figures(age_logged_s_);
    std::string text = age ? age_text(*age) : "no reading has been shown";
    if (const auto& fixed = timeline_.fixed_delay()) text += "; " + delay_text(fixed->figures());
    if (clock_watch_) text += "; " + platform::text_of(clock_watch_->latest());
    std::fprintf(stderr, "yuragi-viewer: %s\n", text.c_str());
  }

  /// Each time that the fixed delay is given up, but not more often than once a minute.
  void log_doubt() {
    const auto& fixed = timeline_.fixed_delay();
    if (!fixed || fixed->figures().losses == logged_losses_ || last_s_ < doubt_logged_s_ + kDoubtLogInterval_s) return;
    if (!fixed->is_in_doubt()) return;
    logged_losses_ = fixed->figures().losses;
    doubt_logged_s_ = last_s_;
    std::fprintf(stderr, "yuragi-viewer: %s\n", fixed->doubt_text().c_str());
  }

  /// While this machine's clock puts a screen out of step, and not more often than every 10 minutes.
  void log_clock() {
    if (!timeline_.fixed_delay() || last_s_ < clock_logged_s_ + kClockLogInterval_s) return;
    const platform::ClockOffset offset = clock_watch_->latest();
    if (!offset.is_large()) return;
    clock_logged_s_ = last_s_;
    std::fprintf(stderr, "yuragi-viewer: this screen is out of step by more than 5 ms: %s\n",
                 platform::text_of(offset).c_str());
  }

  /// Call when the picture was handed to the display.
  void log_swap() {
    if (!swap_log_) return;
    const auto& fixed = timeline_.fixed_delay();
    const auto nanoseconds = [](double utc_s) { return static_cast<std::int64_t>(1e9 * utc_s); };
    swap_log_->add({.utc_ns = nanoseconds(utc_at(now_s())),
                    .tick = moment_->tick,
                    .chosen_utc_ns = nanoseconds(picture_utc_s_),
                    .is_in_step = fixed && fixed->figures().is_kept && timeline_.playback() == stream::Playback::kLive,
                    .late_frames = fixed ? fixed->figures().late_frames : 0});
  }

  double display_interval_s() const {
    return wall_ ? wall_->picture_interval_s() : 1.0 / window_->refresh_rate_hz();
  }

  /// Waits if the driver does not wait for the screen, or only for its next refresh, so that no more pictures are made
  /// than wanted.
  void keep_pace() {
    const double rest_s = 0.95 * pace_->picture_s() - (now_s() - last_s_);
    if (rest_s > 0.0) window_->wait(rest_s);
  }

  const picture::ViewerOptions options_;
  const std::atomic<bool>& is_stopping_;
  stream::Connection connection_;
  const std::optional<output::Output> output_;
  std::optional<Window> window_;                 // nullopt for a picture in a file; the members below need its context
  std::optional<wall::Wall> wall_;               // of the window, if there is an output
  std::optional<picture::GlRenderer> renderer_;  // has a context of its own if there is no window
  std::optional<picture::Director> director_;
  std::optional<gl::Dimmer> dimmer_;
  std::optional<wall::TestCard> test_card_;
  std::optional<Overlay> overlay_;
  std::optional<gl::PassClock> pass_clock_;

  Watchdog watchdog_;
  bool is_software_ = false;
  std::optional<pace::Keeper> pace_;                         // of a window: a picture in a file is drawn in full
  pace::Step logged_step_{.quality = look::Quality::kAuto};  // in the log
  PixelSize paced_size_;
  wire::Display sent_display_;  // on the present connection
  int measured_pictures_ = 0;
  double utc_s_ = 0.0;  // the daemon's clock: of the newest frame
  stream::SceneTimeline timeline_;
  double picture_utc_s_ = 0.0;       // our clock: when the picture's moment was chosen
  std::uint64_t logged_losses_ = 0;  // of the fixed delay
  double doubt_logged_s_ = -kDoubtLogInterval_s;
  double clock_logged_s_ = -kClockLogInterval_s;
  std::optional<platform::ClockWatch> clock_watch_;  // if its offset is shown
  std::optional<SwapLog> swap_log_;
  stream::PictureAge age_;
  double age_logged_s_ = now_s();
  const stream::PoseMoment* moment_ = nullptr;
  std::optional<wire::Sensors> sensors_;
  double began_s_;
  double last_s_;
  double picture_passed_s_ = 0.0;  // since the picture before
  double picture_s_ = 1.0 / 60.0;  // between pictures, smoothed
  double black_until_s_ = 0.0;     // the shown picture is black, and need not be updated before this time
  PixelSize black_size_;
  double brightness_;  // of the picture, 0 to 1
  bool has_overlay_;
  bool has_panel_;
  bool has_help_ = false;
  bool has_profiler_ = false;
  bool has_wind_ = false;
  stream::Notice notice_words_;
  std::string notice_;  // empty: none
  PausedMoment paused_;
  WindTrace wind_trace_;
  std::vector<gl::PassClock::Pass> passes_;
  std::array<float, 240> picture_times_ms_{};
  Panel panel_;
};

Viewer::Viewer(const picture::ViewerOptions& options, const std::atomic<bool>& is_stopping)
    : show_(std::make_unique<Show>(options, is_stopping)) {
  is_picture_ = !options.screenshot.empty();
}
Viewer::~Viewer() = default;

void Viewer::run() {
  is_picture_ ? show_->run_screenshot() : show_->run_window();
  show_->log_last_age();
}

}  // namespace yuragi::viewer::app
