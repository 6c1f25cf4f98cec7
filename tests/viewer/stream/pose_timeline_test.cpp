#include "viewer/stream/pose_timeline.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi::viewer::stream {
namespace {

constexpr double kTick_s = 1.0 / 60.0;
constexpr double kLatency_s = 0.013;   // of every frame that is not late
constexpr double kSenderEpoch_s = 40;  // the sender's clock against ours

wire::SceneModel meadow(std::size_t strands) {
  pose::StrandSkeleton skeleton;
  skeleton.strand_count = strands;
  skeleton.links_per_strand = 2;
  skeleton.root_x_m.resize(skeleton.padded_count());
  return {"meadow", "grass", skeleton};
}

float first_bend(const PoseMoment& moment) {
  return std::get<pose::StrandPose>(moment.poses.at(0)).bend_east_rad.at(0);
}

/// A timeline, a sender whose first strand bends by bend_at(sender's time), and a screen, moved on by hand.
class Theatre {
 public:
  explicit Theatre(std::function<double(double)> bend_at, std::size_t strands = 3)
      : bend_at_(std::move(bend_at)), strands_(strands) {
    const std::array scenes{meadow(strands)};
    timeline.set_scenes(scenes);
  }

  wire::Frame frame(double sender_s) const {
    wire::Frame frame;
    frame.info.time_s = sender_s;
    const auto bend = static_cast<float>(bend_at_(sender_s));
    const std::vector<float> bends(pose::padded_to_blocks(strands_), bend);
    frame.poses.emplace_back(pose::StrandPose{bends, bends});
    frame.opacities.push_back(1.0F);
    return frame;
  }

  bool send(double sender_s, double arrival_s) {
    wire::Frame made = frame(sender_s);
    return timeline.accept(made, arrival_s);
  }

  /// Shows pictures and sends a frame a tick for duration_s. `arrives(n)` says how late frame n comes; below 0: never.
  void run(
      double duration_s, const std::function<double(std::uint64_t)>& arrives = [](auto) { return 0.0; },
      double screen_dt_s = 1.0 / 144.0) {
    const double end_s = now_s + duration_s;
    while (now_s < end_s) {
      now_s += screen_dt_s;
      deliver(arrives);
      show();
    }
  }

  /// The sender dies, for this long.
  void stop(double duration_s) {
    run(duration_s, [](auto) { return -1.0; });
  }

  /// It dies, and begins its time at 0, now.
  void restart_sender() {
    next_frame_ = 0;
    sender_offset_s = now_s;
  }

  double now_s = 100.0;
  double sender_offset_s = 100.0 - kSenderEpoch_s;  // ours - the sender's
  PoseTimeline timeline;
  double largest_step = 0.0;          // of the bend between two pictures
  double largest_speed_change = 0.0;  // of its rate, rad/s, between two pictures
  double last_bend = 0.0;

 private:
  void deliver(const std::function<double(std::uint64_t)>& arrives) {
    // In order, as TCP delivers: a late frame holds up those behind it.
    for (;;) {
      const double sender_s = kTick_s * static_cast<double>(next_frame_);
      const double lateness_s = arrives(next_frame_);
      const double arrival_s = sender_s + sender_offset_s + kLatency_s + std::max(0.0, lateness_s);
      if (arrival_s > now_s) return;
      const bool is_lost = lateness_s < 0.0;
      EXPECT_TRUE(is_lost || send(sender_s, std::max(arrival_s, last_arrival_s_)));
      last_arrival_s_ = std::max(arrival_s, last_arrival_s_);
      ++next_frame_;
    }
  }

  void show() {
    const double bend = static_cast<double>(first_bend(timeline.advance(now_s)));
    EXPECT_TRUE(std::isfinite(bend));
    if (pictures_ > 0) largest_step = std::max(largest_step, std::abs(bend - last_bend));
    if (pictures_ > 1)
      largest_speed_change = std::max(largest_speed_change, std::abs(bend - 2 * last_bend + bend_before_));
    bend_before_ = last_bend;
    last_bend = bend;
    ++pictures_;
  }

