#include "viewer/stream/scene_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::viewer::stream {
namespace {

constexpr double kFrame_s = 1.0 / 60.0;
constexpr double kPicture_s = 1.0 / 144.0;

/// Strands that are told apart by their length; a meadow of so many.
wire::SceneModel strands_of(const std::string& name, std::size_t count, float length_m = 1.0F) {
  pose::StrandSkeleton skeleton;
  skeleton.strand_count = count;
  skeleton.links_per_strand = 2;
  skeleton.root_x_m.resize(skeleton.padded_count());
  skeleton.link_length_m.assign(skeleton.padded_count(), length_m);
  return {name, "grass", skeleton};
}

/// A sender whose scenes all bend alike, a viewer's pictures, and what each picture was of.
class Exchange {
 public:
  explicit Exchange(wire::Scenes scenes) { change_to(std::move(scenes)); }

  /// Scenes that come before the next frame.
  void change_to(wire::Scenes scenes) {
    sent_ = scenes;
    timeline.set_scenes(std::move(scenes));
  }

  /// Sends frames and shows pictures for a while; the bend at a moment is bend_at(sender's time).
  void run(double duration_s, const std::function<double(double)>& bend_at, bool is_sending = true) {
    for (const double end_s = now_s + duration_s; now_s < end_s; now_s += kPicture_s) {
      for (; next_frame_s + kLatency_s <= now_s; next_frame_s += kFrame_s) {
        if (!is_sending) continue;
        wire::Frame frame;
        frame.info.time_s = next_frame_s;
        for (const wire::SceneModel& scene : sent_.scenes) {
          pose::StrandPose pose = std::get<pose::StrandPose>(pose::rest_pose(scene.skeleton));
          std::ranges::fill(pose.bend_east_rad, static_cast<float>(bend_at(next_frame_s)));
          frame.poses.emplace_back(std::move(pose));
          frame.opacities.push_back(1.0F);
        }
        EXPECT_TRUE(timeline.accept(frame, next_frame_s + kLatency_s));
      }
      show();
    }
  }

  void show() {
    const PoseMoment& moment = timeline.advance(now_s);
    if (auto scenes = timeline.take_new_scenes()) {
      shown = std::move(*scenes);
      ++lists;
    }
    ASSERT_EQ(moment.poses.size(), shown.size());
    ASSERT_EQ(moment.opacities.size(), shown.size());
    for (std::size_t i = 0; i < shown.size(); ++i) ASSERT_TRUE(pose::fits(moment.poses[i], shown[i].skeleton));
    if (shown.empty()) return;
    const double bend = static_cast<double>(std::get<pose::StrandPose>(moment.poses[0]).bend_east_rad.at(0));
    if (pictures++ > 0) largest_step = std::max(largest_step, std::abs(bend - last_bend));
    last_bend = bend;
    bends.push_back(bend);
  }

  static constexpr double kLatency_s = 0.01;
  SceneTimeline timeline;
  double now_s = 100.0;
  double next_frame_s = 100.0;
  std::vector<wire::SceneModel> shown;
  std::vector<double> bends;
  double largest_step = 0.0;
  double last_bend = 0.0;
  int lists = 0;
  int pictures = 0;

