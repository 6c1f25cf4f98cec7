// What a recorded wind does to the scenes, as pictures of some moments in one file: a row block for each camera, the
// moments from left to right and then downward. Everything is played in lock-step, so that the same recording,
// configuration and build give the same poses.
//
//   xvfb-run -a film_strip RECORDING.windlog STRIP.png --from 600 --camera 350,12,20 --camera 0,89,12

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "daemon/animation.hpp"
#include "daemon/lockstep_replay.hpp"
#include "viewer/picture_file.hpp"
#include "viewer/stage.hpp"
#include "viewer/window.hpp"

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
  double contrast = 0.0;
  std::vector<std::string> cameras{"350,14,20", "0,60,26"};
};

constexpr int kGap_px = 4;
constexpr double kBefore_s = 120.0;  // the recording is heard from so long before the first picture

/// "HEADING,PITCH,DISTANCE" around the middle of what is shown, a little above the ground.
OrbitCamera camera_of(const std::string& text) {
  CameraPlace place;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf", &place.heading_deg, &place.pitch_deg, &place.distance_m) != 3) {
    throw std::runtime_error("--camera: is \"" + text + "\"; allowed: HEADING,PITCH,DISTANCE");
  }
  place.target_m.y = 0.4;
  OrbitCamera camera;
  camera.frame(place);
  return camera;
}

using Picture = std::vector<std::uint8_t>;

/// Shows more of what changes: each picture gets `contrast` times what it differs from the mean of all, in squares of
/// kSquare_px, so that gusts are seen and not single blades.
void stretch(std::vector<Picture>& pictures, int width_px, double contrast) {
  constexpr std::size_t kSquare_px = 8;
  const auto width = static_cast<std::size_t>(width_px);
  const std::size_t height = pictures.front().size() / (3 * width);
  for (std::size_t top = 0; top < height; top += kSquare_px) {
    for (std::size_t left = 0; left < width; left += kSquare_px) {
      const auto each = [&](Picture& picture, const auto& use) {
        for (std::size_t y = top; y < std::min(height, top + kSquare_px); ++y) {
          for (std::size_t i = 3 * (y * width + left); i < 3 * (y * width + std::min(width, left + kSquare_px)); ++i) {
            use(picture[i]);
          }
        }
      };
      std::vector<double> sums(pictures.size());
      double mean = 0.0;
      double values = 0.0;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        each(pictures[i], [&](std::uint8_t value) {
          sums[i] += value;
          values += 1.0;
        });
        mean += sums[i];
      }
      mean /= values;
      for (std::size_t i = 0; i < pictures.size(); ++i) {
        const double more = contrast * (sums[i] * static_cast<double>(pictures.size()) / values - mean);
        each(pictures[i], [&](std::uint8_t& value) {
          value = static_cast<std::uint8_t>(std::clamp(std::round(value + more), 0.0, 255.0));
        });
      }
    }
  }
}

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
  void write(const std::string& file) const { write_png(file, width_px_, height_px_, rgb_); }

 private:
  int columns_, cell_width_px_, cell_height_px_, width_px_, height_px_;
  Picture rgb_;
};

void make_strip(const StripOptions& options) {
  const Window window({.width_px = 64, .height_px = 64, .is_visible = false, .monitor = {}});
  report_gl_errors();
  Stage stage;
  RenderTarget target(options.width_px, options.height_px, 4);
  std::vector<OrbitCamera> cameras;
  for (const std::string& text : options.cameras) cameras.push_back(camera_of(text));
  // Each camera's block begins with a row of its own.
  const int rows = (options.moments + options.columns - 1) / options.columns;
  Sheet sheet(options, static_cast<int>(cameras.size()) * rows * options.columns);

  const Config config = options.config.empty() ? default_config() : load_config(options.config);
  const double tick_s = 1.0 / config.animation.number("rate");
  const double start_s = std::max(0.0, options.from_s - kBefore_s);
  const double first_s = options.from_s - start_s;
  PlayerOptions player;
  player.playback.start = fmt::format("{}", start_s);
  int taken = 0;
  std::vector<std::vector<Picture>> pictures(cameras.size());
  PoseMoment moment;
  const UseTick take = [&](double time_s, const Animation& animation) {
    if (taken == options.moments || time_s < first_s + taken * options.step_s - 0.5 * tick_s) return;
    if (taken == 0) {
      stage.set_scenes(animation.describe().scenes);
      moment = rest_moment(stage.scenes());
    }
    for (std::size_t scene = 0; scene < moment.poses.size(); ++scene) moment.poses[scene] = *animation.poses()[scene];
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      stage.draw(moment, cameras[i], target);
      pictures[i].push_back(target.read_rgb());
    }
    ++taken;
  };
  replay_in_lockstep(config, options.recording, player, first_s + options.moments * options.step_s, {}, take);
  if (taken < options.moments) {
    throw std::runtime_error(fmt::format("{} ends after {} of {} pictures", options.recording, taken, options.moments));
  }
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (options.contrast > 0.0) stretch(pictures[i], options.width_px, options.contrast);
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
    app.add_option("--contrast", options.contrast, "add so many times what changes from picture to picture")
        ->check(CLI::Range(0.0, 100.0));
    app.add_option("--camera", options.cameras, "HEADING,PITCH,DISTANCE as yuragi-viewer has it; can be given again")
        ->allow_extra_args(false);
    CLI11_PARSE(app, argc, argv);
    make_strip(options);
    return gl_error_count() == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "film_strip: %s\n", error.what());
    return 70;
  }
}
