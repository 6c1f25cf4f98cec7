#include "viewer/options.hpp"

#include <charconv>

#include "engine/base/duration.hpp"
#include "engine/look/look.hpp"
#include "viewer/picture_file.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kMaxSide_px = 16384;

/// Reads "1280x720"; returns what is wrong with it, or an empty text.
std::string read_size(const std::string& text, ViewerOptions& options) {
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, options.width_px);
  if (width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, options.height_px);
    if (height.ec == std::errc{} && height.ptr == end && options.width_px >= 16 && options.height_px >= 16 &&
        options.width_px <= kMaxSide_px && options.height_px <= kMaxSide_px) {
      return {};
    }
  }
  return "'" + text + "' is not a size: give WIDTHxHEIGHT in pixels, such as 1920x1080";
}

/// What is wrong with the name of a picture file, or an empty text.
std::string check_picture_name(const std::string& name) {
  if (picture_format(name)) return {};
  return "'" + name + "' is not the name of a picture that can be written: it has to end in .png, .jpg or .jpeg";
}

}  // namespace

void add_options(CLI::App& app, ViewerOptions& options) {
  app.add_option("--connect", options.connect, "The daemon whose stream to show, HOST:PORT")->capture_default_str();
  app.add_option("--size", options.size, "Size of the window or picture, WIDTHxHEIGHT in pixels")
      ->capture_default_str()
      ->check([&options](const std::string& text) { return read_size(text, options); });
  app.add_option("--samples", options.samples,
                 "Samples per pixel (antialiasing); default 4, or 1 in a window without graphics hardware")
      ->check(CLI::Range(1, 16));
  app.add_flag("--overlay,!--no-overlay", options.overlay,
               "Show wind, sensors and stream over the picture (default in windows)");
  app.add_flag("--panel", options.has_panel,
               "Show the panel that lists and sets the values of the daemon's [look] and scenes (P)");
  app.add_flag("--fullscreen", options.is_fullscreen, "Fill the screen");
  app.add_flag("--dark-when-closed", options.is_dark_when_closed,
               "Fade to black outside of the daemon's opening hours ([shaping] hours)");
  app.add_option("--monitor", options.monitor, "Which screen to use, counted from 0")->check(CLI::NonNegativeNumber);
  app.add_flag("--turn", options.is_turning, "Turn the camera slowly");
  app.add_option("--scene", options.scene, "Show only the scene of this name");
  app.add_option(
         "--look", options.look,
         "KEY=VALUE: another light or weather than the daemon's [look], such as time=06:30 or clouds=1; repeatable")
      ->allow_extra_args(false)
      ->check([](const std::string& edit) {
        const auto look = look::edited({}, std::span(&edit, 1));
        return look ? std::string() : look.error().name + " " + look.error().message;
      });
  app.add_option("--camera", options.camera,
                 "HEADING,PITCH,DISTANCE: direction of view (degrees, 0 north, 90 east), angle downward (degrees) and "
                 "distance (metres); default: chosen to suit the scene")
      ->delimiter(',')
      ->expected(3);

  const std::string picture = "Write a picture instead of opening a window";
  auto* const screenshot =
      app.add_option("--screenshot", options.screenshot, "Write a picture to FILE.png or FILE.jpg, and end")
          ->check(check_picture_name)
          ->group(picture);
  app.add_option("--frames", options.frames, "Take the picture after this many frames with a pose from the stream")
      ->needs(screenshot)
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000))
      ->group(picture);
  app.add_option("--at", options.at_s, "Take it this long after the first pose came: 90 (seconds), 5min")
      ->needs(screenshot)
      ->type_name("TIME")
      ->transform(CLI::Validator(duration_to_seconds, ""))
      ->check(CLI::Range(0.0, 1e6))
      ->group(picture);
  app.add_option("--wait", options.wait_s, "Give up when no pose has come after this time: 90 (seconds), 5min")
      ->needs(screenshot)
      ->capture_default_str()
      ->type_name("TIME")
      ->transform(CLI::Validator(duration_to_seconds, ""))
      ->check(CLI::Range(0.0, 1e6))
      ->group(picture);

  app.footer(
      "In the window: drag to turn (left button) or move (right), scroll to zoom; R first view, N next scene alone "
      "(after\n"
      "the last, all), T turn slowly, H overlay, P panel of values, F11 full screen, Esc or Q quit. If the stream is "
      "interrupted, its "
      "last\n"
      "seconds are replayed until it returns.\n"
      "\n"
      "Examples:\n"
      "  yuragi run &                                    the daemon, with a synthetic wind\n"
      "  yuragi-viewer                                   show it\n"
      "  yuragi-viewer --connect wall.local:7410 --fullscreen --no-overlay\n"
      "  yuragi-viewer --screenshot now.png              a picture; needs no screen\n"
      "\n"
      "Exit code 0: done; 64: wrong command line; 69: no daemon answers, or nothing to draw on; 73: the picture "
      "cannot be\n"
      "written.");
}

}  // namespace yuragi::viewer
