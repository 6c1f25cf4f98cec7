#include "viewer/stream/fixed_delay.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "viewer/stream/scene_timeline.hpp"

namespace yuragi::viewer::stream {
namespace {

using testing::HasSubstr;

constexpr double kUtc_s = 1.8e9;  // when all begins
constexpr double kTickInterval_s = 1.0 / 60.0;
constexpr double kDelay_s = 0.12;
constexpr double kShortestWay_s = 0.003;

wire::SceneModel one_strand() {
  pose::StrandSkeleton skeleton;
  skeleton.strand_count = 1;
  skeleton.links_per_strand = 2;
  skeleton.root_x_m.resize(skeleton.padded_count());
  return {"meadow", "grass", skeleton};
}

/// A daemon. `true_s` counts from kUtc_s, by a clock that is right.
class Daemon {
 public:
  explicit Daemon(std::uint64_t seed = 1) : random_(seed) {}

  /// The next frame; it is made up to 2 ms after its tick.
  wire::Frame next() {
    wire::Frame frame;
    frame.info.tick = tick_;
    frame.info.time_s = kTickInterval_s * static_cast<double>(tick_);
    std::uniform_real_distribution<double> lateness_s(0.0, 0.002);
    frame.info.utc_ns = static_cast<std::int64_t>(1e9 * (kUtc_s + clock_error_s + next_s() + lateness_s(random_)));
    const std::vector<float> bends(pose::padded_to_blocks(1), static_cast<float>(std::sin(frame.info.time_s)));
    frame.poses.emplace_back(pose::StrandPose{bends, bends});
    frame.opacities.push_back(1.0F);
    ++tick_;
    return frame;
  }
  double next_s() const { return began_s_ + kTickInterval_s * static_cast<double>(tick_); }

  void restart(double now_s) {
    tick_ = 0;
    began_s_ = now_s;
  }

  double clock_error_s = 0.0;

 private:
  std::mt19937_64 random_;
  std::uint64_t tick_ = 0;
  double began_s_ = 0.0;
};

/// A viewer on a machine with clocks of its own, and the network to it. In order, as TCP delivers.
class Viewer {
 public:
  explicit Viewer(std::uint64_t seed, std::optional<double> delay_s = kDelay_s)
      : timeline(delay_s), random_(seed), steady_zero_s_(1000.0 * static_cast<double>(seed)) {
    timeline.set_scenes({{one_strand()}});
  }

  void send(const wire::Frame& frame, double sent_s) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const double way_s = kShortestWay_s + jitter_s * share(random_);
    if (is_cut || share(random_) < lost_share) return;
    last_arrival_s_ = std::max(last_arrival_s_, sent_s + way_s);
    on_the_way_.push_back({frame, last_arrival_s_});
  }

  /// Shows a picture.
  void show(double true_s) {
    while (!on_the_way_.empty() && on_the_way_.front().arrival_s <= true_s) {
      wire::Frame frame = on_the_way_.front().frame;
      timeline.accept(frame, steady_zero_s_ + on_the_way_.front().arrival_s);
      on_the_way_.erase(on_the_way_.begin());
    }
    const PoseMoment& moment = timeline.advance(steady_zero_s_ + true_s, kUtc_s + clock_error_s + true_s);
    const double bend = static_cast<double>(std::get<pose::StrandPose>(moment.poses.at(0)).bend_east_rad.at(0));
    EXPECT_TRUE(std::isfinite(bend));
    largest_step = std::max(largest_step, std::abs(bend - bend_));
    steps_back += timeline.playback() == Playback::kLive && moment.time_s < moment_s ? 1 : 0;
    standing = moment.time_s == moment_s ? standing + 1 : 0;
    bend_ = bend;
    moment_s = moment.time_s;
    tick = moment.tick;
  }

  const DelayFigures& figures() const { return timeline.fixed_delay()->figures(); }

  SceneTimeline timeline;
  double clock_error_s = 0.0;
  double jitter_s = 0.0;
  double lost_share = 0.0;
  bool is_cut = false;

  double moment_s = 0.0;
  std::uint64_t tick = 0;
  double largest_step = 0.0;  // of the bend
  int steps_back = 0;
  int standing = 0;  // number of pictures of the same moment

 private:
  struct Sent {
    wire::Frame frame;
    double arrival_s;
  };
  std::mt19937_64 random_;
  double steady_zero_s_;
  std::vector<Sent> on_the_way_;
  double last_arrival_s_ = 0.0;
  double bend_ = 0.0;
};

/// A daemon and the two screens of its wall, of 60 Hz and not genlocked.
class Wall {
 public:
  /// Calls `look` after each picture of the second screen.
  template <class Look>
  void run(double duration_s, const Look& look) {
    const double end_s = now_s + duration_s;
    while (now_s < end_s) {
      while (daemon.next_s() <= now_s) {
        const double sent_s = daemon.next_s();
        const wire::Frame frame = daemon.next();
        left.send(frame, sent_s + 0.002);
        right.send(frame, sent_s + 0.002);
      }
      left.show(now_s);
      right.show(now_s + kApart_s);
      look();
      now_s += kTickInterval_s;
    }
  }
  void run(double duration_s) {
    run(duration_s, [] {});
  }

