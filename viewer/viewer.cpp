#include "viewer/viewer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "engine/base/address.hpp"
#include "viewer/camera_keeper.hpp"
#include "viewer/camera_place.hpp"
#include "viewer/gl/cross_fade.hpp"
#include "viewer/gl/dimmer.hpp"
#include "viewer/gl_renderer.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/overlay.hpp"
#include "viewer/pace_keeper.hpp"
#include "viewer/panel.hpp"
#include "viewer/picture_file.hpp"
#include "viewer/quality.hpp"
#include "viewer/stream/picture_age.hpp"
#include "viewer/stream/scene_timeline.hpp"
#include "viewer/stream/stream_connection.hpp"
#include "viewer/viewer_exit.hpp"
#include "viewer/wall/outputs_file.hpp"
#include "viewer/wall/test_card.hpp"
#include "viewer/wall/wall.hpp"
#include "viewer/watchdog.hpp"
#include "viewer/window.hpp"

namespace yuragi::viewer {
namespace {

constexpr double kIdleWait_s = 0.1;  // while there is nothing to draw on
constexpr double kLookWait_s = 1.0;  // for the daemon's first status, which has its look
constexpr int kOverlayPictures = 2;  // the overlay's size is known after the first
constexpr int kSamples = 4;          // a pixel
constexpr double kRateSmoothing = 0.05;
constexpr double kHandFade_s = 0.3;  // of the light, while a person moves a handle of the panel
constexpr double kAgeSaid_s = stream::PictureAge::kSpan_s;
constexpr double kDimming_s = 0.5;  // between two of the daemon's statuses the brightness goes on

double now_s() {
  return seconds(std::chrono::steady_clock::now().time_since_epoch());
}

/// Since 1970, at a moment of now_s().
double utc_at(double moment_s) {
  return seconds(std::chrono::system_clock::now().time_since_epoch()) + moment_s - now_s();
}

stream::StreamOptions address_of(const ViewerOptions& options) {
  const auto address = parse_address(options.connect, wire::kDefaultPort);
  if (!address) throw ViewerExit(EX_USAGE, "--connect: " + address.error().message);
  if (address->port == 0) throw ViewerExit(EX_USAGE, "--connect: port 0 cannot be connected to");
  return {.host = address->host, .port = address->port};
}

/// What the configuration says of the wall; nothing where there is none.
std::optional<output::Output> output_of(const ViewerOptions& options) {
  if (options.config.empty()) return std::nullopt;
  return wall::load_output(options.config, options.output);
}

}  // namespace

class Viewer::Show {
 public:
  Show(const ViewerOptions& options, const std::atomic<bool>& is_stopping)
      : options_(options),
        is_stopping_(is_stopping),
        connection_(address_of(options)),
        output_(output_of(options)),
        began_s_(now_s()),
        last_s_(began_s_),
        brightness_(options.is_dark_when_closed || output_ ? 0.0 : 1.0),
        has_overlay_(options.overlay.value_or(options.screenshot.empty() && !output_)),
        has_panel_(options.has_panel) {
    if (options.screenshot.empty()) {
      window_.emplace(WindowOptions{.width_px = options.width_px,
                                    .height_px = options.height_px,
                                    .is_fullscreen = options.is_fullscreen,
                                    .monitor = options.monitor,
                                    .is_hidden = output_.has_value()});
      if (output_) wall_.emplace(window_->handle(), *output_);
    } else {
      headless_ = make_headless_context();
    }
#ifdef YURAGI_GL_DEBUG
    gl::report_gl_errors();
#endif
    is_software_ = gl::is_software_renderer();
    const bool is_slow = is_software_ && options.screenshot.empty();
    samples_ = options.samples.value_or(is_slow ? 1 : kSamples);
    stage_.emplace();
    dimmer_.emplace();
    cross_fade_.emplace();
    if (options.has_test_card) test_card_.emplace();
    sky_.start(look_for({}));
    if (!options.scene.empty()) stage_->show_only(options.scene);
    window_ ? overlay_.emplace(window_->handle(), window_->content_scale()) : overlay_.emplace(nullptr, 1.0);
    begin_cameras();
    if (output_ && output_->screen) see_through(*output_->screen);
    camera_.set_turning(options.is_turning);
    frame_camera();
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
      draw(size);
      show(size);
      note_age(display_interval_s());
      if (gl::is_context_lost()) throw ViewerExit(EX_TEMPFAIL, "the graphics card was reset; start the viewer again");
      // Where the processor draws the picture is done now.
      if (is_drawn_for_pace()) pace_.advance(picture_passed_s_, now_s() - last_s_);
      keep_pace();
    }
  }

  /// At the end.
  void say_last_age() {
    if (options_.says_age) say_age();
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
      require_camera();
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
    write_picture(options_.screenshot, size.width_px, size.height_px, target_->read_rgb());
  }

