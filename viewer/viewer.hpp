#pragma once

#include <atomic>
#include <memory>

#include "viewer/options.hpp"

namespace yuragi {

/// The program: a window (or a picture) of what a daemon streams. On the main thread; throws ViewerExit.
class Viewer {
 public:
  /// `is_stopping` is set by someone else (a signal) to end run() at the next picture.
  Viewer(const ViewerOptions& options, const std::atomic<bool>& is_stopping);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Until the window is closed, or the picture is written, or `is_stopping`.
  void run();

 private:
  class Show;
  std::unique_ptr<Show> show_;
  bool is_picture_ = false;
};

}  // namespace yuragi
