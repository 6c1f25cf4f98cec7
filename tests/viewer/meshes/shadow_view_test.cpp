#include "viewer/meshes/shadow_view.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace yuragi::viewer::meshes {
namespace {

const Bounds kTree{{-3.0F, 0.0F, -2.0F}, {3.0F, 8.0F, 2.0F}};

glm::vec3 place_in_map(const glm::vec3& to_sun, const glm::vec3& place_m) {
  View view;
  add_shadows(view, shadow_view(kTree, to_sun, 1024), 1024);
  return glm::vec3(view.to_shadow * glm::vec4(place_m, 1.0F));
}

TEST(ShadowView, HoldsTheWholeBoxFromEverySide) {
  for (int rise = 1; rise <= 20; ++rise) {
    const float height = 0.05F * static_cast<float>(rise) - 0.02F;
    for (int half_radian = 0; half_radian < 13; ++half_radian) {
      const float turn = 0.5F * static_cast<float>(half_radian);
      const float level = std::sqrt(1.0F - height * height);
      const glm::vec3 to_sun(level * std::sin(turn), height, level * std::cos(turn));
      for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 at(corner & 1 ? kTree.low_m.x : kTree.high_m.x, corner & 2 ? kTree.low_m.y : kTree.high_m.y,
                           corner & 4 ? kTree.low_m.z : kTree.high_m.z);
        const glm::vec3 in_map = place_in_map(to_sun, at);
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_GT(in_map[axis], 0.0F) << height;
          ASSERT_LT(in_map[axis], 1.0F) << height;
        }
      }
    }
  }
}

TEST(ShadowView, HasAShadowBehindWhatCastsIt) {
  const glm::vec3 to_sun = glm::normalize(glm::vec3(0.5F, 0.6F, 0.3F));
  const glm::vec3 leaf(1.0F, 5.0F, 0.0F);
  const glm::vec3 ground = leaf - to_sun * (leaf.y / to_sun.y);
  const glm::vec3 caster = place_in_map(to_sun, leaf);
  const glm::vec3 shadow = place_in_map(to_sun, ground);
  EXPECT_NEAR(shadow.x, caster.x, 1e-4F);
  EXPECT_NEAR(shadow.y, caster.y, 1e-4F);
  EXPECT_GT(shadow.z, caster.z);
}

TEST(Mirrored, HasEachThingWhereItsImageIsInThePicture) {
  OrbitCamera camera;
  camera.frame({{1.0, 0.5, -2.0}, 210.0, 12.0, 6.0});
  const View view = view_of(camera, 640, 360);
  const View image = mirrored(view, -0.12F, 0.5F);
  for (const glm::vec3 place_m : {glm::vec3(0.0F, 2.0F, 0.0F), glm::vec3(-1.0F, 0.4F, 1.5F)}) {
    const glm::vec4 seen = image.to_clip * glm::vec4(place_m, 1.0F);
    const glm::vec4 expected = view.to_clip * glm::vec4(place_m.x, -0.24F - place_m.y, place_m.z, 1.0F);
    EXPECT_NEAR(seen.x / seen.w, expected.x / expected.w / kMirrorMargin, 1e-4F);
    EXPECT_NEAR(seen.y / seen.w, expected.y / expected.w / kMirrorMargin, 1e-4F);
  }
  EXPECT_NEAR(image.eye_m.y, -0.24F - view.eye_m.y, 1e-5F);
  // A ray that goes down to the water in the picture goes up in the mirror.
  EXPECT_NEAR(image.forward.y, -view.forward.y, 1e-6F);
  EXPECT_GT(image.eye_m.w, 2.0F * view.eye_m.w);
}

TEST(ShadowView, IsFiniteForABoxOfNothing) {
  const View view = shadow_view({}, {0.0F, 1.0F, 0.0F}, 64);
  for (int column = 0; column < 4; ++column) EXPECT_TRUE(std::isfinite(view.to_clip[column].x));
}

}  // namespace
}  // namespace yuragi::viewer::meshes
