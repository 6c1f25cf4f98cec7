#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace yuragi::viewer {

/// What an X server shows at a moment: all of its monitors as one picture.
struct ScreenPixels {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint32_t> rows;  ///< 0xRRGGBB, from the top down

  std::uint32_t at(int x, int y) const {
    return rows[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x)];
  }
};

/// A real X server, on a display number that it finds free itself. (xvfb-run -a guesses one, and may lose it to
/// another.) It ends with this, and with a test that crashes. Its desktop is white, so that what a viewer leaves
/// uncovered is seen. Nobody else has its keyboard and its mouse; there is no window manager.
class XServer {
 public:
  /// `words`: the program, Xvfb or Xorg, and its options.
  explicit XServer(std::vector<std::string> words);
  ~XServer();
  XServer(const XServer&) = delete;
  XServer& operator=(const XServer&) = delete;

  /// False where it has not started. Nothing of what follows may be called then.
  bool is_there() const { return display_ != nullptr; }

  /// Our own environment, and DISPLAY.
  std::vector<std::string> environment() const;

  ScreenPixels pixels() const;

  /// Presses a key and lets it go, for the window that is under the pointer. `key`: its name in X11/keysymdef.h without
  /// XK_: "F1", "space". False where this keyboard has no such key.
  bool type(const std::string& key) const;

  /// The pointer goes there, in pixels of the screen.
  void point(int x, int y) const;
  /// The left button of the mouse.
  void hold_button(bool is_down) const;

 private:
  struct Connection;  // Xlib's
  std::unique_ptr<Connection> display_;
  int server_ = 0;  // its process
  std::string number_;
};

}  // namespace yuragi::viewer
