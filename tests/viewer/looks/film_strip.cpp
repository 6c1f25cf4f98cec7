// What a recorded wind does to the scenes, as pictures of some moments in one file: a row block for each camera, the
// moments from left to right and then downward. Everything is played in lock-step, so that the same recording,
// configuration and build give the same poses.
//
//   film_strip RECORDING.windlog STRIP.png --from 600 --camera 350,12,20 --camera 0,89,12 --look time=12:00

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "daemon/animation/animation.hpp"
#include "daemon/tools/offline/lockstep_replay.hpp"
#include "engine/look/look.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/light/sky_keeper.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/picture/picture_file.hpp"

namespace {

using namespace yuragi;

struct StripOptions {
  std::string recording, picture, config;
  double from_s = 600.0;
  double step_s = 1.0 / 6.0;
  int moments = 12;
  int columns = 4;
  int width_px = 400;
  int height_px = 225;
  bool is_lean_shown = false;
  std::vector<std::string> cameras{"350,14,20", "0,60,26"};
  std::vector<std::string> look_edits;
};

constexpr int kGap_px = 4;
constexpr double kBefore_s = 120.0;  // the recording is heard from so long before the first picture

/// "HEADING,PITCH,DISTANCE" around the middle of what is shown, a little above the ground; or with ",HEIGHT" that high.
/// "home": where the viewer begins.
viewer::meshes::OrbitCamera camera_of(const std::string& text, const viewer::looks::Stage& stage, double aspect) {
  viewer::meshes::OrbitCamera camera;
  if (text == "home") {
    camera.frame(stage.home(aspect));
    return camera;
  }
  viewer::meshes::CameraPlace place;
  double height_m = 0.4;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf", &place.heading_deg, &place.pitch_deg, &place.distance_m, &height_m) <
      3) {
    throw std::runtime_error("--camera: is \"" + text +
                             "\"; allowed: home, HEADING,PITCH,DISTANCE or with ,HEIGHT behind");
  }
  place.target_m.y = height_m;
  camera.frame(place);
  return camera;
}

using Picture = std::vector<std::uint8_t>;

/// How far the blades of a meadow lean, seen from above, north upward: means over squares of its ground.
class LeanMap {
 public:
  explicit LeanMap(const pose::StrandSkeleton& meadow) : meadow_(meadow) {
    for (std::size_t i = 0; i < meadow.strand_count; ++i) {
      reach_m_ = std::max({reach_m_, std::abs(meadow.root_x_m[i]), std::abs(meadow.root_z_m[i])});
    }
  }

  void add(const pose::StrandPose& pose) {
    std::vector<double> sums(kCells * kCells), counts(kCells * kCells);
    for (std::size_t i = 0; i < meadow_.strand_count; ++i) {
      const std::size_t cell = cell_of(meadow_.root_z_m[i]) * kCells + cell_of(meadow_.root_x_m[i]);
      sums[cell] += static_cast<double>(std::hypot(pose.bend_east_rad[i], pose.bend_south_rad[i]));
      counts[cell] += 1.0;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(counts[i], 1.0);
    leans_.push_back(std::move(sums));
  }

  /// Takes out what a place has in all moments: blades differ.
  void take_out_means() {
    for (std::size_t cell = 0; cell < kCells * kCells; ++cell) {
      double mean = 0.0;
      for (const std::vector<double>& lean : leans_) mean += lean[cell] / static_cast<double>(leans_.size());
      for (std::vector<double>& lean : leans_) lean[cell] -= mean;
    }
  }

  /// The pictures, all with the same colours: dark where blades stand, pale where they lean most.
  std::vector<Picture> pictures(int width_px, int height_px) const {
    double least = 1e9;
    double most = -1e9;
    for (const std::vector<double>& lean : leans_) {
      least = std::min(least, *std::ranges::min_element(lean));
      most = std::max(most, *std::ranges::max_element(lean));
    }
    std::vector<Picture> result;
    for (const std::vector<double>& lean : leans_) {
      Picture& picture = result.emplace_back();
      for (int y = 0; y < height_px; ++y) {
        for (int x = 0; x < width_px; ++x) {
          const auto column = std::floor((x - (width_px - height_px) / 2.0) * kCells / height_px);
          const bool is_ground = column >= 0.0 && column < kCells;
          const auto row = static_cast<std::size_t>(y) * kCells / static_cast<std::size_t>(height_px);
          const double part =
              is_ground ? (lean[row * kCells + static_cast<std::size_t>(column)] - least) / (most - least) : 0.0;
          for (const double bright : {255.0, 250.0, 200.0}) {
            picture.push_back(is_ground ? static_cast<std::uint8_t>(20.0 + part * (bright - 20.0)) : 0);
          }
        }
      }
    }
    return result;
  }

 private:
  static constexpr std::size_t kCells = 45;

  std::size_t cell_of(float at_m) const {
    const float part = (at_m / reach_m_ + 1.0F) / 2.0F;
    return std::min(static_cast<std::size_t>(part * static_cast<float>(kCells)), kCells - 1);
  }

  const pose::StrandSkeleton& meadow_;
  float reach_m_ = 0.1F;
  std::vector<std::vector<double>> leans_;  // a moment each
};

/// Small pictures side by side, on black.
class Sheet {
 public:
  Sheet(const StripOptions& options, int count)
      : columns_(options.columns),
        cell_width_px_(options.width_px + kGap_px),
        cell_height_px_(options.height_px + kGap_px),
        width_px_(columns_ * cell_width_px_ - kGap_px),
        height_px_((count + columns_ - 1) / columns_ * cell_height_px_ - kGap_px),
        rgb_(3 * static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_)) {}

