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

TEST(PoseViews, TheWindAloneHasNoScenesAndIsMadeOnceForAll) {
  PoseViews views;
  views.set_scenes(shared(wire::encode(samples::all_kinds())));
  views.set_frame(shared(samples::frame_of_all_kinds()));
  const auto a = views.view({.is_wind_alone = true});
  EXPECT_EQ(a, views.view({.is_wind_alone = true}));
  EXPECT_EQ(a->scenes(), nullptr);
  EXPECT_EQ(a->frame(), a->frame());
  EXPECT_LT(a->frame()->size(), 200U);
  views.set_scenes(shared(wire::encode(samples::scenes())));
  EXPECT_EQ(a->scenes(), nullptr);
  views.set_frame(shared(samples::frame_bytes()));
  EXPECT_TRUE(a->has_frame());
}

TEST(PoseViews, ANameThatNoSceneHasIsRefusedWithTheNamesThatExist) {
  PoseViews views;
  EXPECT_EQ(views.refusal({.scenes = {"meadow"}}), "there are no scenes");
  wire::Scenes scenes = samples::scenes();
  scenes.scenes.push_back(scenes.scenes[0]);  // while one fades out
  views.set_scenes(shared(wire::encode(scenes)));
  EXPECT_EQ(views.refusal({}), std::nullopt);
  EXPECT_EQ(views.refusal({.is_wind_alone = true}), std::nullopt);
  EXPECT_EQ(views.refusal({.scenes = {"bank", "meadow"}}), std::nullopt);
  EXPECT_EQ(views.refusal({.scenes = {"bank", "medow"}}),
            R"(there is no scene "medow"; the scenes are: "meadow", "bank")");
  EXPECT_EQ(views.refusal({.scenes = {""}}), R"(there is no scene ""; the scenes are: "meadow", "bank")");
  EXPECT_LT(views.refusal({.scenes = {std::string(1000, 'x')}}).value_or("").size(), 200U);
  views.set_scenes(shared(wire::encode(samples::all_kinds())));
  EXPECT_NE(views.refusal({.scenes = {"bank"}}), std::nullopt) << "its scene has gone";
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
