#include "viewer/meshes/cloth_holder.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace yuragi::viewer::meshes {
namespace {

const glm::vec3 kCedar(0.205F, 0.112F, 0.056F);
const glm::vec3 kOak(0.150F, 0.078F, 0.034F);
const glm::vec3 kBamboo(0.36F, 0.29F, 0.115F);
const glm::vec3 kBambooNode(0.22F, 0.17F, 0.065F);
const glm::vec3 kPainted(0.62F, 0.62F, 0.60F);
const glm::vec3 kStone(0.27F, 0.26F, 0.24F);
const glm::vec3 kBrass(0.62F, 0.40F, 0.10F);
const glm::vec3 kRope(0.52F, 0.48F, 0.40F);
const glm::vec3 kCotton(0.72F, 0.70F, 0.64F);

constexpr float kHighestFloor_m = 1.2F;
constexpr float kFloorUnderHem_m = 0.03F;

glm::vec3 on_ground(const glm::vec3& place) {
  return {place.x, std::min(0.0F, place.y), place.z};
}

/// The joints of the fixed edge that protrude most to either side of it, in their order; if there are none, some that
/// are evenly spread.
std::vector<glm::vec3> crests(const pose::GridSkeleton& cloth, const glm::vec3& aside) {
  constexpr float kFlat_m = 0.002F;
  constexpr float kEvery_m = 0.15F;
  constexpr std::size_t kMaxRings = 400;
  std::vector<glm::vec3> found;
  const auto out_m = [&](std::size_t column) { return glm::dot(cloth_joint(cloth, column, 0), aside); };
  for (std::size_t i = 1; i + 1 < cloth.columns; ++i) {
    const bool is_crest = (out_m(i) - out_m(i - 1)) * (out_m(i + 1) - out_m(i)) < 0.0F;
    const glm::vec3 place = cloth_joint(cloth, i, 0);
    if (is_crest && found.size() < kMaxRings && (found.empty() || glm::distance(found.back(), place) > kFlat_m))
      found.push_back(place);
  }
  if (found.size() >= 2) return found;
  found.clear();
  const glm::vec3 first = cloth_joint(cloth, 0, 0);
  const glm::vec3 last = cloth_joint(cloth, cloth.columns - 1, 0);
  const auto gaps = static_cast<std::size_t>(std::clamp(glm::distance(first, last) / kEvery_m, 2.0F, 200.0F));
  for (std::size_t i = 0; i <= gaps; ++i) {
    found.push_back(first + (last - first) * (static_cast<float>(i) / static_cast<float>(gaps)));
  }
  return found;
}

/// A free-standing frame of two posts and a broad beam over them, in the manner of a gate; below the beam a rod, from
/// which the cloth hangs by rings.
void add_frame(const pose::GridSkeleton& cloth, SolidMesh& mesh) {
  const glm::vec3 first = cloth_joint(cloth, 0, 0);
  const glm::vec3 last = cloth_joint(cloth, cloth.columns - 1, 0);
  const glm::vec3 level(last.x - first.x, 0.0F, last.z - first.z);
  const float width_m = glm::length(level);
  if (width_m <= 0.0F) return;
  const glm::vec3 along = level / width_m;
  const glm::vec3 aside(-along.z, 0.0F, along.x);
  const float top_m = std::max(first.y, last.y);
  const float size = std::clamp(width_m / 3.0F, 0.2F, 2.5F);
  const float post_m = 0.055F * size;
  const float rod_m = 0.015F * size;
  const float rod_y_m = top_m + 0.045F * size;
  const float beam_y_m = top_m + 0.15F * size;

  mesh.set_grain(1.0F);
  for (const glm::vec3& end : {first - 0.17F * size * along, last + 0.17F * size * along}) {
    const float low_m = std::min(0.0F, end.y);
    mesh.add_beam(end - post_m * along, end + post_m * along, post_m, low_m, beam_y_m, kCedar);
    mesh.set_grain(0.0F);
    mesh.add_beam(end - 1.9F * post_m * along, end + 1.9F * post_m * along, 1.9F * post_m, low_m, low_m + 0.16F * size,
                  kStone);
    mesh.set_grain(1.0F);
  }
  const glm::vec3 over = 0.60F * size * along;
  mesh.add_beam(first - over, last + over, 0.060F * size, beam_y_m, beam_y_m + 0.105F * size, kCedar);
  mesh.add_beam(first - 1.12F * over, last + 1.12F * over, 0.095F * size, beam_y_m + 0.105F * size,
                beam_y_m + 0.135F * size, 0.8F * kCedar);
  const auto at_rod = [&](const glm::vec3& place) { return glm::vec3(place.x, rod_y_m, place.z); };
  mesh.add_tube(at_rod(first - 0.17F * size * along), at_rod(last + 0.17F * size * along), rod_m, rod_m, kOak);
  mesh.set_grain(0.0F);

  const glm::vec3 middle = 0.5F * (first + last);
  for (const glm::vec3& crest : crests(cloth, aside)) {
    const glm::vec3 on_rod = at_rod(crest - glm::dot(crest - middle, aside) * aside) + glm::vec3(0.0F, rod_m, 0.0F);
    const glm::vec3 hole = crest - glm::vec3(0.0F, 0.012F * size, 0.0F);
    mesh.add_ring(0.5F * (on_rod + hole), along, 0.5F * glm::distance(on_rod, hole), 0.0028F * size, kBrass);
  }
}

float pole_radius_m(float top_m) {
  return std::clamp(0.008F * top_m, 0.010F, 0.06F);
}

/// A painted pole on a stone foot, with a truck and a ball on top, rings that hold the hoist, and the halyard, made
/// fast at a cleat.
void add_flag_pole(const glm::vec3& top, const glm::vec3& low, SolidMesh& mesh) {
  const float radius_m = pole_radius_m(top.y);
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  const glm::vec3 foot = on_ground(top);
  const glm::vec3 peak = top + 3.0F * radius_m * up;
  mesh.add_tube(foot, peak, 1.2F * radius_m, 0.75F * radius_m, kPainted);
  mesh.add_tube(foot, foot + 2.5F * radius_m * up, 3.2F * radius_m, 2.7F * radius_m, kStone);
  mesh.add_tube(foot + 2.5F * radius_m * up, foot + 2.6F * radius_m * up, 2.7F * radius_m, 0.5F * radius_m, kStone);
  mesh.add_tube(foot + 2.5F * radius_m * up, foot + 5.0F * radius_m * up, 1.6F * radius_m, 1.25F * radius_m, kBrass);
  mesh.add_tube(peak, peak + 0.6F * radius_m * up, 1.25F * radius_m, 1.25F * radius_m, kBrass);
  mesh.add_ball(peak + 1.9F * radius_m * up, 1.6F * radius_m, kBrass);

  const float height_m = top.y - low.y;
  for (const float part : {0.03F, 0.35F, 0.65F, 0.97F}) {
    mesh.add_ring(low + part * height_m * up, up, 1.12F * radius_m, 0.11F * radius_m, kBrass);
  }
  // Its two parts hang a little apart, on the side away from the usual wind.
  const glm::vec3 out(0.80F, 0.0F, 0.60F);
  const glm::vec3 beside(-0.60F, 0.0F, 0.80F);
  const float cleat_y_m = foot.y + 0.22F * (top.y - foot.y);
  const glm::vec3 cleat = glm::vec3(top.x, cleat_y_m, top.z) + 1.5F * radius_m * out;
  for (const float side : {-0.5F, 0.5F}) {
    mesh.add_tube(cleat, peak + 1.1F * radius_m * out + side * radius_m * beside, 0.0035F, 0.0035F, kRope);
  }
  mesh.add_tube(cleat - 2.0F * radius_m * up, cleat + 2.0F * radius_m * up, 0.22F * radius_m, 0.22F * radius_m, kBrass);
  mesh.add_tube(cleat - 0.8F * radius_m * up, cleat + 0.8F * radius_m * up, 0.4F * radius_m, 0.4F * radius_m, kRope);
}

/// The number of things at this distance along a length, with an upper limit.
int count_of(float length_m, float every_m) {
  return static_cast<int>(std::clamp(std::ceil(length_m / every_m), 0.0F, 100.0F));
}

/// Bamboo from the ground to above the arm, with the loops (chichi) that the cloth is hung by along both.
void add_banner_pole(const pose::GridSkeleton& cloth, SolidMesh& mesh) {
  const glm::vec3 first = cloth_joint(cloth, 0, 0);
  const glm::vec3 last = cloth_joint(cloth, cloth.columns - 1, 0);
  const glm::vec3 low = cloth_joint(cloth, 0, cloth.rows - 1);
  const float width_m = glm::distance(first, last);
  const float radius_m = std::clamp(0.006F * first.y, 0.008F, 0.05F);
  const glm::vec3 up(0.0F, 1.0F, 0.0F);
  const glm::vec3 foot = on_ground(first);
  const glm::vec3 peak = first + 5.0F * radius_m * up;
  mesh.set_grain(0.6F);
  mesh.add_tube(foot, peak, 1.15F * radius_m, 0.85F * radius_m, kBamboo);
  const glm::vec3 arm_end = first + 1.08F * (last - first);
  const float arm_m = 0.6F * radius_m;
  mesh.add_tube(first, arm_end, arm_m, 0.8F * arm_m, kBamboo);
  mesh.set_grain(0.0F);
  mesh.add_ball(peak, 1.1F * radius_m, kBamboo);
  mesh.add_ball(arm_end, 1.1F * arm_m, kBrass);
  const float height_m = peak.y - foot.y;
  for (int node = 0; node < count_of(height_m - 0.28F, 0.37F); ++node) {
    const float y_m = 0.28F + 0.37F * static_cast<float>(node);
    const float here_m = radius_m * (1.15F - 0.30F * y_m / height_m);
    mesh.add_ring(foot + y_m * up, up, here_m, 0.14F * here_m, kBambooNode);
  }

  const float band_m = std::clamp(0.03F * width_m, 0.006F, 0.05F);
  const float length_m = glm::distance(first, low);
  const float down_every_m = std::max(0.45F * width_m, 0.05F);
  for (int loop = 0; loop < count_of(length_m - 2.0F * band_m, down_every_m); ++loop) {
    const glm::vec3 middle = first - (2.0F * band_m + down_every_m * static_cast<float>(loop)) * up;
    const float loop_m = 1.35F * radius_m;
    mesh.add_tube(middle - band_m * up, middle + band_m * up, loop_m, loop_m, kCotton);
  }
  if (width_m <= 0.0F) return;
  const glm::vec3 along = (last - first) / width_m;
  constexpr int kArmLoops = 5;
  for (int i = 0; i < kArmLoops; ++i) {
    const glm::vec3 middle = first + (0.12F + 0.82F * static_cast<float>(i) / (kArmLoops - 1)) * (last - first);
    mesh.add_tube(middle - band_m * along, middle + band_m * along, 1.5F * arm_m, 1.5F * arm_m, kCotton);
  }
}

}  // namespace

