#include "viewer/meshes/blades.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr float kWidthPerSpacing = 0.26F;
constexpr float kMinWidthPerLength = 0.012F;
constexpr float kMaxWidthPerLength = 0.055F;
constexpr float kCullMargin = 1.3F;  // of a blade's length, around its root
/// The sine of the angle below a body's horizon from which on even the tips of its hairs are hidden.
constexpr float kBehind = 0.5F;

/// A few broad waves over the ground, from -1 to 1: the meadow's patches.
float patch(float x_m, float z_m) {
  return 0.5F * std::sin(0.9F * x_m + 0.6F * z_m) + 0.3F * std::sin(1.7F * z_m - 0.7F * x_m + 2.0F) +
         0.2F * std::sin(3.1F * x_m + 1.1F);
}

/// A fox's coat, from dark russet to straw.
glm::vec3 coat_at(float paleness) {
  const glm::vec3 dark(0.110F, 0.042F, 0.016F);
  const glm::vec3 russet(0.330F, 0.130F, 0.040F);
  const glm::vec3 straw(0.480F, 0.300F, 0.140F);
  const float p = std::clamp(paleness, 0.0F, 1.0F);
  return p < 0.5F ? glm::mix(dark, russet, p / 0.5F) : glm::mix(russet, straw, (p - 0.5F) / 0.5F);
}

}  // namespace

std::vector<Blade> blades_of(const pose::StrandSkeleton& skeleton) {
  const Bounds bounds = bounds_of(skeleton);
  const glm::vec3 size_m = bounds.high_m - bounds.low_m;
  const float spacing_m =
      std::sqrt(size_m.x * size_m.z / static_cast<float>(std::max<std::size_t>(1, skeleton.strand_count)));

  const math::RandomStream chance(0, math::stream_id("viewer blades"));
  std::vector<Blade> blades(skeleton.strand_count);
  for (std::size_t i = 0; i < blades.size(); ++i) {
    const auto [first, second] = chance.uniform_pair(2 * i);
    const auto [third, fourth] = chance.uniform_pair(2 * i + 1);
    Blade& blade = blades[i];
    blade.root_m = {skeleton.root_x_m[i], skeleton.root_y_m[i], skeleton.root_z_m[i]};
    blade.strand = static_cast<float>(i);

    blade.facing_rad = static_cast<float>(first * 2.0 * kPi);
    blade.length_m = skeleton.link_length_m[i] * static_cast<float>(skeleton.links_per_strand);
    blade.width_m = std::clamp(kWidthPerSpacing * spacing_m, kMinWidthPerLength * blade.length_m,
                               kMaxWidthPerLength * blade.length_m) *
                    static_cast<float>(0.7 + 0.6 * second);

    const auto spread = static_cast<float>(third - 0.5);
    const float light = static_cast<float>(0.8 + 0.4 * fourth);
    const glm::vec3 tint =
        light * coat_at(0.5F + 0.16F * patch(9.0F * blade.root_m[0], 9.0F * blade.root_m[2]) + 0.3F * spread);
    blade.tint = {tint.r, tint.g, tint.b};
  }
  return blades;
}

BladeSorter::BladeSorter(const pose::StrandSkeleton& skeleton)
    : blades_(blades_of(skeleton)), body_(body_of(skeleton)) {
  const std::size_t links = skeleton.links_per_strand;
  for (std::size_t rings = links; rings >= std::min(links, kMinRings) && rings > 0; --rings) {
    levels_.push_back({rings, false, {}});
  }
  levels_.push_back({std::min(links, kFarRings), true, {}});
}

void BladeSorter::set_openings(std::span<const float> openings) {
  const std::size_t count = std::min(blades_.size(), openings.size());
  for (std::size_t i = 0; i < count; ++i) blades_[i].opening = openings[i];
}

void BladeSorter::sort(const View& view) {
  for (DetailLevel& level : levels_) level.blades.clear();

  const std::array<glm::vec4, 5> planes = side_planes(view);
  const std::size_t most = levels_.front().rings;
  const std::size_t fewest = levels_[levels_.size() - 2].rings;
  for (std::size_t i = 0; i < blades_.size(); ++i) {
    const Blade& blade = blades_[i];
    const glm::vec4 root(blade.root_m[0], blade.root_m[1], blade.root_m[2], 1.0F);
    const float reach_m = kCullMargin * blade.length_m;
    if (std::any_of(planes.begin(), planes.end(),
                    [&](const glm::vec4& plane) { return glm::dot(plane, root) < -reach_m; })) {
      continue;
    }
    const glm::vec3 to_eye = glm::vec3(view.eye_m) - glm::vec3(root);
    const float distance_m = std::max(glm::length(to_eye), 1e-3F);
    if (body_.is_known) {
      const glm::vec3 out = body_.shape * (glm::vec3(root) - body_.middle_m);
      if (glm::dot(out, to_eye) < -kBehind * distance_m * glm::length(out)) continue;
    }
    const float height_px = blade.length_m / (view.eye_m.w * distance_m);
    if (height_px < kFarPx) {
      const float part = std::min(height_px / kTinyPx, 1.0F);
      const float share = height_px >= kTinyPx ? 1.0F : std::max(0.5F * part * part, kFewest);
      // Evenly spread numbers for every share (multiples of the golden ratio).
      const double turns = static_cast<double>(i) * 0.6180339887498949;
      if (static_cast<float>(turns - std::floor(turns)) >= share) continue;
      levels_.back().blades.push_back(blade);
      levels_.back().blades.back().width_m /= std::sqrt(share);
      continue;
    }
    const auto rings = static_cast<std::size_t>(std::min(height_px / kRingPx, 1e6F));
    levels_[most - std::clamp(rings, fewest, most)].blades.push_back(blade);
  }
}

}  // namespace yuragi::viewer::meshes
