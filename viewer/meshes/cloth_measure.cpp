#include "viewer/meshes/cloth_measure.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace yuragi::viewer::meshes {
namespace {

const glm::vec3 kOak(0.150F, 0.078F, 0.034F);
const glm::vec3 kBamboo(0.30F, 0.24F, 0.085F);
const glm::vec3 kSteel(0.42F, 0.42F, 0.43F);
const glm::vec3 kBrass(0.62F, 0.40F, 0.10F);

glm::vec3 cloth_joint(const pose::GridSkeleton& cloth, std::size_t column, std::size_t row) {
  const std::size_t i = row * cloth.stride() + column;
  return {cloth.rest_x_m[i], cloth.rest_y_m[i], cloth.rest_z_m[i]};
}

bool is_hoisted(const pose::GridSkeleton& cloth) {
  const glm::vec3 edge = cloth_joint(cloth, cloth.columns - 1, 0) - cloth_joint(cloth, 0, 0);
  return std::abs(edge.y) > std::hypot(edge.x, edge.z);
}

glm::vec3 on_ground(const glm::vec3& place) {
  return {place.x, std::min(0.0F, place.y), place.z};
}

/// A rod along the fixed edge and a little beyond, on two posts.
void add_curtain_rod(const pose::GridSkeleton& cloth, SolidMesh& mesh) {
  const glm::vec3 first = cloth_joint(cloth, 0, 0);
  const glm::vec3 last = cloth_joint(cloth, cloth.columns - 1, 0);
  const float width_m = glm::distance(first, last);
  if (width_m <= 0.0F) return;
  const float radius_m = std::clamp(0.008F * width_m, 0.008F, 0.03F);
  const glm::vec3 beyond = (last - first) * (0.05F + radius_m / width_m);
  const glm::vec3 lift(0.0F, 0.4F * radius_m, 0.0F);
  mesh.add_tube(first - beyond + lift, last + beyond + lift, radius_m, radius_m, kOak);
  for (const glm::vec3& end : {first - beyond + lift, last + beyond + lift}) {
    mesh.add_tube(on_ground(end), end, 1.25F * radius_m, 1.1F * radius_m, kOak);
    mesh.add_ball(end, 1.9F * radius_m, kOak);
  }
}

/// From the ground to a little above `top`, with a knob.
void add_pole(const glm::vec3& top, const glm::vec3& tint, SolidMesh& mesh) {
  const float radius_m = std::clamp(0.009F * top.y, 0.010F, 0.06F);
  const glm::vec3 peak = top + glm::vec3(0.0F, 2.5F * radius_m, 0.0F);
  mesh.add_tube(on_ground(top), peak, 1.15F * radius_m, 0.8F * radius_m, tint);
  mesh.add_ball(peak + glm::vec3(0.0F, radius_m, 0.0F), 1.7F * radius_m, kBrass);
}

}  // namespace

ClothStyle cloth_style(std::string_view kind, const pose::GridSkeleton& cloth) {
  if (kind == "curtain") return ClothStyle::kCurtain;
  if (kind == "flag") return ClothStyle::kFlag;
  if (kind == "banner" || cloth.is_first_column_fixed) return ClothStyle::kBanner;
  const bool is_flag = cloth.columns > 0 && cloth.rows > 0 && is_hoisted(cloth);
  return is_flag ? ClothStyle::kFlag : ClothStyle::kCurtain;
}

ClothMeasure measure(const pose::GridSkeleton& cloth) {
  if (cloth.columns < 2 || cloth.rows < 2) return {};
  float along_row_m = 0.0F;
  float along_column_m = 0.0F;
  for (std::size_t column = 1; column < cloth.columns; ++column) {
    along_row_m += glm::distance(cloth_joint(cloth, column - 1, 0), cloth_joint(cloth, column, 0));
  }
  for (std::size_t row = 1; row < cloth.rows; ++row) {
    along_column_m += glm::distance(cloth_joint(cloth, 0, row - 1), cloth_joint(cloth, 0, row));
  }
  const float column_m = along_row_m / static_cast<float>(cloth.columns - 1);
  const float row_m = along_column_m / static_cast<float>(cloth.rows - 1);
  if (!is_hoisted(cloth)) return {{0.0F, 0.0F}, {column_m, 0.0F}, {0.0F, row_m}, {along_row_m, along_column_m}};

  // A flag's rows lead away from the hoist; its columns go down the hoist, or up.
  ClothMeasure flag{{0.0F, 0.0F}, {0.0F, column_m}, {row_m, 0.0F}, {along_column_m, along_row_m}};
  if (cloth_joint(cloth, 0, 0).y < cloth_joint(cloth, cloth.columns - 1, 0).y) {
    flag.origin_m.y = along_row_m;
    flag.per_column_m.y = -column_m;
  }
  return flag;
}

SolidMesh cloth_holder(ClothStyle style, const pose::GridSkeleton& cloth) {
  SolidMesh mesh;
  if (cloth.columns < 2 || cloth.rows < 2) return mesh;
  const glm::vec3 first = cloth_joint(cloth, 0, 0);
  const glm::vec3 last = cloth_joint(cloth, cloth.columns - 1, 0);
  switch (style) {
    case ClothStyle::kCurtain:
      add_curtain_rod(cloth, mesh);
      break;
    case ClothStyle::kFlag:
      add_pole(first.y < last.y ? last : first, kSteel, mesh);
      break;
    case ClothStyle::kBanner: {
      const glm::vec3 arm = (last - first) * 1.06F;
      const float radius_m = std::clamp(0.009F * glm::distance(first, last), 0.006F, 0.02F);
      add_pole(first, kBamboo, mesh);
      mesh.add_tube(first, first + arm, radius_m, 0.8F * radius_m, kBamboo);
      mesh.add_ball(first + arm, 1.3F * radius_m, kBrass);
      break;
    }
  }
  return mesh;
}

}  // namespace yuragi::viewer::meshes