  void put(int number, const Picture& picture) {
    const auto line = 3 * static_cast<std::size_t>(cell_width_px_ - kGap_px);
    auto from = picture.begin();
    for (int y = 0; y < cell_height_px_ - kGap_px; ++y, from += static_cast<std::ptrdiff_t>(line)) {
      const int row_px = number / columns_ * cell_height_px_ + y;
      const int column_px = number % columns_ * cell_width_px_;
      std::copy_n(from, line, rgb_.begin() + 3 * (static_cast<std::ptrdiff_t>(row_px) * width_px_ + column_px));
    }
  }
  void write(const std::string& file) const { viewer::picture::write_picture(file, width_px_, height_px_, rgb_); }

 private:
  int columns_, cell_width_px_, cell_height_px_, width_px_, height_px_;
  Picture rgb_;
};

void make_strip(const StripOptions& options) {
  const viewer::gl::HeadlessContext context({.has_messages = true});
  viewer::gl::report_gl_errors();
  viewer::looks::Stage stage;
  viewer::gl::RenderTarget target(options.width_px, options.height_px, 4);
  constexpr double kDay_s = 1790208000.0;  // 2026-09-24
  stage.set_light(viewer::light::light_of(look::edited({}, options.look_edits).value(), kDay_s));
  std::vector<viewer::meshes::OrbitCamera> cameras;
  // Each camera's block begins with a row of its own.
  const int rows = (options.moments + options.columns - 1) / options.columns;
  const int blocks = static_cast<int>(options.cameras.size()) + (options.is_lean_shown ? 1 : 0);
  Sheet sheet(options, blocks * rows * options.columns);

  const daemon::settings::Config config =
      options.config.empty() ? daemon::settings::default_config() : daemon::settings::load_config(options.config);
  const double tick_s = 1.0 / config.animation.rate_hz;
  const double start_s = std::max(0.0, options.from_s - kBefore_s);
  const double first_s = options.from_s - start_s;
  drivers::windlog::PlayerOptions player;
  player.playback.start = fmt::format("{}", start_s);
  int taken = 0;
  std::vector<std::vector<Picture>> pictures(options.cameras.size());
  std::optional<LeanMap> lean;
  viewer::stream::PoseMoment moment;
  const daemon::tools::offline::UseTick take = [&](const daemon::tools::offline::ReplayTick& tick) {
    const double time_s = tick.log_time_s;
    const daemon::animation::Animation& animation = tick.animation;
    if (taken == options.moments || time_s < first_s + taken * options.step_s - 0.5 * tick_s) return;
    if (taken == 0) {
      const std::vector<wire::SceneModel> scenes = animation.describe().scenes;
      stage.set_scenes(scenes);
      moment = viewer::stream::rest_moment(scenes);
      const double aspect = static_cast<double>(options.width_px) / options.height_px;
      for (const std::string& text : options.cameras) cameras.push_back(camera_of(text, stage, aspect));
      if (options.is_lean_shown) lean.emplace(std::get<pose::StrandSkeleton>(stage.scenes()[0]->skeleton));
    }
    moment.time_s = time_s;
    moment.wind = tick.wind;
    for (std::size_t scene = 0; scene < moment.poses.size(); ++scene) moment.poses[scene] = *animation.poses()[scene];
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      stage.draw(moment, cameras[i], target);
      pictures[i].push_back(target.read_rgb());
    }
    if (lean) lean->add(std::get<pose::StrandPose>(moment.poses[0]));
    ++taken;
  };
  daemon::tools::offline::replay_in_lockstep(config, options.recording, player,
                                             first_s + options.moments * options.step_s, {}, take)
      .value();
  if (taken < options.moments) {
    throw std::runtime_error(fmt::format("{} ends after {} of {} pictures", options.recording, taken, options.moments));
  }
  if (lean) lean->take_out_means();
  if (lean) pictures.push_back(lean->pictures(options.width_px, options.height_px));
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    for (int number = 0; number < taken; ++number) {
      sheet.put(static_cast<int>(i) * rows * options.columns + number, pictures[i][static_cast<std::size_t>(number)]);
    }
  }
  sheet.write(options.picture);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    StripOptions options;
    CLI::App app("Pictures of what a recorded wind does to the scenes");
    app.add_option("recording", options.recording)->required()->type_name("FILE.windlog");
    app.add_option("picture", options.picture)->required()->type_name("FILE.png");
    app.add_option("--config", options.config, "the scenes; without it one meadow")->type_name("FILE.toml");
    app.add_option("--from", options.from_s, "log time of the first picture, s")->capture_default_str();
    app.add_option("--step", options.step_s, "from picture to picture, s")->capture_default_str();
    app.add_option("--count", options.moments, "pictures a camera")->check(CLI::Range(1, 1000))->capture_default_str();
    app.add_option("--columns", options.columns)->check(CLI::Range(1, 100))->capture_default_str();
    app.add_option("--width", options.width_px, "of a picture, pixels")->check(CLI::Range(16, 4096));
    app.add_option("--height", options.height_px)->check(CLI::Range(16, 4096));
    app.add_flag("--lean", options.is_lean_shown, "and how far the first scene's blades lean, as a map");
    app.add_option("--camera", options.cameras,
                   "HEADING,PITCH,DISTANCE[,HEIGHT] as yuragi-viewer has it, or home; can be given again")
        ->allow_extra_args(false);
    app.add_option("--look", options.look_edits, "KEY=VALUE of the light, as yuragi-viewer has it; can be given again")
        ->allow_extra_args(false);
    CLI11_PARSE(app, argc, argv);
    make_strip(options);
    return viewer::gl::gl_error_count() == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "film_strip: %s\n", error.what());
    return 70;
  }
}
