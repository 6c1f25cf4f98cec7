#include "viewer/meshes/trees/tree_impostor.hpp"

#include <gtest/gtest.h>

namespace yuragi::viewer::meshes::trees {
namespace {

TEST(TreeImpostor, PicturesShowTheWholeTreeFromEverySide) {
  const Bounds tree{{-3.0F, 0.0F, -2.0F}, {3.0F, 9.0F, 2.0F}};
  const ImpostorBox box = impostor_box(tree);
  for (std::size_t side = 0; side < kImpostorSides; ++side) {
    for (std::size_t row = 0; row < kImpostorRows; ++row) {
      const View view = impostor_view(box, side, row, 256);
      for (int corner = 0; corner < 4; ++corner) {
        // The ends of the crown, on its axes.
        const glm::vec3 ends_m[] = {{-3.0F, 4.5F, 0.0F}, {3.0F, 4.5F, 0.0F}, {0.0F, 0.0F, 0.0F}, {0.0F, 9.0F, 0.0F}};
        const glm::vec4 clip = view.to_clip * glm::vec4(ends_m[corner], 1.0F);
        EXPECT_LE(std::abs(clip.x), 1.0F) << side << " " << row;
        EXPECT_LE(std::abs(clip.y), 1.0F) << side << " " << row;
        EXPECT_LE(std::abs(clip.z), 1.0F) << side << " " << row;
      }
    }
  }
  // The first side is the south, the third the east.
  EXPECT_GT(impostor_view(box, 0, 0, 256).eye_m.z, 900.0F);
  EXPECT_GT(impostor_view(box, 2, 0, 256).eye_m.x, 900.0F);
  EXPECT_GT(impostor_view(box, 0, 2, 256).eye_m.y, impostor_view(box, 0, 1, 256).eye_m.y);
}

TEST(TreeImpostor, FadesInWithTheDistanceAndIsWholeBeforeTheTreeGoes) {
  EXPECT_EQ(impostor_share(200.0F, 100.0F), 0.0F);
  EXPECT_EQ(impostor_share(100.0F, 100.0F), 1.0F);
  EXPECT_EQ(impostor_share(20.0F, 100.0F), 1.0F);
  float before = 0.0F;
  for (int step = 0; step < 70; ++step) {
    const float share = impostor_share(130.0F - 0.5F * static_cast<float>(step), 100.0F);
    EXPECT_GE(share, before);
    EXPECT_LT(share, before + 0.05F) << "without a jump";
    before = share;
  }
}

}  // namespace
}  // namespace yuragi::viewer::meshes::trees
