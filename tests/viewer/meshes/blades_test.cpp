#include "viewer/meshes/blades.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "tests/viewer/test_meadow.hpp"
#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes {
namespace {

class BladesTest : public testing::Test {
 protected:
  const pose::Skeleton meadow_ = test_meadow(40, 8.0);
  const pose::StrandSkeleton& strands_ = std::get<pose::StrandSkeleton>(meadow_);
  BladeSorter sorter_{strands_};

  View view(const CameraPlace& place) const {
    OrbitCamera camera;
    camera.frame(place);
    return view_of(camera, 1280, 720);
  }
};

TEST_F(BladesTest, HaveARootAWidthAndATintEach) {
  const std::vector<Blade> blades = blades_of(strands_);
  ASSERT_EQ(blades.size(), strands_.strand_count);
  for (std::size_t i = 0; i < blades.size(); ++i) {
    EXPECT_EQ(blades[i].strand, static_cast<float>(i));
    EXPECT_EQ(blades[i].root_m[2], strands_.root_z_m[i]);
    EXPECT_GT(blades[i].width_m, 0.0F);
    EXPECT_LT(blades[i].width_m, 0.1F);
    EXPECT_GT(blades[i].tint[1], blades[i].tint[2]);  // greener than blue
  }
}

TEST_F(BladesTest, AreBoundedByRootsAndHeights) {
  const Bounds bounds = bounds_of(strands_);
  EXPECT_NEAR(bounds.low_m.x, -4.0F, 0.2F);
  EXPECT_NEAR(bounds.high_m.z, 4.0F, 0.2F);
  EXPECT_EQ(bounds.low_m.y, 0.0F);
  EXPECT_GT(bounds.high_m.y, 0.6F);
  EXPECT_LT(bounds.high_m.y, 1.0F);
}

TEST_F(BladesTest, AreAllDrawnOnceWhenAllAreInView) {
  sorter_.sort(view({{0.0, 0.0, 0.0}, 0.0, 60.0, 25.0}));
  std::set<float> seen;
  for (const DetailLevel& level : sorter_.levels()) {
    for (const Blade& blade : level.blades) EXPECT_TRUE(seen.insert(blade.strand).second);
  }
  EXPECT_EQ(seen.size(), strands_.strand_count);
}

TEST_F(BladesTest, AreLeftOutBehindTheCamera) {
  // In the middle, looking north over the northern half.
  const View north = view({{0.0, 0.5, -2.0}, 0.0, 5.0, 2.0});
  sorter_.sort(north);
  std::size_t drawn = 0;
  for (const DetailLevel& level : sorter_.levels()) {
    for (const Blade& blade : level.blades) EXPECT_LT(blade.root_m[2], 1.5F);
    drawn += level.blades.size();
  }
  EXPECT_GT(drawn, strands_.strand_count / 8);
  EXPECT_LT(drawn, strands_.strand_count / 2);
}

TEST_F(BladesTest, AreDrawnMoreFinelyTheNearerTheyAre) {
  sorter_.sort(view({{0.0, 0.5, 0.0}, 0.0, 10.0, 3.0}));
  EXPECT_EQ(sorter_.levels().front().rings, strands_.links_per_strand);
  EXPECT_EQ(sorter_.levels().back().rings, BladeSorter::kFarRings);
  EXPECT_TRUE(sorter_.levels().back().is_far);
  EXPECT_FALSE(sorter_.levels().front().blades.empty());

  // From afar, all with few.
  sorter_.sort(view({{0.0, 0.5, 0.0}, 0.0, 30.0, 150.0}));
  EXPECT_TRUE(sorter_.levels().front().blades.empty());
  // The fewer the smaller, and so much wider that together they cover as much.
  const std::vector<Blade>& far_ones = sorter_.levels().back().blades;
  EXPECT_LT(far_ones.size(), strands_.strand_count / 4);
  EXPECT_GT(far_ones.size(), strands_.strand_count / 32);
  const Blade whole = blades_of(strands_)[static_cast<std::size_t>(far_ones[0].strand)];
  const float share = static_cast<float>(far_ones.size()) / static_cast<float>(strands_.strand_count);
  EXPECT_NEAR(far_ones[0].width_m, whole.width_m / std::sqrt(share), 0.25F * far_ones[0].width_m);
  for (std::size_t i = 0; i + 1 < sorter_.levels().size(); ++i) EXPECT_TRUE(sorter_.levels()[i].blades.empty());
}

TEST_F(BladesTest, AreLeftOutBehindTheBodyThatTheyStandOn) {
  const auto coat = std::get<pose::StrandSkeleton>(test_model("fur").skeleton);
  BladeSorter sorter(coat);
  sorter.sort(view({{0.0, 0.4, 0.0}, 0.0, 5.0, 4.0}));  // looks north
  std::size_t drawn = 0;
  for (const DetailLevel& level : sorter.levels()) {
    drawn += level.blades.size();
    for (const Blade& blade : level.blades) EXPECT_GT(blade.root_m[2], -0.36F);
  }
  EXPECT_GT(drawn, coat.strand_count / 2);
  EXPECT_LT(drawn, coat.strand_count * 9 / 10);
}

TEST(Blades, OfOneLinkAndOfNoStrandsAreNoTrouble) {
  pose::StrandSkeleton empty;
  empty.links_per_strand = 1;
  BladeSorter none(empty);
  OrbitCamera camera;
  camera.frame(place_across(bounds_of(empty)));
  none.sort(view_of(camera, 100, 100));
  ASSERT_EQ(none.levels().size(), 2U);
  for (const DetailLevel& level : none.levels()) EXPECT_TRUE(level.blades.empty());
}

}  // namespace
}  // namespace yuragi::viewer::meshes
