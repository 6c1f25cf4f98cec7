#include "viewer/meshes/solid_mesh.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"
#include "viewer/meshes/flame_bowl.hpp"

namespace yuragi::viewer::meshes {
namespace {

void expect_sound(const SolidMesh& mesh) {
  EXPECT_EQ(mesh.indices().size() % 3, 0U);
  for (const std::uint32_t index : mesh.indices()) ASSERT_LT(index, mesh.vertices().size());
  for (const SolidVertex& vertex : mesh.vertices()) ASSERT_NEAR(glm::length(vertex.normal), 1.0F, 1e-5F);
}

TEST(SolidMesh, TubesHaveTheirRadiusAroundTheirAxis) {
  SolidMesh mesh;
  mesh.add_tube({1, 0, 2}, {1, 3, 2}, 0.2F, 0.1F, {});
  expect_sound(mesh);
  for (const SolidVertex& vertex : mesh.vertices()) {
    const float radius = glm::length(vertex.place_m - glm::vec3(1, vertex.place_m.y, 2));
    EXPECT_NEAR(radius, vertex.place_m.y < 1.5F ? 0.2F : 0.1F, 1e-5F);
  }
}

TEST(SolidMesh, BallsAndBeamsAreWhereTheyShouldBe) {
  SolidMesh ball;
  ball.add_ball({0, 1, 0}, 0.5F, {});
  expect_sound(ball);
  for (const SolidVertex& vertex : ball.vertices()) EXPECT_NEAR(glm::distance(vertex.place_m, {0, 1, 0}), 0.5F, 1e-5F);

  SolidMesh beam;
  beam.add_beam({0, 0, 0}, {4, 0, 0}, 0.25F, -1.0F, 0.5F, {});
  expect_sound(beam);
  for (const SolidVertex& vertex : beam.vertices()) {
    EXPECT_NEAR(std::abs(vertex.place_m.z), 0.25F, 1e-6F);
    EXPECT_TRUE(vertex.place_m.y == -1.0F || vertex.place_m.y == 0.5F);
  }
}

TEST(SolidMesh, RingsAreAroundTheirAxis) {
  SolidMesh mesh;
  mesh.add_ring({1, 2, 3}, {0, 2, 0}, 0.5F, 0.1F, {});
  expect_sound(mesh);
  for (const SolidVertex& vertex : mesh.vertices()) {
    const glm::vec3 way = vertex.place_m - glm::vec3(1, 2, 3);
    EXPECT_NEAR(std::hypot(std::hypot(way.x, way.z) - 0.5F, way.y), 0.1F, 1e-5F);
  }
}

TEST(SolidMesh, PiecesOfNoSizeAreLeftOut) {
  SolidMesh mesh;
  mesh.add_tube({1, 1, 1}, {1, 1, 1}, 0.1F, 0.1F, {});
  mesh.add_ring({1, 1, 1}, {0, 0, 0}, 0.1F, 0.1F, {});
  mesh.add_beam({1, 1, 1}, {1, 2, 1}, 0.1F, 0.0F, 1.0F, {});
  mesh.add_quad({glm::vec3(0), glm::vec3(0), glm::vec3(0), glm::vec3(0)}, {});
  EXPECT_TRUE(mesh.vertices().empty());
}

TEST(FlameBowl, IsUnderTheFlame) {
  for (const char* kind : {"flame", "flame panel"}) {
    const SolidMesh bowl = flame_bowl(std::get<pose::SurfaceSkeleton>(test_model(kind).skeleton)).mesh;
    expect_sound(bowl);
    for (const SolidVertex& vertex : bowl.vertices()) EXPECT_LT(vertex.place_m.y, 0.75F) << kind;  // the foot is at 0.5
  }
  EXPECT_TRUE(flame_bowl({}).mesh.vertices().empty());
}

}  // namespace
}  // namespace yuragi::viewer::meshes
