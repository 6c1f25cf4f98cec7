#include "viewer/app/command_line.hpp"

#include <charconv>
#include <cstdint>
#include <span>
#include <string>

#include "engine/base/duration.hpp"
#include "engine/look/look.hpp"
#include "viewer/film/film_output.hpp"
#include "viewer/picture/camera_view.hpp"
#include "viewer/picture/picture_file.hpp"

namespace yuragi::viewer::app {
namespace {

constexpr int kMaxSide_px = 16384;

/// Reads "1280x720". Returns the error, or an empty text.
std::string read_size(const std::string& text, picture::ViewerOptions& options) {
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

/// Returns the error in the name of a picture file, or an empty text.
std::string check_picture_name(const std::string& name) {
  if (picture::picture_format(name)) return {};
  return "'" + name + "' is not the name of a picture that can be written: it has to end in .png, .jpg or .jpeg";
}

/// A text of numbers and commas that is not a valid view is rejected, and not taken for a camera's name.
std::string check_camera(const std::string& text) {
  const bool is_numbers = text.find_first_not_of("0123456789.,+-eE ") == std::string::npos;
  if (!text.empty() && (!is_numbers || text.find(',') == std::string::npos || picture::read_camera_view(text)))
    return {};
  return "'" + text + "' is not a view: give HEADING,PITCH,DISTANCE, such as 225,7,4, or the name of a camera";
}

void add_film_options(CLI::App& app, picture::ViewerOptions& options) {
  const std::string film = "Make a film of a recording, without a display and without a daemon";
  auto* const render =
      app.add_option("--render", options.render, "Play FILE.windlog tick by tick, and draw each picture")
          ->type_name("FILE.windlog")
          ->group(film);
  for (const char* other : {"--connect", "--screenshot", "--fullscreen", "--monitor", "--overlay", "--panel", "--show",
                            "--dark-when-closed", "--output", "--test-card", "--age", "--swaps"}) {
    render->excludes(other);
  }
  auto* const out =
      app.add_option("--out", options.out,
                     "FILE.mp4 (needs ffmpeg), a folder for 000001.png and so on, or - for standard output "
                     "(RGB, 3 bytes a pixel)")
          ->needs(render)
          ->check(film::check_film_name)
          ->group(film);
  render->needs(out);
  app.add_option("--fps", options.fps, "Pictures a second of the recording's time")
      ->needs(render)
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1000.0))
      ->group(film);
  app.add_option("--from", options.from, "Where to begin: seconds from its beginning, or a UTC time (ISO 8601)")
      ->needs(render)
      ->type_name("T")
      ->group(film);
  app.add_option("--states", options.states,
                 "Let the scenes move from the recording's beginning on, so that films of its parts join; their state "
                 "at each minute is kept in this folder")
      ->needs(render)
      ->type_name("FOLDER")
      ->group(film);
  app.add_option("--duration", options.duration_s, "How long: 20 (seconds), 5min; default: to the recording's end")
      ->needs(render)
      ->type_name("TIME")
      ->transform(CLI::Validator(duration_to_seconds, ""))
      ->check(CLI::Range(0.001, 1e6))
      ->group(film);
  app.add_flag("--as-recorded", options.is_as_recorded, "Use the configuration and all sensors of the recording")
      ->needs(render)
      ->excludes("--config")
      ->excludes("--states")
      ->group(film);
  app.add_flag("--draw-nothing", options.draws_nothing,
               "Write black pictures, on a machine without OpenGL or for tests")
      ->needs(render)
      ->group(film);
}

}  // namespace

