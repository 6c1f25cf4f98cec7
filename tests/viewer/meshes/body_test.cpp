#include "viewer/meshes/body.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes {
namespace {

/// Roots on the upper part of an ellipsoid that is turned about the vertical.
pose::StrandSkeleton coat_on(const glm::vec3& middle_m, const glm::vec3& half_m, float turn_rad, float from_height) {
  pose::StrandSkeleton coat;
  for (int ring = 0; ring <= 20; ++ring) {
    const float up = from_height + (1.0F - from_height) * static_cast<float>(ring) / 20.0F;
    for (int i = 0; i < 30; ++i) {
      const float bearing_rad = 0.2094395F * static_cast<float>(i);
      const float level = std::sqrt(1.0F - up * up);
      const glm::vec3 p(half_m.x * level * std::cos(bearing_rad), half_m.y * up,
                        half_m.z * level * std::sin(bearing_rad));
      coat.root_x_m.push_back(middle_m.x + std::cos(turn_rad) * p.x - std::sin(turn_rad) * p.z);
      coat.root_y_m.push_back(middle_m.y + p.y);
      coat.root_z_m.push_back(middle_m.z + std::sin(turn_rad) * p.x + std::cos(turn_rad) * p.z);
    }
  }
  coat.strand_count = coat.root_x_m.size();
  return coat;
}

TEST(Body, IsTheEllipsoidThatTheRootsStandOn) {
  for (const float from_height : {0.0F, 0.3F, -1.0F}) {
    const pose::StrandSkeleton coat = coat_on({3.0F, 0.1F, -7.0F}, {1.5F, 0.75F, 1.0F}, 0.6F, from_height);
    const Body body = body_of(coat);
    EXPECT_NEAR(glm::length(body.middle_m - glm::vec3(3.0F, 0.1F, -7.0F)), 0.0F, 1e-3F) << from_height;
    for (std::size_t i = 0; i < coat.strand_count; ++i) {
      const glm::vec3 off = glm::vec3(coat.root_x_m[i], coat.root_y_m[i], coat.root_z_m[i]) - body.middle_m;
      EXPECT_NEAR(glm::dot(off, body.shape * off), 1.0F, 1e-3F);
    }
    for (const glm::vec3& place_m : skin_of(body).places_m) {
      const glm::vec3 off = place_m - body.middle_m;
      EXPECT_NEAR(glm::dot(off, body.shape * off), 1.0F, 1e-3F);
    }
  }
}

TEST(Body, FillsTheBoxOfRootsThatStandOnNone) {
  pose::StrandSkeleton flat;
  for (int i = 0; i < 100; ++i) {
    flat.root_x_m.push_back(0.1F * static_cast<float>(i % 10));
    flat.root_y_m.push_back(0.0F);
    flat.root_z_m.push_back(0.1F * static_cast<float>(i / 10));
  }
  flat.strand_count = 100;
  const Body body = body_of(flat);
  EXPECT_NEAR(body.middle_m.x, 0.45F, 1e-4F);
  for (const glm::vec3& place_m : skin_of(body).places_m) EXPECT_LT(glm::length(place_m), 1.5F);
  EXPECT_GT(body_of({}).spacing_m, 0.0F);
}

TEST(Body, HasTheModelsRootsOnIt) {
  const auto coat = std::get<pose::StrandSkeleton>(test_model("fur").skeleton);
  const Body body = body_of(coat);
  for (std::size_t i = 0; i < coat.strand_count; i += 11) {
    const glm::vec3 off = glm::vec3(coat.root_x_m[i], coat.root_y_m[i], coat.root_z_m[i]) - body.middle_m;
    EXPECT_NEAR(glm::dot(off, body.shape * off), 1.0F, 1e-2F);
  }
}

TEST(Body, KeepsACameraOutOfItAndItsHairs) {
  const auto coat = std::get<pose::StrandSkeleton>(test_model("fur").skeleton);
  const Body body = body_of(coat);
  ASSERT_GT(body.hair_m, 0.0F);
  for (const double heading_deg : {0.0, 77.0, 200.0}) {
    for (const double distance_m : {0.2, 0.4, 0.8}) {
      const CameraPlace within{glm::dvec3(body.middle_m), heading_deg, 15.0, distance_m};
      const CameraPlace there = outside(body, within);
      EXPECT_EQ(there.target_m, within.target_m);
      EXPECT_EQ(there.heading_deg, heading_deg);
      const glm::vec3 off = glm::vec3(eye_of(there)) - body.middle_m;
      EXPECT_GT(glm::dot(off, body.shape * off), 1.0F);
      // So far that it sees hairs, and not one of them.
      const glm::vec3 skin = body.middle_m + off / std::sqrt(glm::dot(off, body.shape * off));
      EXPECT_GT(glm::distance(skin, body.middle_m + off), 1.5F * body.hair_m);
    }
  }
}

TEST(Body, LeavesACameraThatIsOutsideWhereItIs) {
  const Body body = body_of(std::get<pose::StrandSkeleton>(test_model("fur").skeleton));
  const glm::dvec3 middle_m(body.middle_m);
  EXPECT_EQ(outside(body, {middle_m, 30.0, 10.0, 9.0}).distance_m, 9.0);
  // Between it and something before it, and past it.
  const CameraPlace before{middle_m + glm::dvec3(0.0, 0.0, 8.0), 0.0, 10.0, 1.0};
  EXPECT_EQ(outside(body, before).distance_m, 1.0);
  EXPECT_EQ(outside(body, {middle_m + glm::dvec3(20.0, 0.0, 0.0), 0.0, 0.0, 5.0}).distance_m, 5.0);
}

}  // namespace
}  // namespace yuragi::viewer::meshes
