#include "viewer/looks/lee.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <gtest/gtest.h>

#include "tests/viewer/test_models.hpp"
#include "viewer/meshes/orbit_camera.hpp"

namespace yuragi::viewer::looks {
namespace {

constexpr double kWindFrom_deg = 270.0;  // of test_pose()
constexpr std::array kAspects{9.0 / 32.0, 9.0 / 16.0, 1.0, 16.0 / 9.0, 32.0 / 9.0, 5760.0 / 1080.0};

/// How far out a point is in a picture: below 1 it is in it.
float reach_in_picture(const glm::mat4& clip, const glm::vec3& point_m) {
  const glm::vec4 seen = clip * glm::vec4(point_m, 1.0F);
  return seen.w > 0.0F ? std::max(std::abs(seen.x), std::abs(seen.y)) / seen.w : 1e9F;
}

glm::mat4 first_view(const meshes::Bounds& bounds, double aspect, double wind_from_deg) {
  meshes::OrbitCamera camera;
  camera.frame(meshes::place_around(bounds, aspect, wind_from_deg));
  return camera.projection(aspect) * camera.view();
}

TEST(WithLee, IsInTheFirstViewOfEveryShapeOfPictureForEveryKindAndWind) {
  for (const std::string_view kind : {"curtain", "flag", "banner", "tree", "flame"}) {
    const wire::SceneModel model = test_model(kind);
    for (const double wind_from_deg : {0.0, 60.0, 130.0, 240.0, 270.0}) {
      const meshes::Bounds box = with_lee(meshes::bounds_of(model.skeleton), model.skeleton, wind_from_deg);
      for (const double aspect : kAspects) {
        const glm::mat4 clip = first_view(box, aspect, wind_from_deg);
        for (int corner = 0; corner < 8; ++corner) {
          const glm::vec3 share(corner & 1, (corner >> 1) & 1, corner >> 2);
          EXPECT_LT(reach_in_picture(clip, glm::mix(box.low_m, box.high_m, share)), 1.0F) << kind << ' ' << aspect;
        }
      }
    }
  }
}

TEST(WithLee, HasRoomForClothInAStorm) {
  for (const std::string_view kind : {"curtain", "flag", "banner"}) {
    const wire::SceneModel model = test_model(kind);
    const auto& cloth = std::get<pose::GridSkeleton>(model.skeleton);
    const meshes::Bounds box = with_lee(meshes::bounds_of(model.skeleton), model.skeleton, kWindFrom_deg);
    const pose::Pose pose = test_pose(model, 2.0, 1.0);
    const auto& moved = std::get<pose::GridPose>(pose);
    for (const double aspect : kAspects) {
      const glm::mat4 clip = first_view(box, aspect, kWindFrom_deg);
      float farthest = 0.0F;
      for (std::size_t row = 0; row < cloth.rows; ++row) {
        for (std::size_t column = 0; column < cloth.columns; ++column) {
          const std::size_t i = row * cloth.stride() + column;
          const glm::vec3 joint_m(cloth.rest_x_m[i] + moved.offset_x_m[i], cloth.rest_y_m[i] + moved.offset_y_m[i],
                                  cloth.rest_z_m[i] + moved.offset_z_m[i]);
          farthest = std::max(farthest, reach_in_picture(clip, joint_m));
        }
      }
      EXPECT_LT(farthest, 1.0F) << kind << ' ' << aspect;
    }
  }
}

TEST(WithLee, GoesToTheLeeOfWhatIsBlownOutAlone) {
  const wire::SceneModel curtain = test_model("curtain");
  const meshes::Bounds rest = meshes::bounds_of(curtain.skeleton);
  const meshes::Bounds blown = with_lee(rest, curtain.skeleton, 270.0);
  EXPECT_GT(blown.high_m.x, rest.high_m.x + 0.5F * (rest.high_m.y - rest.low_m.y));
  EXPECT_NEAR(blown.low_m.x, rest.low_m.x, 1e-5F);
  EXPECT_EQ(blown.high_m.y, rest.high_m.y);
  const wire::SceneModel tree = test_model("tree");
  const meshes::Bounds crown = meshes::bounds_of(tree.skeleton);
  EXPECT_EQ(with_lee(crown, tree.skeleton, 270.0).high_m, crown.high_m);
}

}  // namespace
}  // namespace yuragi::viewer::looks
