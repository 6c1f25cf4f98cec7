#include "tests/viewer/stream/simulated_playback.hpp"

#include <array>

#include <gtest/gtest.h>

#include "viewer/stream/pose_track.hpp"

namespace yuragi::viewer::stream {
namespace {

constexpr std::array kStreamRates_hz{30.0, 60.0, 120.0};
constexpr std::array kDisplayRates_hz{24.0, 50.0, 60.0, 120.0, 144.0};
constexpr double kSettling_s = 20.0;
constexpr double kDuration_s = 60.0;

TEST(Playback, IsEvenAtEveryRateOfADisplayWhereverFramesComeWithJitterOrDrift) {
  const std::array networks{Network{}, Network{.name = "5 ms", .jitter_s = 0.005},
                            Network{.name = "20 ms", .jitter_s = 0.020},
                            Network{.name = "fast", .jitter_s = 0.002, .drift_ppm = 200.0},
                            Network{.name = "slow", .jitter_s = 0.002, .drift_ppm = -200.0}};
  for (const Network& network : networks) {
    for (const double stream_hz : kStreamRates_hz) {
      for (const double display_hz : kDisplayRates_hz) {
        SCOPED_TRACE(testing::Message() << network.name << ", " << stream_hz << " Hz on " << display_hz << " Hz");
        const PlaybackFigures seen = simulate_playback(network, stream_hz, display_hz, kSettling_s, kDuration_s);
        EXPECT_EQ(seen.repeated, 0U);
        EXPECT_EQ(seen.backward, 0U);
        EXPECT_LE(seen.largest_step_error, 0.01);
        EXPECT_LE(seen.largest_pose_error, 0.015);  // of this a straight line between frames at 30 Hz is 0.0055
        const double needed_s = network.latency_s + network.jitter_s + 1.5 / stream_hz;
        EXPECT_LE(seen.median_delay_s, needed_s + 0.001);
        EXPECT_LE(seen.longest_delay_s, needed_s + 0.002);
      }
    }
  }
}

TEST(Playback, GoesOnWhereFramesAreLost) {
  for (const double stream_hz : kStreamRates_hz) {
    for (const double display_hz : kDisplayRates_hz) {
      SCOPED_TRACE(testing::Message() << stream_hz << " Hz on " << display_hz << " Hz");
      const PlaybackFigures seen = simulate_playback({.name = "a tenth lost", .jitter_s = 0.005, .lost_share = 0.1},
                                                     stream_hz, display_hz, kSettling_s, kDuration_s);
      // Three frames in a row may be lost where for a minute no two were.
      EXPECT_LE(seen.repeated * 1000, seen.pictures);
      EXPECT_EQ(seen.backward, 0U);
      EXPECT_LE(seen.typical_step_error, 0.1);
      EXPECT_LE(seen.longest_delay_s, 0.013 + 0.005 + 5.0 / stream_hz);
    }
  }
}

TEST(Playback, NeverGoesBackNorJumpsWhenFramesComeAtOnceAfterASilence) {
  for (const double silence_s : {0.15, 0.3, 0.45}) {
    for (const double stream_hz : kStreamRates_hz) {
      for (const double display_hz : kDisplayRates_hz) {
        SCOPED_TRACE(testing::Message() << silence_s << " s, " << stream_hz << " Hz on " << display_hz << " Hz");
        const PlaybackFigures seen = simulate_playback(
            {.name = "silence", .silence_every_s = 10.0, .silence_s = silence_s}, stream_hz, display_hz, 2.0, 60.0);
        EXPECT_EQ(seen.backward, 0U);
        EXPECT_LE(seen.largest_step_error, 1.0 + 1e-6) << "it stands, or plays on at a rate of at most kMaxPlayRate";
        EXPECT_LE(seen.longest_delay_s, 0.013 + silence_s + 2.5 / stream_hz);
      }
    }
  }
}

TEST(Playback, ComesNearerAgainWhenASilenceIsLongPast) {
  const double silence_ends_s = 100.0;
  const PlaybackFigures seen =
      simulate_playback({.name = "silence", .silence_every_s = silence_ends_s, .silence_s = 0.3}, 60.0, 60.0,
                        silence_ends_s + 40.0, 50.0);
  EXPECT_LE(seen.longest_delay_s, 0.013 + 1.5 / 60.0 + 0.008);
  EXPECT_EQ(seen.repeated, 0U);
  EXPECT_LE(seen.largest_step_error, 0.01);
}

}  // namespace
}  // namespace yuragi::viewer::stream