  /// Empty where there is nothing to show it on.
  PixelSize size_to_show() const {
    if (!wall_) return window_->framebuffer_size();
    const output::Size size = wall_->picture_size();
    return wall_->is_dark() ? PixelSize{} : PixelSize{.width_px = size.width_px, .height_px = size.height_px};
  }

  void show(const PixelSize& size) {
    if (wall_) return wall_->show(*target_, options_.has_test_card);
    target_->show(size.width_px, size.height_px);
    window_->swap();
  }

  [[noreturn]] void throw_no_daemon() const {
    throw ViewerExit(EX_UNAVAILABLE, "no pose was received from " + options_.connect + " (" +
                                         connection_.status().text +
                                         ").\nStart a daemon with `yuragi run`, or give its address with --connect "
                                         "HOST:PORT, or wait longer with --wait SECONDS.");
  }

  void require_scene() const {
    if (options_.scene.empty()) return;
    std::string names;
    for (const wire::SceneModel* scene : stage_->scenes()) {
      if (scene->name == options_.scene) return;
      names += names.empty() ? scene->name : ", " + scene->name;
    }
    throw ViewerExit(EX_USAGE,
                     "--scene: " + options_.connect + " has no scene '" + options_.scene + "'; it has: " + names);
  }

  /// A camera that is asked for by its name has to come.
  double longest_wait_for_status_s() const {
    return is_camera_named() ? std::max(options_.wait_s, kLookWait_s) : kLookWait_s;
  }

  bool is_camera_named() const {
    return !options_.camera.empty() && !view_;
  }

  void require_camera() const {
    if (!is_camera_named() || cameras_.has(options_.camera)) return;
    std::string names;
    for (const look::Camera& camera : cameras_.cameras()) names += names.empty() ? camera.name : ", " + camera.name;
    throw ViewerExit(EX_USAGE, "--camera: " + options_.connect + " has no camera '" + options_.camera + "'; it has " +
                                   (names.empty() ? "none: there is no [[camera]] in its configuration" : names));
  }

  void see_through(const output::Screen& screen) {
    const auto place = [](const output::RoomPlace& of) { return glm::dvec3(of[0], of[1], of[2]); };
    const meshes::Frustum frustum = meshes::frustum_through(place(screen.lower_left_m), place(screen.lower_right_m),
                                                            place(screen.upper_left_m), place(screen.eye_m));
    camera_.see_through(frustum);
    shot_camera_.see_through(frustum);
  }

  /// What the command line asks for comes before the hour.
  void begin_cameras() {
    view_ = read_camera_view(options_.camera);
    if (is_camera_named()) {
      cameras_.begin_with(options_.camera);
    } else if (view_ || !options_.scene.empty() || options_.is_turning) {
      cameras_.begin_by_hand();
    }
  }

  /// The camera of a shot, for a picture of width / height `aspect`.
  const meshes::OrbitCamera& camera_of(const Shot& shot, double aspect) {
    if (!shot.camera) return camera_;
    const look::Camera& camera = *shot.camera;
    shot_camera_.go_to(place_of(camera, stage_->bounds_of(camera.scene), aspect, shot.utc_s));
    return shot_camera_;
  }

  /// The user's hand begins where the picture is.
  void take_camera() {
    if (cameras_.now().camera) camera_.go_to(camera_of(cameras_.now(), aspect_).place());
    cameras_.take_by_hand();
  }

  /// For the overlay.
  std::string camera_text() const {
    if (cameras_.cameras().empty()) return {};
    const std::string name = cameras_.now().name();
    if (name.empty()) return cameras_.is_fading() ? "camera by hand, cross-fading" : "camera by hand";
    return "camera " + name + (cameras_.is_fading() ? ", cross-fading" : "");
  }

  /// What the command line says, over the daemon's look.
  look::Look look_for(const look::Look& daemons) const {
    return *look::edited(daemons, options_.look);
  }

  /// Says a change in the log, too.
  void use_quality(look::Quality quality) {
    if (quality == quality_) return;
    quality_ = quality;
    stage_->set_quality(quality);
    std::fprintf(stderr, "yuragi-viewer: %s\n", quality_text(quality).c_str());
  }

  void frame_camera() {
    meshes::CameraPlace place = stage_->home(static_cast<double>(options_.width_px) / options_.height_px);
    if (view_) {
      place.heading_deg = view_->heading_deg;
      place.pitch_deg = view_->pitch_deg;
      place.distance_m = view_->distance_m;
    }
    camera_.frame(place);
  }

