// A program of its own, since it counts what is allocated.
#include <atomic>

#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "tests/support/replaced_allocation.hpp"
#include "viewer/stream/picture_age.hpp"
#include "viewer/stream/scene_timeline.hpp"

namespace {
std::atomic<std::size_t> allocations = 0;
}  // namespace

void* yuragi::test::allocate(std::size_t size) {
  ++allocations;
  return allocate_as_usual(size);
}

namespace yuragi::viewer::stream {
namespace {

wire::SceneModel meadow() {
  pose::StrandSkeleton skeleton;
  skeleton.strand_count = 1000;
  skeleton.links_per_strand = 3;
  skeleton.root_x_m.resize(skeleton.padded_count());
  return {"meadow", "grass", skeleton};
}

/// A stream at 60 Hz on a display of 60 Hz, without the network.
class Wall {
 public:
  Wall() {
    timeline_.set_scenes({{meadow()}});
    frame_.poses.push_back(pose::rest_pose(meadow().skeleton));
    frame_.opacities.push_back(1.0F);
    frame_.info.wind.live_weight = 1.0;
  }

  void show_pictures(int count, bool is_sending = true) {
    for (int i = 0; i < count; ++i) {
      now_s_ += 1.0 / 60.0;
      if (is_sending) {
        frame_.info.time_s = now_s_;
        age_.take_frame(frame_.info, now_s_, now_s_, true);
        timeline_.accept(frame_, now_s_);
      }
      age_.take_picture(timeline_.advance(now_s_), now_s_, 1.0 / 60.0);
      is_live_ = timeline_.playback() == Playback::kLive && age_.figures(now_s_).has_value();
    }
  }

  bool is_live() const { return is_live_; }

 private:
  SceneTimeline timeline_;
  PictureAge age_;
  wire::Frame frame_;
  double now_s_ = 100.0;
  bool is_live_ = false;
};

TEST(SceneTimeline, AllocatesNothingFromPictureToPictureNorWhenTheDaemonComesAndGoes) {
  constexpr int kMinute = 60 * 60;
  Wall wall;
  for (int round = 0; round < 3; ++round) {  // until both histories are full
    wall.show_pictures(kMinute);
    wall.show_pictures(kMinute / 10, false);
  }
  wall.show_pictures(kMinute);
  const std::size_t before = allocations;
  EXPECT_GT(before, 0U) << "nothing is counted";
  for (int minute = 0; minute < 20; ++minute) {
    wall.show_pictures(kMinute);
    wall.show_pictures(kMinute / 10, false);
  }
  wall.show_pictures(kMinute);
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(wall.is_live());
}

}  // namespace
}  // namespace yuragi::viewer::stream
