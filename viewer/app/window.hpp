#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/app/keys.hpp"

struct GLFWwindow;

namespace yuragi::viewer::app {

struct WindowOptions {
  int width_px = 1280;
  int height_px = 720;
  bool is_fullscreen = false;
  std::optional<int> monitor;  ///< for full screen, counted from 0; nullopt: the primary one
  bool is_hidden = false;      ///< hidden at first, and without a frame: for a wall (viewer/wall), which places it
};

/// The user's input since the last take_input(). Drags are shares of the window's height.
struct WindowInput {
  double orbit_right = 0.0;
  double orbit_down = 0.0;
  double pan_right = 0.0;
  double pan_down = 0.0;
  double zoom_notches = 0.0;
  std::vector<Key> keys;  ///< pressed keys, in their order

  bool moves_camera() const {
    return orbit_right != 0.0 || orbit_down != 0.0 || pan_right != 0.0 || pan_down != 0.0 || zoom_notches != 0.0;
  }
};

struct PixelSize {
  int width_px = 0;
  int height_px = 0;
  bool is_empty() const { return width_px <= 0 || height_px <= 0; }
  friend bool operator==(const PixelSize&, const PixelSize&) = default;
};

/// A window with a current OpenGL context, the newest that there is. One at a time, on the main thread. Throws
/// ViewerExit (EX_UNAVAILABLE) if there is no display, or if the driver is not gl::is_enough().
class Window {
 public:
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const;
  bool is_closing() const;
  void close();
  /// Switches to full screen and back; a window of a wall keeps its place.
  void toggle_fullscreen();

  /// The size of the framebuffer, in pixels; empty while the window is minimised.
  PixelSize framebuffer_size() const;
  /// Pixels of this screen for each point of a text's size: 2 on a screen of high resolution.
  double content_scale() const;
  /// Refresh rate of the screen; 60 if it is unknown.
  double refresh_rate_hz() const;

  /// Handles pending events.
  void poll();
  /// Waits for an event, for at most limit_s, and handles it.
  void wait(double limit_s);
  WindowInput take_input();

  /// From now on mouse or keys are meant for the overlay: take_input() does not return them, and keys do not close the
  /// window.
  void set_taken(bool is_mouse_taken, bool are_keys_taken);

  /// Shows what was drawn; waits for the screen's refresh if the driver can.
  void swap();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The monitors of this display, one line each (viewer/wall/monitors.hpp). Call before making any window. Throws
/// ViewerExit (EX_UNAVAILABLE) if there is no display.
std::string list_monitors();

}  // namespace yuragi::viewer::app
