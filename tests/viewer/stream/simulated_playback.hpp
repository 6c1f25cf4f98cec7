#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace yuragi::viewer::stream {

/// How frames come from the sender to the viewer. In order, as TCP delivers them: a late frame holds up those behind
/// it.
struct Network {
  std::string name = "even";
  double jitter_s = 0.0;         ///< each frame is late by 0 to this, evenly distributed
  double silence_every_s = 0.0;  ///< so often nothing comes for silence_s, and then all at once; 0: never
  double silence_s = 0.0;
  double lost_share = 0.0;   ///< of the frames, those that never come
  double drift_ppm = 0.0;    ///< the sender's clock runs faster than the viewer's by so much
  double latency_s = 0.013;  ///< of a frame that is not late
};

/// What a person would see of a stream whose true motion is known.
struct PlaybackFigures {
  double median_delay_s = 0.0;  ///< from the moment a pose is of to its picture
  double longest_delay_s = 0.0;
  double typical_step_error =
      0.0;  ///< p99 of how much the shown time's step differs from the display's, in display intervals
  double largest_step_error = 0.0;  ///< the same, of the worst picture
  double largest_pose_error =
      0.0;  ///< against the true pose at (picture's time - median delay), for a motion of 1 at 1 Hz
  std::size_t pictures = 0;
  std::size_t repeated = 0;  ///< pictures of the same moment as the one before
  std::size_t backward = 0;  ///< of an earlier one
};

/// Streams a pose that swings as sin(2 pi t) through `network` at `stream_hz` into a SceneTimeline, shows pictures of
/// it at `display_hz` for `duration_s` behind the first `settling_s`, and measures. All time is simulated. `seed`
/// decides which frames are late or lost.
PlaybackFigures simulate_playback(const Network& network, double stream_hz, double display_hz, double settling_s,
                                  double duration_s, std::uint64_t seed = 1);

}  // namespace yuragi::viewer::stream
