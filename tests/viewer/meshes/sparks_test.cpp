#include "viewer/meshes/sparks.hpp"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/pose/pose_arrays.hpp"
#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes {
namespace {

class SparksTest : public testing::Test {
 protected:
  SparksTest() : volume_(surface()) {
    pose::SurfacePose pose = std::get<pose::SurfacePose>(pose::rest_pose(surface()));
    std::fill(pose.heat.begin(), pose.heat.end(), 0.6F);
    volume_.move_to(surface(), pose);
  }
  static const pose::SurfaceSkeleton& surface() {
    static const wire::SceneModel model = test_model("flame");
    return std::get<pose::SurfaceSkeleton>(model.skeleton);
  }
  FlameVolume volume_;
};

TEST_F(SparksTest, AreTheSameAtTheSameTimeHoweverOftenTheyAreAsked) {
  const glm::vec2 wind(3.0F, 1.0F);
  Sparks often;
  for (int i = 0; i <= 600; ++i) often.move_to(5.0 + i / 60.0, wind, volume_);
  Sparks once;
  once.move_to(15.0, wind, volume_);
  for (std::size_t i = 0; i < Sparks::kMost; ++i) {
    EXPECT_NEAR(glm::distance(often.all()[i].place_m, once.all()[i].place_m), 0.0F, 1e-3F);
    EXPECT_NEAR(often.all()[i].glow, once.all()[i].glow, 1e-6F);
  }
}

TEST_F(SparksTest, NoneThatGlowsJumps) {
  Sparks sparks;
  std::array<Spark, Sparks::kMost> before{};
  for (int i = 0; i < 900; ++i) {
    // A wind that veers and gusts.
    const auto gust = static_cast<float>(i % 300) / 300.0F;
    sparks.move_to(i / 60.0, {8.0F * gust, -5.0F + 10.0F * gust}, volume_);
    for (std::size_t k = 0; k < Sparks::kMost; ++k) {
      const Spark& spark = sparks.all()[k];
      EXPECT_TRUE(spark.glow >= 0.0F && spark.glow <= 1.0F);
      if (i > 0 && before[k].glow > 0.25F && spark.glow > 0.25F) {
        EXPECT_LT(glm::distance(spark.place_m, before[k].place_m), 0.3F);
      }
      before[k] = spark;
    }
  }
}

TEST_F(SparksTest, RiseAndDriftWithTheWind) {
  Sparks calm;
  calm.move_to(20.0, {0.0F, 0.0F}, volume_);
  Sparks windy;
  windy.move_to(20.0, {6.0F, 0.0F}, volume_);
  float drift_m = 0.0F;
  float highest_m = 0.0F;
  for (std::size_t i = 0; i < Sparks::kMost; ++i) {
    drift_m = std::max(drift_m, windy.all()[i].place_m.x - calm.all()[i].place_m.x);
    highest_m = std::max(highest_m, calm.all()[i].place_m.y);
  }
  EXPECT_GT(drift_m, 3.0F);
  EXPECT_GT(highest_m, 1.7F) << "above the flame's top";
  EXPECT_LT(highest_m, 5.0F);
}

TEST_F(SparksTest, OfAFlameThatIsOutGlowNot) {
  volume_.move_to(surface(), std::get<pose::SurfacePose>(pose::rest_pose(surface())));
  Sparks sparks;
  sparks.move_to(3.0, {1.0F, 0.0F}, volume_);
  for (const Spark& spark : sparks.all()) EXPECT_EQ(spark.glow, 0.0F);
}

}  // namespace
}  // namespace yuragi::viewer::meshes