  std::function<double(double)> bend_at_;
  std::size_t strands_;
  std::uint64_t next_frame_ = static_cast<std::uint64_t>(kSenderEpoch_s / kTick_s);
  double last_arrival_s_ = 0.0;
  double bend_before_ = 0.0;
  std::size_t pictures_ = 0;
};

// A swaying bend, its greatest speed, and the step that a picture of screen_dt_s may make of it: the shown moment moves
// by at most kMaxPlayRate of the time passed, and a fade passes over from one bend to another at 1.5 of their
// difference a kFade_s (the steepest slope of smoothstep).
constexpr double kSwing_rad = 0.8;
constexpr double kSwing_hz = 0.4;
double sway(double sender_s) {
  return kSwing_rad * std::sin(2 * std::numbers::pi * kSwing_hz * sender_s);
}
constexpr double kSwayRate_1_s = kSwing_rad * 2 * std::numbers::pi * kSwing_hz;
constexpr double live_step_bound(double screen_dt_s) {
  return PoseTrack::kMaxPlayRate * kSwayRate_1_s * screen_dt_s + 1e-5;
}
constexpr double fade_step_bound(double screen_dt_s) {
  return live_step_bound(screen_dt_s) + 1.5 / PoseTimeline::kFade_s * 2 * kSwing_rad * screen_dt_s;
}

TEST(PoseTimeline, ShowsTheRestPoseBeforeTheFirstFrame) {
  Theatre theatre(sway);
  EXPECT_EQ(first_bend(theatre.timeline.advance(100.0)), 0.0F);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kNothing);
}

TEST(PoseTimeline, InterpolatesLinearMotionExactly) {
  Theatre theatre([](double sender_s) { return 0.25 * (sender_s - kSenderEpoch_s); });
  theatre.run(3.0);
  for (int i = 0; i < 200; ++i) {
    theatre.run(
        0.005, [](auto) { return 0.0; }, 0.005);
    const PoseMoment& shown = theatre.timeline.advance(theatre.now_s);
    EXPECT_NEAR(first_bend(shown), 0.25 * (shown.time_s - kSenderEpoch_s), 1e-6);
  }
}

TEST(PoseTimeline, StaysAboutOneAndAHalfFramesBehindAnEvenStream) {
  Theatre theatre([](double sender_s) { return sender_s; });
  theatre.run(5.0);
  const double shown_s = theatre.timeline.advance(theatre.now_s).time_s;
  const double behind_s = theatre.now_s - theatre.sender_offset_s - kLatency_s - shown_s;
  EXPECT_NEAR(behind_s, 1.5 * kTick_s, 0.15 * kTick_s);
}

TEST(PoseTimeline, NeverGoesBackWhileTheStreamIsLive) {
  Theatre theatre([](double sender_s) { return sender_s; });
  double last_s = -1e9;
  for (int i = 0; i < 1000; ++i) {
    theatre.run(
        0.007, [](std::uint64_t n) { return n % 17 == 0 ? 0.06 : 0.0; }, 0.007);
    const double shown_s = theatre.timeline.advance(theatre.now_s).time_s;
    EXPECT_GE(shown_s, last_s);
    last_s = shown_s;
  }
}

TEST(PoseTimeline, DoesNotJumpWhenFramesAreLate) {
  Theatre theatre(sway);
  theatre.run(10.0, [](std::uint64_t n) { return n % 50 == 0 ? 0.12 : (n % 3 == 0 ? 0.01 : 0.0); });
  EXPECT_LE(theatre.largest_step, live_step_bound(1.0 / 144.0));
  EXPECT_EQ(theatre.timeline.playback(), Playback::kLive);
}

TEST(PoseTimeline, DoesNotJumpWhenFramesAreLost) {
  Theatre theatre(sway);
  theatre.run(10.0, [](std::uint64_t n) { return n % 7 < 3 ? -1.0 : 0.0; });
  EXPECT_LE(theatre.largest_step, live_step_bound(1.0 / 144.0));
  EXPECT_EQ(theatre.timeline.playback(), Playback::kLive);
}

TEST(PoseTimeline, FollowsASendersClockThatRunsFast) {
  // 200 ppm over ten minutes would be 120 ms.
  Theatre theatre([](double sender_s) { return sender_s; });
  theatre.run(2.0);
  for (int i = 0; i < 600; ++i) {
    theatre.sender_offset_s -= 0.0002;
    theatre.run(
        1.0, [](auto) { return 0.0; }, 1.0 / 30.0);
  }
  const double shown_s = theatre.timeline.advance(theatre.now_s).time_s;
  EXPECT_NEAR(theatre.now_s - theatre.sender_offset_s - kLatency_s - shown_s, 1.5 * kTick_s, kTick_s);
}