 private:
  wire::Scenes sent_;
};

double steady(double sender_s) {
  return 0.25 * (sender_s - 100.0);
}

TEST(SceneTimeline, GoesOnMovingWhileTheScenesAreExchanged) {
  Exchange exchange({{strands_of("meadow", 3)}});
  exchange.run(2.0, steady);
  exchange.largest_step = 0.0;
  exchange.change_to({{strands_of("meadow", 3), strands_of("new", 40)}});
  EXPECT_FALSE(exchange.timeline.take_new_scenes()) << "there is no frame of them yet";
  exchange.run(2.0, steady);
  exchange.change_to({{strands_of("new", 40)}});
  exchange.run(2.0, steady);
  EXPECT_EQ(exchange.lists, 3);
  EXPECT_EQ(exchange.shown.at(0).name, "new");
  EXPECT_LE(exchange.largest_step, 0.25 * (kFrame_s + PoseTrack::kMaxPlayRate * kPicture_s) + 1e-6)
      << "a frame at most is not interpolated";
  EXPECT_EQ(exchange.timeline.playback(), Playback::kLive);
  EXPECT_TRUE(std::ranges::is_sorted(exchange.bends)) << "never back";
}

TEST(SceneTimeline, NothingIsInterpolatedBetweenTwoLists) {
  // Of the same layout, and yet others: one bent, the other not.
  Exchange exchange({{strands_of("meadow", 3, 1.0F)}});
  exchange.run(1.0, [](double) { return 0.0; });
  exchange.change_to({{strands_of("meadow", 3, 2.0F)}});
  exchange.run(1.0, [](double) { return 1.0; });
  EXPECT_EQ(exchange.lists, 2);
  for (const double bend : exchange.bends) EXPECT_TRUE(bend == 0.0 || bend == 1.0) << bend;
  EXPECT_EQ(exchange.bends.back(), 1.0);
}

TEST(SceneTimeline, ShowsTheOldScenesUntilAFrameOfTheNewOnesComesHoweverLate) {
  Exchange exchange({{strands_of("meadow", 3)}});
  const auto sway = [](double sender_s) { return std::sin(2.0 * std::numbers::pi * 0.3 * sender_s); };
  exchange.run(3.0, sway);
  exchange.change_to({{strands_of("other", 5)}});
  exchange.run(2.0, sway, false);
  EXPECT_EQ(exchange.shown.at(0).name, "meadow");
  EXPECT_EQ(exchange.timeline.playback(), Playback::kReplaying) << "and it moves";
  exchange.run(0.5, sway);
  EXPECT_EQ(exchange.shown.at(0).name, "other");
  EXPECT_EQ(exchange.timeline.playback(), Playback::kLive);
}

TEST(SceneTimeline, AnotherNameChangesTheNameAtOnceAndNothingElse) {
  Exchange exchange({{strands_of("meadow", 3)}});
  exchange.run(1.0, steady);
  exchange.largest_step = 0.0;
  exchange.change_to({{strands_of("lawn", 3)}});
  exchange.show();
  EXPECT_EQ(exchange.shown.at(0).name, "lawn");
  exchange.run(1.0, steady);
  EXPECT_LE(exchange.largest_step, 0.25 * PoseTrack::kMaxPlayRate * kPicture_s + 1e-6);
}

TEST(SceneTimeline, ScenesThatComeBackBeforeTheyWereGoneStay) {
  Exchange exchange({{strands_of("meadow", 3)}});
  exchange.run(1.0, steady);
  exchange.change_to({{strands_of("other", 5)}});
  exchange.change_to({{strands_of("meadow", 3)}});
  exchange.run(1.0, steady);
  EXPECT_EQ(exchange.shown.at(0).name, "meadow");
  exchange.change_to({{strands_of("other", 5)}});
  exchange.change_to({{strands_of("third", 7)}});
  exchange.run(1.0, steady);
  EXPECT_EQ(exchange.shown.at(0).name, "third");
}

TEST(SceneTimeline, BeforeTheFirstFrameTheNewestScenesAreAtRest) {
  Exchange exchange({{strands_of("meadow", 3)}});
  exchange.show();
  exchange.change_to({{strands_of("other", 5)}});
  exchange.show();
  EXPECT_EQ(exchange.shown.at(0).name, "other");
  EXPECT_EQ(exchange.last_bend, 0.0);
}

TEST(SceneTimeline, FramesOfTheOldScenesBehindTheNewOnesAreRefused) {
  Exchange exchange({{strands_of("meadow", 3)}});
  exchange.run(1.0, steady);
  exchange.change_to({{strands_of("other", 50)}});
  wire::Frame old;
  old.info.time_s = exchange.next_frame_s;
  old.poses.push_back(pose::rest_pose(strands_of("meadow", 3).skeleton));
  old.opacities.push_back(1.0F);
  EXPECT_FALSE(exchange.timeline.accept(old, exchange.now_s));
  exchange.run(1.0, steady);
  EXPECT_EQ(exchange.shown.at(0).name, "other");
}

TEST(SceneTimeline, MayHaveNoScenesAtAllForAWhile) {
  Exchange exchange({{strands_of("meadow", 3)}});
  exchange.run(1.0, steady);
  exchange.change_to({});
  exchange.run(0.5, steady, false);
  EXPECT_TRUE(exchange.shown.empty());
  exchange.change_to({{strands_of("meadow", 3)}});
  exchange.run(0.5, steady);
  EXPECT_EQ(exchange.shown.at(0).name, "meadow");
  EXPECT_EQ(exchange.timeline.playback(), Playback::kLive);
}

}  // namespace
}  // namespace yuragi::viewer::stream
