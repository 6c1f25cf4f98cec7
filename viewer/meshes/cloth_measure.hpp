#pragma once

#include <cstddef>
#include <string_view>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/pose/skeleton.hpp"

namespace yuragi::viewer::meshes {

/// How a cloth is drawn and held. The numbers are those of the cloth shader.
enum class ClothStyle : int { kCurtain = 0, kFlag = 1, kBanner = 2 };

/// By the scene's kind; an unknown kind is a curtain, or a flag if its fixed edge is upright.
ClothStyle cloth_style(std::string_view kind, const pose::GridSkeleton& cloth);

/// The position of a cloth's picture on its grid: the place of joint (column, row) on it, in metres from its upper left
/// corner to the right and down, is origin_m + column * per_column_m + row * per_row_m.
struct ClothMeasure {
  glm::vec2 origin_m{0.0F};
  glm::vec2 per_column_m{0.0F};
  glm::vec2 per_row_m{0.0F};
  glm::vec2 size_m{0.0F};
};
ClothMeasure measure(const pose::GridSkeleton& cloth);

/// The joint's position at rest.
glm::vec3 cloth_joint(const pose::GridSkeleton& cloth, std::size_t column, std::size_t row);

}  // namespace yuragi::viewer::meshes