TEST(PoseTimeline, KeepsMovingWithoutAJumpWhenTheStreamStops) {
  Theatre theatre(sway);
  theatre.run(6.0);
  theatre.stop(1.0);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kReplaying);

  // Through several turns: it moves, within what it showed before.
  theatre.largest_speed_change = 0.0;
  double low = 1e9;
  double high = -1e9;
  for (int i = 0; i < 3000; ++i) {
    theatre.stop(0.01);
    low = std::min(low, theatre.last_bend);
    high = std::max(high, theatre.last_bend);
  }
  EXPECT_LE(theatre.largest_step, live_step_bound(1.0 / 144.0));
  EXPECT_GT(high - low, kSwing_rad);
  EXPECT_LE(high, kSwing_rad);
  EXPECT_GE(low, -kSwing_rad);

  // At the turns time slows to rest (at 1/s): the speed never jumps. Bound of d2(bend)/dt2: s'' + rate'' .
  constexpr double kAcceleration = kSwayRate_1_s * 1.0 + kSwayRate_1_s * 2 * std::numbers::pi * kSwing_hz;
  EXPECT_LE(theatre.largest_speed_change, 2 * kAcceleration / (144.0 * 144.0) + 1e-5);
}

TEST(PoseTimeline, PassesOverToTheStreamWhenItReturns) {
  Theatre theatre(sway);
  theatre.run(6.0);
  theatre.stop(7.3);
  theatre.run(0.3);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kReturning);
  theatre.run(3.0);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kLive);
  EXPECT_LE(theatre.largest_step, fade_step_bound(1.0 / 144.0));
  EXPECT_NEAR(theatre.last_bend, sway(theatre.timeline.advance(theatre.now_s).time_s), 0.01);
}

TEST(PoseTimeline, PassesOverToARestartedSenderWhoseTimeBeginsAgain) {
  Theatre theatre(sway);
  theatre.run(6.0);
  theatre.stop(1.0);
  const std::array scenes{meadow(3)};
  theatre.timeline.set_scenes(scenes);

  // The new run's first frames come from the sender's second 0.
  double last = theatre.last_bend;
  for (int i = 0; i < 200; ++i) {
    theatre.now_s += kTick_s;
    EXPECT_TRUE(theatre.send(kTick_s * i, theatre.now_s));
    const double bend = static_cast<double>(first_bend(theatre.timeline.advance(theatre.now_s)));
    EXPECT_LE(std::abs(bend - last), fade_step_bound(kTick_s));
    last = bend;
  }
  EXPECT_EQ(theatre.timeline.playback(), Playback::kLive);
  EXPECT_LT(theatre.timeline.advance(theatre.now_s).time_s, 4.0);
}

TEST(PoseTimeline, LivesForAnHourWithoutTheDaemonAndReturnsWithoutAJump) {
  Theatre theatre(sway);
  theatre.run(6.0);
  theatre.stop(3600.0);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kReplaying);
  EXPECT_LE(theatre.largest_step, live_step_bound(1.0 / 144.0));
  double low = theatre.last_bend;
  double high = theatre.last_bend;
  for (int i = 0; i < 100; ++i) {
    theatre.stop(0.1);
    low = std::min(low, theatre.last_bend);
    high = std::max(high, theatre.last_bend);
  }
  EXPECT_GT(high - low, kSwing_rad) << "it stands";

  // The daemon was started anew: its time begins again.
  theatre.restart_sender();
  theatre.run(0.3);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kReturning);
  theatre.run(3.0);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kLive);
  EXPECT_LE(theatre.largest_step, fade_step_bound(1.0 / 144.0));
  EXPECT_LE(theatre.timeline.delay_s(), 2.0 * kTick_s);
}

TEST(PoseTimeline, DoesNotJumpWhenTheStreamComesAndGoes) {
  Theatre theatre(sway);
  theatre.run(3.0);
  for (int i = 0; i < 40; ++i) {
    theatre.stop(0.1 + 0.05 * i);
    theatre.run(0.1 + 0.03 * (i % 7));
  }
  EXPECT_LE(theatre.largest_step, fade_step_bound(1.0 / 144.0));
  theatre.run(4.0);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kLive);
}

TEST(PoseTimeline, KeepsASingleFrameOnTheScreen) {
  Theatre theatre([](double) { return 0.5; });
  EXPECT_TRUE(theatre.send(1.0, 100.0));
  for (int i = 0; i < 100; ++i) {
    theatre.now_s += 0.1;
    EXPECT_FLOAT_EQ(first_bend(theatre.timeline.advance(theatre.now_s)), 0.5F);
  }
}

