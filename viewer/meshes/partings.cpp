#include "viewer/meshes/partings.hpp"

#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr float kArmSpacings = 2.5F;  // how far beside a strand its neighbours are looked for
constexpr float kMinArm = 0.5F;       // of twice that: at the coat's edge there can be none

glm::vec3 tip_of(const pose::JointPositions& joints, std::size_t strand) {
  const pose::JointPosition tip = joints.joint(strand, joints.links_per_strand() - 1);
  return {tip.x_m, tip.y_m, tip.z_m};
}

/// Roots in cells, to find the one that is nearest to a place.
class RootCells {
 public:
  RootCells(const pose::StrandSkeleton& coat, float cell_m) : coat_(&coat), cell_m_(cell_m) {
    for (std::size_t i = 0; i < coat.strand_count; ++i) {
      const glm::vec3 at = root_m(i) / cell_m_;
      cells_[key(cell(at.x), cell(at.y), cell(at.z))].push_back(static_cast<std::uint32_t>(i));
    }
  }

  glm::vec3 root_m(std::size_t i) const { return {coat_->root_x_m[i], coat_->root_y_m[i], coat_->root_z_m[i]}; }

  /// Searches within half a cell; returns `otherwise` if there is none in the cells around.
  std::uint32_t nearest(const glm::vec3& place_m, std::uint32_t otherwise) const {
    const glm::vec3 low = place_m / cell_m_ - 0.5F;
    std::uint32_t found = otherwise;
    float least_m = std::numeric_limits<float>::max();
    for (std::int64_t corner = 0; corner < 8; ++corner) {
      const auto at =
          cells_.find(key(cell(low.x) + (corner & 1), cell(low.y) + (corner >> 1 & 1), cell(low.z) + (corner >> 2)));
      if (at == cells_.end()) continue;
      for (const std::uint32_t i : at->second) {
        const float distance_m = glm::distance(root_m(i), place_m);
        if (distance_m >= least_m) continue;
        least_m = distance_m;
        found = i;
      }
    }
    return found;
  }

 private:
  static std::int64_t cell(float at) { return static_cast<std::int64_t>(std::floor(at)); }
  static std::int64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return ((x & 0x1FFFFF) << 42) | ((y & 0x1FFFFF) << 21) | (z & 0x1FFFFF);
  }

  const pose::StrandSkeleton* coat_;
  float cell_m_;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

Partings::Partings(const pose::StrandSkeleton& coat, const Body& body)
    : sides_(coat.strand_count),
      rest_m_(coat.strand_count),
      moved_m_(coat.strand_count),
      openings_(coat.strand_count, 0.0F) {
  if (coat.strand_count == 0 || coat.links_per_strand == 0) return;
  pose::JointPositions joints(coat);
  const pose::Pose rest = pose::rest_pose(coat);
  pose::StrandKinematicsJob{
      .skeleton = &coat, .pose = std::get_if<pose::StrandPose>(&rest), .row = {}, .joints = &joints}
      .run();
  const float arm_m = kArmSpacings * body.spacing_m;
  const RootCells cells(coat, arm_m);
  for (std::size_t i = 0; i < coat.strand_count; ++i) {
    rest_m_[i] = tip_of(joints, i);
    const glm::vec3 root_m = cells.root_m(i);
    const glm::vec3 out = glm::normalize(body.shape * (root_m - body.middle_m) + glm::vec3(0.0F, 1e-6F, 0.0F));
    const glm::vec3 aside = glm::normalize(glm::cross(out, glm::vec3(0.31F, 0.17F, 0.93F)));
    const auto own = static_cast<std::uint32_t>(i);
    for (const bool is_first : {true, false}) {
      const glm::vec3 arm = arm_m * (is_first ? aside : glm::cross(out, aside));
      Sides& sides = sides_[i][is_first ? 0 : 1];
      sides = {cells.nearest(root_m - arm, own), cells.nearest(root_m + arm, own)};
      const glm::vec3 way_m = cells.root_m(sides.to) - cells.root_m(sides.from);
      if (glm::length(way_m) > kMinArm * 2.0F * arm_m) sides.way_per_m = way_m / glm::dot(way_m, way_m);
    }
  }
}

void Partings::move_to(const pose::JointPositions& joints) {
  for (std::size_t i = 0; i < moved_m_.size(); ++i) moved_m_[i] = tip_of(joints, i) - rest_m_[i];
  for (std::size_t i = 0; i < openings_.size(); ++i) {
    const auto apart = [&](const Sides& sides) {
      return glm::dot(moved_m_[sides.to] - moved_m_[sides.from], sides.way_per_m);
    };
    openings_[i] = apart(sides_[i][0]) + apart(sides_[i][1]);
  }
}

}  // namespace yuragi::viewer::meshes
