// What a person would see of a stream through good and bad networks, at every rate of a display: a table in Markdown,
// in simulated time.
#include <array>

#include <fmt/format.h>

#include "tests/viewer/stream/simulated_playback.hpp"

int main() {
  using namespace yuragi::viewer::stream;
  const std::array networks{Network{.name = "even"},
                            Network{.name = "jitter of 5 ms", .jitter_s = 0.005},
                            Network{.name = "jitter of 20 ms", .jitter_s = 0.020},
                            Network{.name = "200 ppm fast", .jitter_s = 0.002, .drift_ppm = 200.0},
                            Network{.name = "200 ppm slow", .jitter_s = 0.002, .drift_ppm = -200.0},
                            Network{.name = "a tenth lost", .jitter_s = 0.005, .lost_share = 0.1},
                            Network{.name = "150 ms of silence each 10 s", .silence_every_s = 10.0, .silence_s = 0.15},
                            Network{.name = "300 ms of silence each 10 s", .silence_every_s = 10.0, .silence_s = 0.3}};
  fmt::print(
      "| network | stream | display | delay (longest), ms | step error p99 (max) | pose error | repeated | back |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Network& network : networks) {
    for (const double stream_hz : {30.0, 60.0, 120.0}) {
      for (const double display_hz : {24.0, 50.0, 60.0, 120.0, 144.0}) {
        const PlaybackFigures seen = simulate_playback(network, stream_hz, display_hz, 20.0, 120.0);
        fmt::print("| {} | {:.0f} | {:.0f} | {:.1f} ({:.1f}) | {:.3f} ({:.3f}) | {:.4f} | {} | {} |\n", network.name,
                   stream_hz, display_hz, 1e3 * seen.median_delay_s, 1e3 * seen.longest_delay_s,
                   seen.typical_step_error, seen.largest_step_error, seen.largest_pose_error, seen.repeated,
                   seen.backward);
      }
    }
  }
  return 0;
}