TEST(PoseTimeline, BlendsWindAsVectorsSoThatNorthIsCrossedOnTheShortWay) {
  Theatre theatre([](double) { return 0.0; });
  wire::Frame from_350 = theatre.frame(1.0);
  from_350.info.wind.wind = wind::wind_from(5.0, 350.0);
  wire::Frame from_10 = theatre.frame(1.1);
  from_10.info.wind.wind = wind::wind_from(5.0, 10.0);
  ASSERT_TRUE(theatre.timeline.accept(from_350, 100.0));
  ASSERT_TRUE(theatre.timeline.accept(from_10, 100.1));

  bool has_crossed = false;
  for (int i = 0; i < 200; ++i) {
    const wind::Vector wind = theatre.timeline.advance(100.1 + 0.002 * i).wind.wind;
    const double direction_deg = wind::direction_from_deg(wind);
    EXPECT_TRUE(direction_deg > 349.99 || direction_deg < 10.01) << direction_deg;
    EXPECT_GT(speed_of(wind), 4.9);
    has_crossed = has_crossed || direction_deg < 1.0 || direction_deg > 359.0;
  }
  EXPECT_TRUE(has_crossed);
}

TEST(PoseTimeline, RefusesFramesOfOtherScenes) {
  Theatre theatre(sway, 3);
  const Theatre other(sway, 40);
  wire::Frame wrong_size = other.frame(1.0);
  EXPECT_FALSE(theatre.timeline.accept(wrong_size, 100.0));
  wire::Frame wrong_count = theatre.frame(1.0);
  wrong_count.poses.push_back(wrong_count.poses.front());
  wrong_count.opacities.push_back(1.0F);
  EXPECT_FALSE(theatre.timeline.accept(wrong_count, 100.0));
  wire::Frame no_opacity = theatre.frame(1.0);
  no_opacity.opacities.clear();
  EXPECT_FALSE(theatre.timeline.accept(no_opacity, 100.0));
  wire::Frame no_time = theatre.frame(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(theatre.timeline.accept(no_time, 100.0));
  PoseTimeline without_scenes;
  wire::Frame empty;
  EXPECT_FALSE(without_scenes.accept(empty, 100.0));
}

TEST(PoseTimeline, StartsAnewFromTheRestPoseWithOtherScenes) {
  Theatre theatre(sway, 3);
  theatre.run(2.0);
  const std::array scenes{meadow(40)};
  theatre.timeline.set_scenes(scenes);
  EXPECT_EQ(theatre.timeline.playback(), Playback::kNothing);
  const PoseMoment& shown = theatre.timeline.advance(theatre.now_s);
  EXPECT_EQ(std::get<pose::StrandPose>(shown.poses.at(0)).bend_east_rad,
            std::vector<float>(pose::padded_to_blocks(40)));
}

TEST(PoseHistory, HoldsABoundedNumberOfMomentsAndExchangesBuffers) {
  const std::array scenes{meadow(3)};
  PoseMoment moment = rest_moment(scenes);
  PoseHistory history;
  history.reset(moment);
  ASSERT_EQ(history.capacity(), PoseHistory::kMaxMoments);
  for (std::size_t i = 0; i < 3 * history.capacity(); ++i) {
    moment.time_s = static_cast<double>(i);
    const float* const handed_in = std::get<pose::StrandPose>(moment.poses[0]).bend_east_rad.data();
    history.push(moment);
    EXPECT_EQ(std::get<pose::StrandPose>(history.newest().poses[0]).bend_east_rad.data(), handed_in);
  }
  EXPECT_EQ(history.size(), PoseHistory::kMaxMoments);
  EXPECT_EQ(history.oldest().time_s, static_cast<double>(2 * PoseHistory::kMaxMoments));

  // Large poses: fewer of them.
  const std::array large{meadow(400'000)};
  history.reset(rest_moment(large));
  EXPECT_LE(history.capacity() * 400'000 * 2 * sizeof(float), PoseHistory::kMaxBytes);
}

TEST(BackAndForth, StaysInTheSpanAndSlowsToRestAtTheTurns) {
  for (const double span_s : {0.0, 0.3, 4.0}) {
    double last_s = 0.0;
    double last_step_s = 0.0;
    double reached_s = 0.0;
    const double dt_s = 0.01;
    for (int step = 1; step < 3000; ++step) {
      const double place_s = back_and_forth_s(step * dt_s, span_s);
      EXPECT_GE(place_s, 0.0);
      EXPECT_LE(place_s, span_s + 1e-12);
      const double step_s = place_s - last_s;
      EXPECT_LE(std::abs(step_s), dt_s * (1 + 1e-9));
      EXPECT_LE(std::abs(step_s - last_step_s), dt_s * dt_s / std::min(1.0, std::max(span_s, 1e-9)) + 1e-9);
      reached_s = std::max(reached_s, place_s);
      last_s = place_s;
      last_step_s = step_s;
    }
    EXPECT_NEAR(reached_s, span_s, 1e-3);
  }
}

}  // namespace
}  // namespace yuragi::viewer::stream
