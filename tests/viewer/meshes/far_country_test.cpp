#include "viewer/meshes/far_country.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace yuragi::viewer::meshes {
namespace {

/// The outline over one way around, as differences from its mean.
std::vector<double> outline_of(std::size_t range) {
  const std::vector<FarCorner> corners = far_corners(range);
  std::vector<double> outline;
  double mean = 0.0;
  for (std::size_t i = 0; i < kFarCorners; ++i) {
    outline.push_back(static_cast<double>(corners[i].top_m.y));
    mean += outline.back() / kFarCorners;
  }
  for (double& height : outline) height -= mean;
  return outline;
}

TEST(FarCountry, NeverRepeatsOnTheWayAround) {
  for (std::size_t range = 0; range < kFarRanges.size(); ++range) {
    const std::vector<double> outline = outline_of(range);
    double square = 0.0;
    for (const double height : outline) square += height * height;
    // Not even nearly, shifted by 10 degrees or more.
    for (std::size_t shift = kFarCorners / 36; shift <= kFarCorners / 2; shift += 3) {
      double product = 0.0;
      for (std::size_t i = 0; i < outline.size(); ++i) product += outline[i] * outline[(i + shift) % outline.size()];
      ASSERT_LT(product, 0.7 * square) << "range " << range << ", " << 360.0 * static_cast<double>(shift) / kFarCorners;
    }
  }
}

TEST(FarCountry, ClosesTheCircleWithoutAStep) {
  for (std::size_t range = 0; range < kFarRanges.size(); ++range) {
    const std::vector<FarCorner> corners = far_corners(range);
    EXPECT_EQ(corners[kFarCorners].top_m, corners[0].top_m);
    const float last_step = glm::distance(corners[kFarCorners - 1].top_m, corners[0].top_m);
    EXPECT_LT(last_step, 0.01F * kFarRanges.at(range).distance_m);
  }
}

TEST(FarCountry, StandsBehindOneAnotherAndOnTheGround) {
  float before_m = 0.0F;
  for (std::size_t range = 0; range < kFarRanges.size(); ++range) {
    float nearest_m = 1e9F;
    float farthest_m = 0.0F;
    for (const FarCorner& corner : far_corners(range)) {
      const float distance_m = std::hypot(corner.top_m.x, corner.top_m.z);
      nearest_m = std::min(nearest_m, distance_m);
      farthest_m = std::max(farthest_m, distance_m);
      ASSERT_GE(corner.top_m.y, 0.0F);
      ASSERT_LT(corner.top_m.y, 0.15F * distance_m) << "it would be a wall";
    }
    EXPECT_GT(nearest_m, before_m) << range;
    before_m = farthest_m;
  }
}

TEST(FarCountry, HasGapsBetweenItsCopsesAndTrees) {
  std::size_t open = 0;
  std::size_t high = 0;
  for (const FarCorner& corner : far_corners(0)) {
    if (corner.top_m.y < 0.3F) ++open;
    if (corner.top_m.y > 6.0F) ++high;
  }
  EXPECT_GT(open, kFarCorners / 10U);
  EXPECT_GT(high, kFarCorners / 20U);
}

TEST(FarCountry, HasNoMoreCornersThanThePictureShows) {
  EXPECT_EQ(far_corner_step(0.0F), 1);
  EXPECT_EQ(far_corner_step(1.0F), 12);
  const double step_rad = 6.283185307179586 / kFarCorners;
  for (double apart_rad = 0.5 * step_rad; apart_rad < 20.0 * step_rad; apart_rad += 0.3 * step_rad) {
    const int step = far_corner_step(static_cast<float>(apart_rad));
    EXPECT_EQ(kFarCorners % step, 0);
    EXPECT_LE((step == 1 ? 0 : step) * step_rad * 0.9999, apart_rad);
    EXPECT_GE(2.0001 * step * step_rad, std::min(apart_rad, 12.0 * step_rad));
  }
}

}  // namespace
}  // namespace yuragi::viewer::meshes
