#pragma once

#include <memory>

#include "engine/output/output.hpp"
#include "viewer/gl/render_target.hpp"

struct GLFWwindow;

namespace yuragi::viewer::wall {

/// The windows of an output, each of which fills its monitor with its part of the picture. A monitor that goes takes
/// its window with it, and gets it again when it is back; so does one that changes its size. No cursor is seen, and as
/// long as a window is there GLFW keeps the screen saver off. On the main thread.
class Wall {
 public:
  /// `first`: a hidden window whose context is current; the others share it, and give it what is typed. Throws
  /// FailureError (kUnavailable) with the list of monitors where one of the output's does not exist.
  Wall(GLFWwindow* first, const output::Output& output);
  ~Wall();
  Wall(const Wall&) = delete;
  Wall& operator=(const Wall&) = delete;

  /// Looks for monitors that have come, gone or changed, where the system has said so, and each second. After polling
  /// events.
  void follow_monitors(double now_s);

  /// Is there no monitor at all at the moment?
  bool is_dark() const;

  /// The size that the picture should have; that of before where there is no monitor.
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