  void use_input() {
    const WindowInput input = window_->take_input();
    if (input.moves_camera() || input.toggle_turning) take_camera();
    camera_.orbit(input.orbit_right, input.orbit_down);
    camera_.pan(input.pan_right, input.pan_down, aspect_);
    camera_.zoom(input.zoom_notches);
    if (input.next_camera) cameras_.next();
    if (input.reset_camera && !cameras_.reset()) camera_.reset();
    if (input.next_scene) {
      stage_->show_next();
      cameras_.take_by_hand();
      frame_camera();
      if (stage_->shows_all()) cameras_.reset();
    }
    if (input.toggle_turning) camera_.set_turning(!camera_.is_turning());
    if (input.toggle_overlay) has_overlay_ = !has_overlay_;
    if (input.toggle_panel) has_panel_ = !has_panel_;
    window_->set_taken(has_panel_ && overlay_->takes_mouse(), has_panel_ && overlay_->takes_keys());
  }

  /// Takes what has arrived, and advances to now.
  void advance() {
    stream::Inbox inbox = connection_.take();
    if (inbox.scenes) timeline_.set_scenes(std::move(*inbox.scenes));
    const bool is_same_machine = connection_.status().is_same_machine;
    for (stream::TimedFrame& timed : inbox.frames) {
      const double arrival_s = seconds(timed.arrival.time_since_epoch());
      age_.take_frame(timed.frame.info, arrival_s, utc_at(arrival_s), is_same_machine);
      utc_s_ = 1e-9 * static_cast<double>(timed.frame.info.utc_ns);
      timeline_.accept(timed.frame, arrival_s);
    }
    if (!inbox.frames.empty()) cameras_.hear_clock(utc_s_);
    advance_panel(inbox);
    const bool is_first_status = inbox.sensors && !sensors_;
    if (inbox.sensors) {
      sensors_ = std::move(inbox.sensors);
      const double over_s = panel_.is_setting() ? kHandFade_s : light::SkyKeeper::kFade_s;
      is_first_status ? sky_.start(look_for(sensors_->look)) : sky_.set_look(look_for(sensors_->look), over_s);
      cameras_.set_cameras(sensors_->cameras, sensors_->camera);
      if (is_first_status) require_camera();
    }

    const double now = now_s();
    const double passed_s = now - last_s_;
    last_s_ = now;
    picture_passed_s_ = passed_s;
    camera_.advance(passed_s);
    cameras_.advance(passed_s);
    moment_ = &timeline_.advance(now);
    follow_brightness(is_first_status ? kDimming_s : passed_s);
    if (auto scenes = timeline_.take_new_scenes()) {
      stage_->set_scenes(std::move(*scenes));
      if (!has_framed_) {
        require_scene();
        frame_camera();
      }
      has_framed_ = true;
    }
    const wind::WindVector& wind = moment_->wind.wind;
    stage_->set_light(sky_.advance(utc_s_, passed_s, {wind.u_m_s, -wind.v_m_s}));
    use_quality(quality_for(sky_.look().quality, is_software_));
    picture_s_ += kRateSmoothing * (passed_s - picture_s_);
  }

  /// Nothing is asked of the daemon before a person wants to see the panel.
  void advance_panel(const stream::Inbox& inbox) {
    if (inbox.is_of_new_connection) panel_.set_connected(false);
    panel_.set_connected(connection_.status().state == stream::StreamState::kConnected);
    for (const wire::ControlReply& reply : inbox.replies) panel_.take_reply(reply);
    if (inbox.sensors) panel_.take_revision(inbox.sensors->parameters_revision);
    if (!has_panel_) return;
    while (auto control = panel_.next(now_s())) connection_.send(*control);
  }

  /// Dark until the first status says whether it is open, so that a wall that starts at night stays dark.
  void follow_brightness(double passed_s) {
    brightness_ += std::min(1.0, passed_s / kDimming_s) * (wanted_brightness() - brightness_);
  }

  double wanted_brightness() const {
    if (wall_ && timeline_.playback() == stream::Playback::kNothing) return 0.0;
    if (!options_.is_dark_when_closed) return 1.0;
    return sensors_ ? sensors_->shaping.openness : 0.0;
  }