SolidMesh cloth_holder(ClothStyle style, const pose::GridSkeleton& cloth) {
  SolidMesh mesh;
  if (cloth.columns < 2 || cloth.rows < 2) return mesh;
  switch (style) {
    case ClothStyle::kCurtain:
      add_frame(cloth, mesh);
      break;
    case ClothStyle::kFlag: {
      const glm::vec3 first = cloth_joint(cloth, 0, 0);
      const glm::vec3 last = cloth_joint(cloth, cloth.columns - 1, 0);
      add_flag_pole(first.y < last.y ? last : first, first.y < last.y ? first : last, mesh);
      break;
    }
    case ClothStyle::kBanner:
      add_banner_pole(cloth, mesh);
      break;
  }
  return mesh;
}

std::optional<Floor> cloth_floor(ClothStyle style, const pose::GridSkeleton& cloth) {
  if (style != ClothStyle::kCurtain || cloth.columns < 2 || cloth.rows < 2) return std::nullopt;
  const glm::vec3 first = cloth_joint(cloth, 0, 0);
  const glm::vec3 last = cloth_joint(cloth, cloth.columns - 1, 0);
  const glm::vec2 level(last.x - first.x, last.z - first.z);
  const float width_m = glm::length(level);
  float hem_m = first.y;
  for (std::size_t i = 0; i < cloth.columns; ++i) hem_m = std::min(hem_m, cloth_joint(cloth, i, cloth.rows - 1).y);
  const float length_m = first.y - hem_m;
  if (width_m <= 0.0F || length_m <= 0.0F || hem_m > kHighestFloor_m || hem_m < 0.0F) return std::nullopt;
  const glm::vec3 middle = 0.5F * (first + last);
  return Floor{.middle_m = {middle.x, std::max(hem_m - kFloorUnderHem_m, 0.02F), middle.z},
               .along = level / width_m,
               .half_m = {0.5F * width_m + 0.32F * std::clamp(width_m, 0.6F, 7.5F), 0.85F * length_m}};
}

}  // namespace yuragi::viewer::meshes
