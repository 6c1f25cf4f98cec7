#pragma once

#include <atomic>
#include <memory>

#include "viewer/picture/viewer_options.hpp"

namespace yuragi::viewer::app {

/// The viewer's main loop: shows in a window, or writes to a picture file, what a daemon streams. On the main thread;
/// throws ViewerExit.
class Viewer {
 public:
  /// `is_stopping`: set by a signal handler, ends run() at the next picture; must outlive this.
  Viewer(const picture::ViewerOptions& options, const std::atomic<bool>& is_stopping);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Returns when the window is closed, the picture is written, or `is_stopping` is set.
  void run();

 private:
  class Show;
  std::unique_ptr<Show> show_;
  bool is_picture_ = false;
};

}  // namespace yuragi::viewer::app
