#pragma once

#include <memory>

#include "engine/output/output.hpp"
#include "viewer/gl/render_target.hpp"

struct GLFWwindow;

namespace yuragi::viewer::wall {

/// The windows of an output, each of which fills its monitor with its part of the picture. The window of a monitor that
/// is disconnected is closed, and opened again when it returns; also if its size changes. The cursor is hidden, and
/// while there is a window GLFW disables the screen saver. On the main thread.
class Wall {
 public:
  /// `first`: a hidden window whose context is current; the others share it, and pass typed keys to it. Throws
  /// FailureError (kUnavailable) with the list of monitors if one of the output's does not exist.
  Wall(GLFWwindow* first, const output::Output& output);
  ~Wall();
  Wall(const Wall&) = delete;
  Wall& operator=(const Wall&) = delete;

  /// Checks for monitors that were connected, disconnected or changed, when the system reports it, and each second.
  /// Call after polling events.
  void follow_monitors(double now_s);

  /// Returns true if there is no monitor at present.
  bool is_dark() const;

  /// The required size of the picture; the previous one if there is no monitor.
  output::Size picture_size() const;

  /// The time between two pictures by the displays, s.
  double picture_interval_s() const;

  /// Shows the resolved pixels of `target` on all monitors; waits for the refresh of the first. `is_marked`: with the
  /// borders of crops and strips, for a test card. Leaves the context of the first window current.
  void show(const gl::RenderTarget& target, bool is_marked);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace yuragi::viewer::wall