  void draw(const PixelSize& size) {
    if (!target_ || PixelSize{target_->width_px(), target_->height_px()} != size) {
      target_.emplace(size.width_px, size.height_px, samples_);
    }
    if (test_card_) {
      target_->bind_resolved();
      return test_card_->draw({.width_px = size.width_px, .height_px = size.height_px});
    }
    aspect_ = static_cast<double>(size.width_px) / size.height_px;
    const DrawnPart part = is_drawn_for_pace() ? pace_.drawn() : DrawnPart{};
    stage_->set_blade_share(part.blades * static_cast<float>(sky_.look().density));
    stage_->set_coarseness(part.coarseness);
    target_->set_drawn_side(part.side);
    if (cameras_.is_fading()) {
      stage_->draw(*moment_, camera_of(cameras_.before(), aspect_), *target_);
      cross_fade_->keep(*target_);
    }
    const meshes::OrbitCamera& camera = camera_of(cameras_.now(), aspect_);
    stage_->draw(*moment_, camera, *target_);
    if (cameras_.is_fading()) cross_fade_->draw(*target_, static_cast<float>(cameras_.share()));
    dimmer_->draw(static_cast<float>(brightness_));
    if (!has_overlay_ && !has_panel_) return;
    const auto age = age_.figures(now_s());
    const light::Sky sky = light::sky_of(sky_.look(), utc_s_);
    overlay_->draw(size, {.wind = moment_->wind,
                          .playback = timeline_.playback(),
                          .stream = connection_.status(),
                          .sensors = sensors_ ? &*sensors_ : nullptr,
                          .pictures_per_s = 1.0 / picture_s_,
                          .nodes = stage_->node_count(),
                          .scenes = stage_->scenes(),
                          .opacities = moment_->opacities,
                          .sky = &sky,
                          .quality = quality_,
                          .drawn = part,
                          .heading_deg = camera.place().heading_deg,
                          .age = age ? age_text(*age) : std::string(),
                          .camera = camera_text(),
                          .has_texts = has_overlay_,
                          .panel = has_panel_ ? &panel_ : nullptr});
  }

  /// Is less drawn where that keeps the pace? Where the processor draws into a window, in quality low.
  bool is_drawn_for_pace() const {
    return is_software_ && window_ && quality_ == look::Quality::kLow;
  }

  /// The picture has been handed to the display, which takes so long to show it.
  void note_age(double display_s) {
    if (timeline_.playback() == stream::Playback::kLive) age_.take_picture(*moment_, now_s(), display_s);
    if (options_.says_age && now_s() - age_said_s_ >= kAgeSaid_s) say_age();
  }

  void say_age() {
    age_said_s_ = now_s();
    const auto age = age_.figures(age_said_s_);
    std::fprintf(stderr, "yuragi-viewer: %s\n", age ? age_text(*age).c_str() : "no reading has been shown");
  }

  double display_interval_s() const {
    return wall_ ? wall_->picture_interval_s() : 1.0 / window_->refresh_rate_hz();
  }

  /// Waits where the driver does not wait for the screen: no more pictures than the screen can show.
  void keep_pace() {
    const double rest_s = 0.95 * display_interval_s() - (now_s() - last_s_);
    if (rest_s > 0.0) window_->wait(rest_s);
  }

  const ViewerOptions options_;
  const std::atomic<bool>& is_stopping_;
  stream::StreamConnection connection_;
  const std::optional<output::Output> output_;
  std::optional<Window> window_;    // this or headless_; the members below need its context
  std::optional<wall::Wall> wall_;  // of the window, where there is an output
  std::unique_ptr<gl::HeadlessContext> headless_;
  std::optional<looks::Stage> stage_;
  std::optional<gl::Dimmer> dimmer_;
  std::optional<gl::CrossFade> cross_fade_;
  std::optional<wall::TestCard> test_card_;
  std::optional<Overlay> overlay_;
  std::optional<gl::RenderTarget> target_;

  Watchdog watchdog_;
  std::optional<CameraView> view_;  // of the command line
  CameraKeeper cameras_;
  meshes::OrbitCamera camera_;       // by hand
  meshes::OrbitCamera shot_camera_;  // one of the daemon's, at the moment
  double aspect_ = 16.0 / 9.0;       // of the last picture
  bool has_framed_ = false;
  light::SkyKeeper sky_;
  bool is_software_ = false;
  PaceKeeper pace_;
  look::Quality quality_ = look::Quality::kAuto;
  double utc_s_ = 0.0;  // the daemon's clock: of the newest frame
  stream::SceneTimeline timeline_;
  stream::PictureAge age_;
  double age_said_s_ = now_s();
  const stream::PoseMoment* moment_ = nullptr;
  std::optional<wire::Sensors> sensors_;
  double began_s_;
  double last_s_;
  double picture_passed_s_ = 0.0;  // since the picture before
  double picture_s_ = 1.0 / 60.0;  // between pictures, smoothed
  double brightness_;              // of the picture, 0 to 1
  bool has_overlay_;
  bool has_panel_;
  Panel panel_;
  int samples_ = kSamples;
};

Viewer::Viewer(const ViewerOptions& options, const std::atomic<bool>& is_stopping)
    : show_(std::make_unique<Show>(options, is_stopping)) {
  is_picture_ = !options.screenshot.empty();
}
Viewer::~Viewer() = default;

void Viewer::run() {
  is_picture_ ? show_->run_screenshot() : show_->run_window();
  show_->say_last_age();
}

}  // namespace yuragi::viewer