  /// By how many ticks the screens differ.
  std::int64_t difference() const {
    return std::abs(static_cast<std::int64_t>(left.tick) - static_cast<std::int64_t>(right.tick));
  }

  static constexpr double kApart_s = 0.007;  // between two refreshes
  double now_s = 0.0;
  Daemon daemon;
  Viewer left{1};
  Viewer right{2};
};

/// A picture may move the bend, whose speed is at most 1 rad/s, by so much; a cross-fade passes from any bend to any.
constexpr double kLargestStep = PoseTrack::kMaxPlayRate * (kTickInterval_s + 1e-9) + 1e-6;
constexpr double kLargestFadeStep = kLargestStep + 1.5 / PoseTimeline::kFade_s * 2.0 * kTickInterval_s;

TEST(FixedDelay, ShowsTheSameTickOnBothScreensWhateverTheNetworkDoes) {
  Wall wall;
  wall.left.jitter_s = 0.080;
  wall.right.jitter_s = 0.020;
  wall.run(3.0);
  int pictures = 0;
  wall.run(60.0, [&] {
    ++pictures;
    EXPECT_LE(wall.difference(), 1);
    const double due_s = wall.now_s - kDelay_s;
    EXPECT_NEAR(wall.left.moment_s, due_s, 0.003) << "of up to 2 ms between a tick and its UTC, the least counts";
    EXPECT_NEAR(wall.right.moment_s, due_s + Wall::kApart_s, 0.003);
  });
  EXPECT_GE(pictures, 3000);
  EXPECT_EQ(wall.left.figures().late_frames + wall.right.figures().late_frames, 0U);
  EXPECT_EQ(wall.left.figures().losses + wall.right.figures().losses, 0U);
  EXPECT_EQ(wall.left.steps_back + wall.right.steps_back, 0);
}

TEST(FixedDelay, WithoutOneTheSameNetworkPutsTheScreensOutOfStep) {
  Wall wall;
  wall.left = Viewer(1, std::nullopt);
  wall.right = Viewer(2, std::nullopt);
  wall.left.jitter_s = 0.080;
  wall.run(20.0);
  EXPECT_GT(wall.difference(), 1);
}

TEST(FixedDelay, CountsLateFramesAndShowsTheLastUntilTheyCome) {
  Wall wall;
  wall.left.jitter_s = 0.200;
  int most_standing = 0;
  wall.run(30.0, [&] { most_standing = std::max(most_standing, wall.left.standing); });
  EXPECT_GT(wall.left.figures().late_frames, 0U);
  EXPECT_LT(wall.left.figures().late_frames, wall.left.figures().frames);
  EXPECT_EQ(wall.right.figures().late_frames, 0U);
  EXPECT_EQ(wall.left.steps_back, 0);
  EXPECT_LE(wall.left.largest_step, kLargestStep);
  EXPECT_LE(most_standing, 12) << "it stands at most until the latest frame";
}

TEST(FixedDelay, GoesOnWhereFramesAreLost) {
  Wall wall;
  wall.left.jitter_s = 0.050;
  wall.left.lost_share = 0.1;
  wall.run(3.0);
  wall.run(60.0, [&] { EXPECT_NEAR(wall.left.moment_s, wall.now_s - kDelay_s, 0.004); });
  EXPECT_EQ(wall.left.steps_back, 0);
}

TEST(FixedDelay, EasesWhereAClockIsStepped) {
  for (const double step_s : {-0.05, 0.05}) {
    Wall wall;
    wall.run(5.0);
    wall.left.clock_error_s = step_s;
    wall.run(2.0);
    EXPECT_NEAR(wall.left.moment_s, wall.now_s - kTickInterval_s - kDelay_s + step_s, 0.003) << step_s;
    EXPECT_EQ(wall.left.figures().losses, 0U);
    EXPECT_EQ(wall.left.steps_back, 0);
    EXPECT_LE(wall.left.largest_step, kLargestStep);
  }
}

TEST(FixedDelay, FollowsTheArrivalsWhileAClockIsWrong) {
  for (const bool is_daemons : {false, true}) {
    for (const double error_s : {-7200.0, -3.0, 0.3, 3.0, 7200.0, 1e9, -1.7e9}) {
      SCOPED_TRACE(testing::Message() << error_s << (is_daemons ? " s of the daemon's" : " s of the viewer's"));
      Wall wall;
      double& clock_error_s = is_daemons ? wall.daemon.clock_error_s : wall.left.clock_error_s;
      wall.run(5.0);
      ASSERT_TRUE(wall.left.figures().is_kept);
      clock_error_s = error_s;
      int most_standing = 0;
      wall.run(10.0, [&] { most_standing = std::max(most_standing, wall.left.standing); });
      EXPECT_LE(most_standing, 1);
      EXPECT_FALSE(wall.left.figures().is_kept);
      EXPECT_EQ(wall.left.figures().losses, 1U);
      EXPECT_THAT(wall.left.timeline.fixed_delay()->doubt_text(), HasSubstr("Set the clocks of this machine"));
      EXPECT_NEAR(wall.left.moment_s, wall.now_s - kTickInterval_s, 0.06) << "the shortest delay";

      clock_error_s = 0.0;
      wall.run(FixedDelay::kReturn_s + 2.0);
      EXPECT_TRUE(wall.left.figures().is_kept);
      EXPECT_NEAR(wall.left.moment_s, wall.now_s - kTickInterval_s - kDelay_s, 0.003);
      EXPECT_EQ(wall.left.figures().losses, 1U);
      EXPECT_EQ(wall.left.steps_back, 0);
      EXPECT_LE(wall.left.largest_step, kLargestStep);
    }
  }
}

TEST(FixedDelay, IsGivenUpFromTheStartWhereTheClockIsWrong) {
  Wall wall;
  wall.left.clock_error_s = 3600.0;
  wall.run(5.0);
  EXPECT_EQ(wall.left.figures().losses, 1U);
  EXPECT_THAT(wall.left.timeline.fixed_delay()->doubt_text(), HasSubstr("after it was made"));
  EXPECT_NEAR(wall.left.moment_s, wall.now_s - kTickInterval_s, 0.06);
}

TEST(FixedDelay, IsGivenUpWhereNoFrameCanArriveInTime) {
  Wall wall;
  wall.left = Viewer(1, 0.02);
  wall.left.clock_error_s = 0.03;
  wall.run(5.0);
  EXPECT_FALSE(wall.left.figures().is_kept);
  EXPECT_EQ(wall.left.standing, 0);
}

TEST(FixedDelay, PlaysBackAndForthWhereTheStreamStopsAndIsInStepAgainAfterwards) {
  Wall wall;
  wall.run(8.0);
  wall.left.is_cut = true;
  wall.run(2.0);
  EXPECT_EQ(wall.left.timeline.playback(), Playback::kReplaying);
  wall.left.clock_error_s = -7200.0;  // set meanwhile
  int most_standing = 0;
  wall.run(20.0, [&] { most_standing = std::max(most_standing, wall.left.standing); });
  EXPECT_LE(most_standing, 3);
  wall.left.clock_error_s = 0.0;
  wall.left.is_cut = false;
  wall.run(FixedDelay::kReturn_s + 3.0);
  EXPECT_EQ(wall.left.timeline.playback(), Playback::kLive);
  EXPECT_LE(wall.difference(), 1);
  EXPECT_LE(wall.left.largest_step, kLargestFadeStep);
}

TEST(FixedDelay, GoesOnThroughARestartOfTheDaemon) {
  for (const double error_s : {0.0, -40.0}) {
    Wall wall;
    wall.run(8.0);
    wall.daemon.restart(wall.now_s + 1.0);
    wall.daemon.clock_error_s = error_s;
    wall.run(8.0);
    EXPECT_EQ(wall.left.timeline.playback(), Playback::kLive);
    EXPECT_EQ(wall.left.figures().is_kept, error_s == 0.0);
    EXPECT_LE(wall.difference(), 1);
    EXPECT_LE(wall.left.largest_step, kLargestFadeStep);
    EXPECT_EQ(wall.left.standing, 0);
  }
}

TEST(FixedDelay, StaysInStepWhereTheScenesAreExchanged) {
  Wall wall;
  wall.run(5.0);
  const double before_s = wall.left.moment_s;
  wire::SceneModel other = one_strand();
  other.kind = "fur";
  std::get<pose::StrandSkeleton>(other.skeleton).root_x_m[0] = 1.0F;
  wall.left.timeline.set_scenes({{other}});
  double last_s = before_s;
  wall.run(1.0, [&] {
    // The old scenes come to rest at their last frame, and the new ones begin with the next.
    EXPECT_LE(wall.left.moment_s - last_s, 2.0 * kTickInterval_s);
    last_s = wall.left.moment_s;
  });
  EXPECT_NEAR(wall.left.moment_s, wall.now_s - kTickInterval_s - kDelay_s, 0.003);
}

TEST(FixedDelay, TakesAnyTimesOfAFrame) {
  FixedDelay delay(kDelay_s);
  constexpr auto kFarthest = std::numeric_limits<std::int64_t>::max();
  const std::array times_s{0.0, -1e300, 1e300, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()};
  double local_s = 1.0;
  for (const std::int64_t utc_ns : {std::int64_t{0}, kFarthest, -kFarthest}) {
    for (const double time_s : times_s) {
      wire::FrameInfo frame;
      frame.time_s = time_s;
      frame.utc_ns = utc_ns;
      delay.take_frame(frame, local_s += 0.01);
      const auto target_s = delay.target_s(local_s, kUtc_s);
      EXPECT_TRUE(!target_s || std::isfinite(*target_s));
    }
  }
}

TEST(FixedDelay, ReportsItsFigures) {
  EXPECT_EQ(delay_text({.delay_s = 0.12, .is_kept = true, .frames = 5000, .late_frames = 3, .losses = 1}),
            "delay 120 ms kept; 3 of 5000 frames late; given up 1 times");
}

}  // namespace
}  // namespace yuragi::viewer::stream
