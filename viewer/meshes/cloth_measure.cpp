#include "viewer/meshes/cloth_measure.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace yuragi::viewer::meshes {
namespace {

bool is_hoisted(const pose::GridSkeleton& cloth) {
  const glm::vec3 edge = cloth_joint(cloth, cloth.columns - 1, 0) - cloth_joint(cloth, 0, 0);
  return std::abs(edge.y) > std::hypot(edge.x, edge.z);
}

}  // namespace

glm::vec3 cloth_joint(const pose::GridSkeleton& cloth, std::size_t column, std::size_t row) {
  const std::size_t i = row * cloth.stride() + column;
  return {cloth.rest_x_m[i], cloth.rest_y_m[i], cloth.rest_z_m[i]};
}

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

}  // namespace yuragi::viewer::meshes
