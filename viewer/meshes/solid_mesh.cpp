#include "viewer/meshes/solid_mesh.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/base/units.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr std::uint32_t kSides = 16;
constexpr std::uint32_t kBallRings = 8;
constexpr std::uint32_t kWireSides = 6;

glm::vec3 any_across(const glm::vec3& along) {
  const glm::vec3 aside = std::abs(along.y) < 0.9F ? glm::vec3(0.0F, 1.0F, 0.0F) : glm::vec3(1.0F, 0.0F, 0.0F);
  return glm::normalize(glm::cross(along, aside));
}

float turn_rad(std::uint32_t side) {
  return static_cast<float>(2.0 * kPi) * static_cast<float>(side) / static_cast<float>(kSides);
}

}  // namespace

void SolidMesh::add_tube(const glm::vec3& from, const glm::vec3& to, float from_radius_m, float to_radius_m,
                         const glm::vec3& tint) {
  if (glm::distance(from, to) <= 0.0F) return;
  const glm::vec3 along = glm::normalize(to - from);
  const glm::vec3 first = any_across(along);
  const glm::vec3 second = glm::cross(along, first);
  const auto base = static_cast<std::uint32_t>(vertices_.size());
  const float length_m = glm::distance(from, to);
  for (std::uint32_t side = 0; side < kSides; ++side) {
    const glm::vec3 out = std::cos(turn_rad(side)) * first + std::sin(turn_rad(side)) * second;
    const float around_m = from_radius_m * turn_rad(side);
    vertices_.push_back({from + from_radius_m * out, out, tint, {0.0F, around_m, grain_}});
    vertices_.push_back({to + to_radius_m * out, out, tint, {length_m, around_m, grain_}});
    const std::uint32_t here = base + 2 * side;
    const std::uint32_t next = base + 2 * ((side + 1) % kSides);
    indices_.insert(indices_.end(), {here, next, here + 1, here + 1, next, next + 1});
  }
}

void SolidMesh::add_ball(const glm::vec3& middle, float radius_m, const glm::vec3& tint) {
  const auto base = static_cast<std::uint32_t>(vertices_.size());
  for (std::uint32_t ring = 0; ring <= kBallRings; ++ring) {
    const float height_rad = static_cast<float>(kPi) * (static_cast<float>(ring) / kBallRings - 0.5F);
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const glm::vec3 out(std::cos(height_rad) * std::cos(turn_rad(side)), std::sin(height_rad),
                          std::cos(height_rad) * std::sin(turn_rad(side)));
      vertices_.push_back({middle + radius_m * out, out, tint, {}});
      if (ring == kBallRings) continue;
      const std::uint32_t here = base + ring * kSides + side;
      const std::uint32_t next = base + ring * kSides + (side + 1) % kSides;
      indices_.insert(indices_.end(), {here, here + kSides, next, next, here + kSides, next + kSides});
    }
  }
}

void SolidMesh::add_ring(const glm::vec3& middle, const glm::vec3& axis, float radius_m, float wire_radius_m,
                         const glm::vec3& tint) {
  if (glm::length(axis) <= 0.0F) return;
  const glm::vec3 along = glm::normalize(axis);
  const glm::vec3 first = any_across(along);
  const glm::vec3 second = glm::cross(along, first);
  const auto base = static_cast<std::uint32_t>(vertices_.size());
  for (std::uint32_t around = 0; around < 2 * kSides; ++around) {
    const float angle_rad = turn_rad(around) / 2.0F;
    const glm::vec3 out = std::cos(angle_rad) * first + std::sin(angle_rad) * second;
    for (std::uint32_t side = 0; side < kWireSides; ++side) {
      const float side_rad = turn_rad(side) * static_cast<float>(kSides) / static_cast<float>(kWireSides);
      const glm::vec3 normal = std::cos(side_rad) * out + std::sin(side_rad) * along;
      vertices_.push_back({middle + radius_m * out + wire_radius_m * normal, normal, tint, {}});
      const std::uint32_t here = base + around * kWireSides;
      const std::uint32_t there = base + (around + 1) % (2 * kSides) * kWireSides;
      const std::uint32_t next = (side + 1) % kWireSides;
      rings_.insert(rings_.end(), {here + side, there + side, here + next, here + next, there + side, there + next});
    }
  }
  wire_radius_m_ = std::max(wire_radius_m_, wire_radius_m);
}

void SolidMesh::add_quad(const std::array<glm::vec3, 4>& corners, const glm::vec3& tint) {
  const glm::vec3 across = glm::cross(corners[1] - corners[0], corners[3] - corners[0]);
  if (glm::length(across) <= 0.0F) return;
  const auto base = static_cast<std::uint32_t>(vertices_.size());
  const bool is_tall = glm::distance(corners[0], corners[1]) > glm::distance(corners[0], corners[3]);
  const glm::vec3 along = glm::normalize(corners[is_tall ? 1 : 3] - corners[0]);
  const glm::vec3 beside = glm::normalize(corners[is_tall ? 3 : 1] - corners[0]);
  for (const glm::vec3& corner : corners) {
    const glm::vec3 way = corner - corners[0];
    vertices_.push_back({corner, glm::normalize(across), tint, {glm::dot(way, along), glm::dot(way, beside), grain_}});
  }
  indices_.insert(indices_.end(), {base, base + 1, base + 2, base, base + 2, base + 3});
}

void SolidMesh::add_beam(const glm::vec3& from, const glm::vec3& to, float half_width_m, float low_y_m, float high_y_m,
                         const glm::vec3& tint) {
  const glm::vec3 level(to.x - from.x, 0.0F, to.z - from.z);
  if (glm::length(level) <= 0.0F) return;
  const glm::vec3 aside = half_width_m * glm::normalize(glm::vec3(-level.z, 0.0F, level.x));
  const auto corner = [&](const glm::vec3& end, float side, float y_m) {
    return glm::vec3(end.x, y_m, end.z) + side * aside;
  };
  for (const float side : {-1.0F, 1.0F}) {
    add_quad({corner(from, side, low_y_m), corner(from, side, high_y_m), corner(to, side, high_y_m),
              corner(to, side, low_y_m)},
             tint);
  }
  for (const auto& end : {from, to}) {
    add_quad({corner(end, -1, low_y_m), corner(end, -1, high_y_m), corner(end, 1, high_y_m), corner(end, 1, low_y_m)},
             tint);
  }
  for (const float y_m : {low_y_m, high_y_m}) {
    add_quad({corner(from, -1, y_m), corner(from, 1, y_m), corner(to, 1, y_m), corner(to, -1, y_m)}, tint);
  }
}

}  // namespace yuragi::viewer::meshes
