#include "viewer/meshes/trees/branches.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace yuragi::viewer::meshes::trees {
namespace {

constexpr float kNearestBranch_m = 0.3F;

/// Thickness of a branch in the picture, pixels, above which it has more sides than the minimum.
constexpr std::array<float, Branches::kSides.size() - 1> kThick_px = {3.0F, 24.0F};

}  // namespace

Branches::Branches(const pose::TreeSkeleton& tree, std::size_t level)
    : tree_(&tree),
      level_(level),
      parts_(tree_parts(tree, level)),
      middles_m_(parts_.size()),
      group_of_(parts_.size()),
      chosen_(parts_.size()) {
  const pose::StrandSkeleton& strands = tree.levels[level].strands;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    lengths_m_.push_back(strands.link_length_m[i] * static_cast<float>(strands.links_per_strand));
  }
  for (std::size_t tube = 0; tube < kSides.size(); ++tube) {
    std::size_t rings = std::min(kMinRings, strands.links_per_strand);
    for (; rings < strands.links_per_strand; rings *= 2) groups_.push_back({.rings = rings, .tube = tube});
    groups_.push_back({.rings = strands.links_per_strand, .tube = tube});
  }
}

void Branches::move_to(const pose::TreeJoints& joints) {
  const std::size_t links = tree_->levels[level_].strands.links_per_strand;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const pose::JointPosition foot = joints.level(level_).joint(i, 0);
    const pose::JointPosition tip = joints.level(level_).joint(i, links - 1);
    middles_m_[i] = 0.5F * glm::vec3(foot.x_m + tip.x_m, foot.y_m + tip.y_m, foot.z_m + tip.z_m);
  }
}

void Branches::choose(const View& view, float ring_px, const Place& place) {
  const auto planes = side_planes(view);
  const glm::vec3 eye_m(view.eye_m);
  for (BranchGroup& group : groups_) group.count = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    // Every joint is at most this length from the midpoint of foot and tip.
    const glm::vec3 middle_m = place.moved(middles_m_[i]);
    const float length_m = place.scale * lengths_m_[i];
    const bool is_seen = std::all_of(planes.begin(), planes.end(), [&](const glm::vec4& plane) {
      return glm::dot(plane, glm::vec4(middle_m, 1.0F)) >= -length_m;
    });
    group_of_[i] = kNotSeen;
    if (!is_seen) continue;
    const float distance_m = std::max(glm::distance(eye_m, middle_m) - 0.5F * length_m, kNearestBranch_m);
    const float pixel_m = view.eye_m.w * distance_m;
    const float wanted = length_m / (pixel_m * ring_px);
    const float thick_px = 2.0F * place.scale * parts_[i].base_radius_m / pixel_m;
    const auto tube =
        static_cast<std::size_t>(std::upper_bound(kThick_px.begin(), kThick_px.end(), thick_px) - kThick_px.begin());
    const auto first = groups_.begin() + static_cast<std::ptrdiff_t>(tube * groups_.size() / kSides.size());
    const auto last = first + static_cast<std::ptrdiff_t>(groups_.size() / kSides.size()) - 1;
    const auto group =
        std::find_if(first, last, [&](const BranchGroup& g) { return static_cast<float>(g.rings) >= wanted; });
    group_of_[i] = static_cast<std::size_t>(group - groups_.begin());
    ++group->count;
  }
  chosen_count_ = 0;
  for (BranchGroup& group : groups_) {
    group.first = chosen_count_;
    chosen_count_ += group.count;
    group.count = 0;
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (group_of_[i] == kNotSeen) continue;
    BranchGroup& group = groups_[group_of_[i]];
    chosen_[group.first + group.count++] = parts_[i];
  }
}

}  // namespace yuragi::viewer::meshes::trees