void add_options(CLI::App& app, picture::ViewerOptions& options) {
  app.add_option("--connect", options.connect, "The daemon whose stream to show, HOST:PORT")->capture_default_str();
  app.add_option("--size", options.size, "Size of the window or picture, WIDTHxHEIGHT in pixels")
      ->capture_default_str()
      ->check([&options](const std::string& text) { return read_size(text, options); });
  app.add_option("--samples", options.samples,
                 "Samples per pixel (antialiasing); default 4, or 1 in a window without graphics hardware")
      ->check(CLI::Range(1, 16));
  // Not add_flag(): with an optional, CLI11 sets it to 0 immediately.
  app.add_flag_function(
      "--overlay,!--no-overlay", [&options](std::int64_t count) { options.overlay = count > 0; },
      "Show wind, sensors and stream over the picture (default in windows)");
  app.add_flag("--panel", options.has_panel,
               "Show the panel that lists and sets the values of the daemon's [look] and scenes (P)");
  app.add_option("--show", options.shown,
                 "Also show this from the start: help (F1), profiler (F3) or wind (F4); repeatable")
      ->allow_extra_args(false)
      ->type_name("PANEL")
      ->check(CLI::IsMember({"help", "profiler", "wind"}));
  app.add_option("--scale", options.scale, "Scale of the overlay's texts; default: chosen for the monitor")
      ->check(CLI::Range(0.25, 8.0));
  app.add_flag("--fullscreen", options.is_fullscreen, "Fill the screen");
  app.add_flag("--dark-when-closed", options.is_dark_when_closed,
               "Fade to black outside of the daemon's opening hours ([shaping] hours)");
  app.add_option("--monitor", options.monitor, "Which screen to use, counted from 0")->check(CLI::NonNegativeNumber);
  auto* const config = app.add_option("--config", options.config,
                                      "A configuration of Yuragi, for its [[output]] or, with --render, for its scenes")
                           ->type_name("FILE.toml");
  app.add_option("--output", options.output, "The name of the [[output]] to show; default: the first")
      ->needs(config)
      ->type_name("NAME");
  app.add_flag("--test-card", options.has_test_card, "Show a test picture to set up an [[output]]; needs no daemon");
  app.add_flag(
      "--age", options.logs_age,
      "Log the age of the sensor's reading when its picture was shown, and how well the delay of [[output]] is "
      "kept, every 10 s and at the end");
  app.add_flag("--list-monitors", options.lists_monitors, "List the monitors by number and name, and end");
  app.add_flag("--turn", options.is_turning, "Turn the camera slowly");
  app.add_option("--scene", options.scene, "Show only the scene of this name");
  app.add_option("--look", options.look,
                 "KEY=VALUE: overrides a value of the daemon's [look], such as time=06:30 or clouds=1; repeatable")
      ->allow_extra_args(false)
      ->check([](const std::string& edit) {
        const auto look = look::edited({}, std::span(&edit, 1));
        return look ? std::string() : look.error().name + " " + look.error().message;
      });
  app.add_option("--camera", options.camera,
                 "NAME of a [[camera]] of the daemon, or HEADING,PITCH,DISTANCE: direction of view (degrees, 0 north, "
                 "90 east), angle downward (degrees), distance (metres); default: by the time of day")
      ->check(check_camera);

  const std::string picture = "Write a picture instead of opening a window";
  auto* const screenshot =
      app.add_option("--screenshot", options.screenshot, "Write a picture to FILE.png or FILE.jpg, and end")
          ->check(check_picture_name)
          ->group(picture);
  app.add_option("--swaps", options.swaps,
                 "Write a line to FILE for each picture shown: its UTC in nanoseconds and the tick of its frame, to "
                 "compare the screens of a wall")
      ->excludes(screenshot);
  app.add_option("--frames", options.frames, "Take the picture after this many frames with a pose from the stream")
      ->needs(screenshot)
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000))
      ->group(picture);
  app.add_option("--at", options.at_s, "Take it this long after the first pose: 90 (seconds), 5min")
      ->needs(screenshot)
      ->type_name("TIME")
      ->transform(CLI::Validator(duration_to_seconds, ""))
      ->check(CLI::Range(0.0, 1e6))
      ->group(picture);
  app.add_option("--wait", options.wait_s, "Give up after this time without a pose: 90 (seconds), 5min")
      ->needs(screenshot)
      ->capture_default_str()
      ->type_name("TIME")
      ->transform(CLI::Validator(duration_to_seconds, ""))
      ->check(CLI::Range(0.0, 1e6))
      ->group(picture);

  add_film_options(app, options);

  app.footer(
      "In the window: F1 lists all keys; drag to turn (left button) or move (right), scroll to zoom. If the stream\n"
      "is interrupted, its last seconds are replayed until it returns. The panel can change values of a daemon with a\n"
      "token_file if the environment variable YURAGI_TOKEN_FILE names a copy of that file.\n"
      "\n"
      "Examples:\n"
      "  yuragi run &                                    the daemon, with a synthetic wind\n"
      "  yuragi-viewer                                   show it\n"
      "  yuragi-viewer --connect wall.local:7410 --fullscreen --no-overlay\n"
      "  yuragi-viewer --config wall.toml --test-card    set up the monitors and projectors of its [[output]]\n"
      "  yuragi-viewer --screenshot now.png              a picture; needs no screen\n"
      "  yuragi-viewer --camera night                    by one of the daemon's cameras, at any hour\n"
      "  yuragi-viewer --render storm.windlog --out storm.mp4 --size 1920x1080 --fps 60 --duration 20\n"
      "  yuragi-viewer --render storm.windlog --config garden.toml --scene flag --look quality=low --out pictures\n"
      "\n"
      "A film shows every tick of the recording, however long a picture takes, in full detail (--look quality=high)\n"
      "unless another quality is given. The same recording, configuration and driver give the same pictures.\n"
      "\n"
      "Exit code 0: done; 64: wrong command line; 66: the configuration cannot be read; 69: no daemon replies, no\n"
      "display or graphics driver, a monitor that is not connected, or no ffmpeg; 73: the picture or film cannot be\n"
      "written; 75: the graphics card was reset: start again; 78: a mistake in the configuration's outputs; 130: a\n"
      "film was interrupted. For a recording that cannot be played, the codes of `yuragi replay`.");
}

}  // namespace yuragi::viewer::app
