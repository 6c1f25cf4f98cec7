#include "viewer/meshes/cloth_measure.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"
#include "viewer/meshes/cloth_holder.hpp"

namespace yuragi::viewer::meshes {
namespace {

class ClothMeasureTest : public testing::Test {
 protected:
  static pose::GridSkeleton cloth(std::string_view kind) {
    return std::get<pose::GridSkeleton>(test_model(kind).skeleton);
  }
};

glm::vec2 place_on(const ClothMeasure& lies, std::size_t column, std::size_t row) {
  return lies.origin_m + static_cast<float>(column) * lies.per_column_m + static_cast<float>(row) * lies.per_row_m;
}

TEST_F(ClothMeasureTest, OfAFlagRunsFromTheHoistAndDownFromItsTop) {
  pose::GridSkeleton flag = cloth("flag");
  const ClothMeasure from_top = measure(flag);
  EXPECT_NEAR(from_top.size_m.x, 1.8F, 1e-3F);
  EXPECT_NEAR(from_top.size_m.y, 1.2F, 1e-3F);
  EXPECT_NEAR(place_on(from_top, 0, flag.rows - 1).x, 1.8F, 1e-3F);
  EXPECT_NEAR(place_on(from_top, flag.columns - 1, 0).y, 1.2F, 1e-3F);

  // The same where the columns begin at the hoist's foot.
  for (float& y_m : flag.rest_y_m) y_m = 8.0F - y_m;
  const ClothMeasure from_foot = measure(flag);
  EXPECT_NEAR(place_on(from_foot, 0, 0).y, 1.2F, 1e-3F);
  EXPECT_NEAR(place_on(from_foot, flag.columns - 1, 0).y, 0.0F, 1e-3F);
}

TEST_F(ClothMeasureTest, OfACurtainIsOfTheClothNotOfItsFolds) {
  const ClothMeasure lies = measure(cloth("curtain"));
  EXPECT_GT(lies.size_m.x, 2.4F);
  EXPECT_NEAR(lies.size_m.y, 2.3F, 0.05F);
  EXPECT_EQ(place_on(lies, 0, 0), glm::vec2(0.0F));
}

TEST_F(ClothMeasureTest, KnowsWhatAClothIs) {
  EXPECT_EQ(cloth_style("curtain", cloth("flag")), ClothStyle::kCurtain);
  EXPECT_EQ(cloth_style("something new", cloth("curtain")), ClothStyle::kCurtain);
  EXPECT_EQ(cloth_style("something new", cloth("flag")), ClothStyle::kFlag);
  EXPECT_EQ(cloth_style("something new", cloth("banner")), ClothStyle::kBanner);
}

TEST_F(ClothMeasureTest, HoldersStandOnTheGroundAndReachTheCloth) {
  for (const auto& [kind, top_m] : {std::pair{"curtain", 2.5F}, std::pair{"flag", 4.0F}, std::pair{"banner", 4.6F}}) {
    const SolidMesh mesh = cloth_holder(cloth_style(kind, cloth(kind)), cloth(kind));
    ASSERT_FALSE(mesh.vertices().empty()) << kind;
    const auto [low, high] =
        std::minmax_element(mesh.vertices().begin(), mesh.vertices().end(),
                            [](const auto& a, const auto& b) { return a.place_m.y < b.place_m.y; });
    EXPECT_NEAR(low->place_m.y, 0.0F, 0.05F) << kind;
    EXPECT_GT(high->place_m.y, top_m) << kind;
    EXPECT_LT(high->place_m.y, top_m + 0.5F) << kind;
  }
}

TEST_F(ClothMeasureTest, ACurtainNearTheGroundHasAFloorBelowItsHem) {
  pose::GridSkeleton curtain = cloth("curtain");
  const std::optional<Floor> floor = cloth_floor(ClothStyle::kCurtain, curtain);
  ASSERT_TRUE(floor);
  EXPECT_GT(floor->middle_m.y, 0.1F);
  EXPECT_LT(floor->middle_m.y, 0.2F);  // where the hem is
  EXPECT_GT(floor->half_m.x, 1.2F);
  EXPECT_GT(floor->half_m.y, 1.5F);
  EXPECT_TRUE(is_on(*floor, {1.2F, 1.0F}, 0.0F));
  EXPECT_FALSE(is_on(*floor, {1.2F, 3.0F}, 0.0F));
  EXPECT_TRUE(is_on(*floor, {1.2F, 3.0F}, 2.0F));

  EXPECT_FALSE(cloth_floor(ClothStyle::kFlag, cloth("flag")));
  for (float& y_m : curtain.rest_y_m) y_m += 3.0F;
  EXPECT_FALSE(cloth_floor(ClothStyle::kCurtain, curtain)) << "it hangs high";
}

TEST_F(ClothMeasureTest, HoldersOfHugeClothsHaveNoMorePieces) {
  for (const char* const kind : {"curtain", "flag", "banner"}) {
    pose::GridSkeleton huge = cloth(kind);
    for (auto* const at_m : {&huge.rest_x_m, &huge.rest_y_m, &huge.rest_z_m}) {
      for (float& value_m : *at_m) value_m *= 2e5F;
    }
    EXPECT_LT(cloth_holder(cloth_style(kind, huge), huge).vertices().size(), 100'000U) << kind;
  }
}

TEST_F(ClothMeasureTest, NothingIsNoTrouble) {
  EXPECT_FALSE(cloth_floor(ClothStyle::kCurtain, {}));
  EXPECT_EQ(measure({}).size_m, glm::vec2(0.0F));
  EXPECT_TRUE(cloth_holder(ClothStyle::kFlag, {}).vertices().empty());
  EXPECT_EQ(cloth_style("", {}), ClothStyle::kCurtain);
}

}  // namespace
}  // namespace yuragi::viewer::meshes
