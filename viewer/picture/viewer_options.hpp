#pragma once

#include <optional>
#include <string>
#include <vector>

namespace yuragi::viewer::picture {

/// The command line's options.
struct ViewerOptions {
  std::string connect = "127.0.0.1:7410";
  std::string size = "1280x720";
  int width_px = 1280;
  int height_px = 720;
  std::optional<int> samples;      ///< unset: chosen for the graphics hardware
  std::optional<bool> overlay;     ///< unset: in windows yes, in pictures no
  bool has_panel = false;          ///< shown from the start
  std::vector<std::string> shown;  ///< panels shown from the start: "help", "profiler", "wind"
  std::optional<double> scale;     ///< of the overlay; unset: chosen for the monitor
  bool is_fullscreen = false;
  std::optional<int> monitor;
  std::string config;           ///< a file: one of its outputs is shown, or its scenes are filmed; empty: none
  std::string output;           ///< its name; empty: the first
  bool has_test_card = false;   ///< instead of the picture
  bool lists_monitors = false;  ///< and no more
  bool logs_age = false;        ///< logs the age of the readings in the pictures
  std::string swaps;            ///< a file that gets a line for each picture; empty: none
  bool is_turning = false;
  bool is_dark_when_closed = false;
  std::vector<std::string> look;  ///< "time=06:30": overrides the daemon's look
  std::string scene;              ///< the only one to show; empty: all
  std::string camera;             ///< a name of the daemon's, or read_camera_view(); empty: the hour's, or chosen
  std::string screenshot;         ///< a file; empty: a window
  int frames = 30;
  std::optional<double> at_s;
  double wait_s = 10.0;

  std::string render;  ///< a recording to film; empty: none
  bool is_as_recorded = false;
  std::string from;                  ///< as `yuragi replay --start`
  std::string states;                ///< as `yuragi replay --states`
  std::optional<double> duration_s;  ///< of the film; unset: to the recording's end
  double fps = 30.0;                 ///< pictures a second
  std::string out;                   ///< make_film_output()
  bool draws_nothing = false;

  friend bool operator==(const ViewerOptions&, const ViewerOptions&) = default;
};

}  // namespace yuragi::viewer::picture
