#include "viewer/meshes/strand_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/math/philox.hpp"
#include "viewer/meshes/blades.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr std::size_t kStrandsPerTile = 400;  // on average
constexpr float kRingPx = 24.0F;              // a ring for each of so many pixels of a blade's height
constexpr float kReach = 1.1F;                // of a blade's length, around its root

/// Of the strands, in the order of their tiles and within a tile at random, each with its tile.
struct Order {
  std::size_t strand, tile;
  double chance;
};

std::vector<Order> tile_order(const pose::StrandSkeleton& strands) {
  const Bounds bounds = bounds_of(strands);
  const glm::vec3 size_m = glm::max(bounds.high_m - bounds.low_m, glm::vec3(0.01F));
  const float tiles = static_cast<float>(strands.strand_count) / static_cast<float>(kStrandsPerTile);
  const float side_m = std::max(std::sqrt(size_m.x * size_m.z / std::max(tiles, 1.0F)), 0.01F);
  const auto columns = static_cast<std::size_t>(size_m.x / side_m) + 1;
  const math::RandomStream chance(0, math::stream_id("viewer strand tiles"));
  std::vector<Order> order(strands.strand_count);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto column = static_cast<std::size_t>((strands.root_x_m[i] - bounds.low_m.x) / side_m);
    const auto row = static_cast<std::size_t>((strands.root_z_m[i] - bounds.low_m.z) / side_m);
    order[i] = {.strand = i, .tile = row * columns + column, .chance = chance.uniform(i)};
  }
  std::ranges::sort(order, [](const Order& a, const Order& b) {
    return std::tuple(a.tile, a.chance, a.strand) < std::tuple(b.tile, b.chance, b.strand);
  });
  return order;
}

}  // namespace

StrandTiles::StrandTiles(const pose::StrandSkeleton& strands, const Thinning& thinning) : thinning_(thinning) {
  const std::vector<Blade> forms = blades_of(strands);
  const std::vector<Order> order = tile_order(strands);
  const math::RandomStream chance(0, math::stream_id("viewer blade kinds"));
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && order[end].tile == order[begin].tile) ++end;
    Tile tile{.bounds = {glm::vec3(1e9F), glm::vec3(-1e9F)},
              .first_block = source_.size() / pose::kStrandsPerBlock,
              .strands = end - begin};
    const std::size_t padded = pose::padded_to_blocks(tile.strands);
    for (std::size_t i = 0; i < padded; ++i) {
      const std::size_t strand = order[begin + std::min(i, tile.strands - 1)].strand;  // the last one fills its block
      const Blade& form = forms[strand];
      const float length_m = strands.link_length_m[strand] * static_cast<float>(strands.links_per_strand);
      const glm::vec3 root_m(form.root_m[0], form.root_m[1], form.root_m[2]);
      tile.bounds = united(tile.bounds, {root_m, root_m});
      tile.length_m = std::max(tile.length_m, length_m);
      source_.push_back(static_cast<std::uint32_t>(strand));
      blades_.push_back({.root_x_m = root_m.x,
                         .root_y_m = root_m.y,
                         .root_z_m = root_m.z,
                         .width_m = form.width_m,
                         .facing_rad = form.facing_rad,
                         .chance = static_cast<float>(chance.uniform(strand)),
                         .rank = (static_cast<float>(i) + 0.5F) / static_cast<float>(tile.strands),
                         .length_m = length_m});
    }
    most_strands_ = std::max(most_strands_, padded);
    tiles_.push_back(tile);
    begin = end;
  }

  tiled_.strand_count = source_.size();
  tiled_.links_per_strand = strands.links_per_strand;
  using Array = std::vector<float> pose::StrandSkeleton::*;
  for (const Array array :
       {&pose::StrandSkeleton::root_x_m, &pose::StrandSkeleton::root_y_m, &pose::StrandSkeleton::root_z_m,
        &pose::StrandSkeleton::rest_x, &pose::StrandSkeleton::rest_y, &pose::StrandSkeleton::rest_z,
        &pose::StrandSkeleton::curl_x, &pose::StrandSkeleton::curl_y, &pose::StrandSkeleton::curl_z,
        &pose::StrandSkeleton::rest_curl_rad, &pose::StrandSkeleton::link_length_m}) {
    for (const std::uint32_t strand : source_) (tiled_.*array).push_back((strands.*array)[strand]);
  }

  const std::size_t links = strands.links_per_strand;
  for (const std::size_t rings : {links, links / 2, std::size_t{3}, std::size_t{2}}) {
    const std::size_t some = std::clamp<std::size_t>(rings, 1, std::max<std::size_t>(links, 1));
    if (levels_.empty() || some < levels_.back().rings) levels_.push_back({some, {}});
  }
}

void StrandTiles::choose(const View& view) {
  blocks_.clear();
  for (Level& level : levels_) level.tiles.clear();
  const std::array<glm::vec4, 5> planes = side_planes(view);
  const glm::vec3 eye_m(view.eye_m);
  for (const Tile& tile : tiles_) {
    const glm::vec3 low_m = tile.bounds.low_m - kReach * tile.length_m;
    const glm::vec3 high_m = tile.bounds.high_m + kReach * tile.length_m;
    if (!is_in_view(planes, low_m, high_m)) continue;

    // Ranks are compared at the roots: the nearest of them decides.
    const float distance_m = glm::distance(eye_m, glm::clamp(eye_m, tile.bounds.low_m, tile.bounds.high_m));
    const auto drawn =
        static_cast<std::size_t>(std::ceil(static_cast<float>(tile.strands) * thinning_.share(distance_m)));
    const std::size_t strands = std::min(drawn, tile.strands);
    const float height_px = tile.length_m / (view.eye_m.w * std::max(distance_m, 1e-3F));
    const auto rings = static_cast<std::size_t>(std::min(height_px / kRingPx, 1e6F));
    std::size_t level = levels_.size() - 1;
    while (level > 0 && levels_[level].rings < rings) --level;
    levels_[level].tiles.push_back({.first_slot = blocks_.size() * pose::kStrandsPerBlock, .strands = strands});
    const std::size_t blocks = (strands + pose::kStrandsPerBlock - 1) / pose::kStrandsPerBlock;
    for (std::size_t i = 0; i < blocks; ++i) blocks_.push_back(static_cast<std::uint32_t>(tile.first_block + i));
  }
}

void StrandTiles::take(const pose::StrandPose& pose, pose::StrandPose& tiled) const {
  for (const std::uint32_t block : blocks_) {
    for (std::size_t i = block * pose::kStrandsPerBlock; i < (block + 1) * pose::kStrandsPerBlock; ++i) {
      tiled.bend_east_rad[i] = pose.bend_east_rad[source_[i]];
      tiled.bend_south_rad[i] = pose.bend_south_rad[source_[i]];
    }
  }
}

}  // namespace yuragi::viewer::meshes
