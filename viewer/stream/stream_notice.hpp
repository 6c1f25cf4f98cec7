#pragma once

#include <optional>
#include <string>

#include "viewer/stream/pose_timeline.hpp"
#include "viewer/stream/stream_connection.hpp"

namespace yuragi::viewer::stream {

/// The text shown instead of a picture until the first frame: what is wrong, and what to do. A failure is shown at
/// once; an attempt that neither fails nor brings a frame, after kPatience_s. The text stays until another replaces it
/// or frames arrive, so that it does not flicker during further attempts. After the first frame it is empty: a lost
/// stream is replayed. Not thread-safe.
class Notice {
 public:
  static constexpr double kPatience_s = 1.0;

  /// `now_s`: on any clock that only advances. Empty: there is nothing to show.
  const std::string& advance(double now_s, Playback playback, const Status& status);

 private:
  std::string text_;
  std::string status_text_;
  std::optional<double> since_s_;  // of this status
};

}  // namespace yuragi::viewer::stream
