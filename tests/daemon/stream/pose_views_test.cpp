#include "daemon/stream/pose_views.hpp"

#include <gtest/gtest.h>

#include "tests/engine/wire/samples.hpp"

namespace yuragi::daemon::stream {
namespace {

SharedBytes shared(wire::Bytes bytes) {
  return std::make_shared<const wire::Bytes>(std::move(bytes));
}

TEST(PoseViews, ClientsThatWantTheSameShareOneViewAndOneFrame) {
  PoseViews views;
  views.set_scenes(shared(wire::encode(samples::all_kinds())));
  const auto a = views.view({.every = 8});
  const auto b = views.view({.every = 8});
  const auto c = views.view({.every = 9});
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
  EXPECT_FALSE(a->has_frame());
  views.set_frame(shared(samples::frame_of_all_kinds()));
  EXPECT_EQ(a->frame(), a->frame()) << "thinned out once";
  EXPECT_LT(a->frame()->size(), samples::frame_of_all_kinds().size());
}

TEST(PoseViews, WhoeverWantsEverythingGetsTheBytesAsTheyAre) {
  PoseViews views;
  const SharedBytes scenes = shared(wire::encode(samples::all_kinds()));
  const SharedBytes frame = shared(samples::frame_of_all_kinds());
  views.set_scenes(scenes);
  views.set_frame(frame);
  EXPECT_EQ(views.view({})->scenes(), scenes);
  EXPECT_EQ(views.view({})->frame(), frame);
}

TEST(PoseViews, WithNewScenesThereIsNoFrameUntilThereIsOneOfThem) {
  PoseViews views;
  views.set_scenes(shared(wire::encode(samples::scenes())));
  views.set_frame(shared(samples::frame_bytes()));
  const auto view = views.view({.every = 2});
  EXPECT_TRUE(view->has_frame());
  const auto before = view->sequence();
  views.set_scenes(shared(wire::encode(samples::all_kinds())));
  EXPECT_FALSE(view->has_frame());
  views.set_frame(shared(samples::frame_of_all_kinds()));
  EXPECT_TRUE(view->has_frame());
  EXPECT_GT(view->sequence(), before);
}

}  // namespace
}  // namespace yuragi::daemon::stream
