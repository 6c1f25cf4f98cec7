#include "viewer/meshes/strand_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "viewer/meshes/blades.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr std::size_t kStrandsPerTile = 200;  // on average
constexpr float kReach = 1.1F;                // of a blade's length, around its root
constexpr std::array<std::size_t, 9> kRings{12, 10, 8, 6, 5, 4, 3, 2, 1};

/// The strands, in the order of their tiles and random within a tile, each with its tile.
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

/// The lean of a direction, and that of the tip at rest.
glm::vec2 lean_of(const glm::vec3& direction) {
  const glm::vec2 level(direction.x, direction.z);
  const float sine = glm::length(level);
  return sine > 1e-6F ? level * (std::atan2(sine, direction.y) / sine) : glm::vec2(0.0F);
}
glm::vec2 tip_lean(const pose::StrandSkeleton& strands, std::size_t i) {
  const float curl_rad =
      strands.rest_curl_rad[i] * static_cast<float>(std::max<std::size_t>(strands.links_per_strand, 1) - 1);
  return lean_of(std::cos(curl_rad) * glm::vec3(strands.rest_x[i], strands.rest_y[i], strands.rest_z[i]) +
                 std::sin(curl_rad) * glm::vec3(strands.curl_x[i], strands.curl_y[i], strands.curl_z[i]));
}

}  // namespace

StrandTiles::StrandTiles(const pose::StrandSkeleton& strands, const Thinning& thinning, const GrassDetail& detail)
    : thinning_(thinning), detail_(detail) {
  const std::vector<Blade> forms = blades_of(strands);
  const std::vector<Order> order = tile_order(strands);
  const math::RandomStream chance(0, math::stream_id("viewer blade kinds"));
  const math::RandomStream facing(0, math::stream_id("viewer blade bearings"));
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
      tile.mean_length_m += length_m / static_cast<float>(padded);
      source_.push_back(static_cast<std::uint32_t>(strand));
      const glm::vec2 foot_rad = lean_of({strands.rest_x[strand], strands.rest_y[strand], strands.rest_z[strand]});
      blades_.push_back({.root_m = root_m,
                         .length_m = length_m,
                         .foot_rad = foot_rad,
                         .turned_rad = tip_lean(strands, strand) - foot_rad,
                         .width_m = form.width_m,
                         .facing_rad = static_cast<float>(2.0 * kPi * facing.uniform(strand)),
                         .chance = static_cast<float>(chance.uniform(strand)),
                         .rank = (static_cast<float>(i) + 0.5F) / static_cast<float>(tile.strands)});
    }
    most_strands_ = std::max(most_strands_, padded);
    tiles_.push_back(tile);
    begin = end;
  }

  for (const std::size_t rings : kRings) levels_.push_back({rings, {}});
}

void StrandTiles::choose(const View& view) {
  blocks_.clear();
  in_view_.clear();
  for (Level& level : levels_) level.tiles.clear();
  const std::array<glm::vec4, 5> planes = side_planes(view);
  const glm::vec3 eye_m(view.eye_m);
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const Tile& tile = tiles_[i];
    const float reach_m = kReach * tile.length_m;
    const glm::vec3 low_m = tile.bounds.low_m - glm::vec3(reach_m, 0.0F, reach_m);
    const glm::vec3 high_m = tile.bounds.high_m + reach_m;
    if (!is_in_view(planes, low_m, high_m)) continue;
    // Ranks are compared at the roots: the nearest of them decides.
    const float distance_m = glm::distance(eye_m, glm::clamp(eye_m, tile.bounds.low_m, tile.bounds.high_m));
    if (distance_m < detail_.reach_m) in_view_.emplace_back(distance_m, i);
  }
  // Near ones first, so that hidden parts are not painted.
  std::ranges::sort(in_view_);
  for (const auto& [distance_m, i] : in_view_) {
    const Tile& tile = tiles_[i];
    const auto drawn =
        static_cast<std::size_t>(std::ceil(static_cast<float>(tile.strands) * thinning_.share(distance_m)));
    const std::size_t strands = std::min(drawn, tile.strands);
    const std::size_t rings = detail_.rings(tile.mean_length_m, distance_m, view.eye_m.w);
    std::size_t level = levels_.size() - 1;
    while (level > 0 && levels_[level].rings < rings) --level;
    levels_[level].tiles.push_back({.first_slot = blocks_.size() * pose::kStrandsPerBlock, .strands = strands});
    const std::size_t blocks = (strands + pose::kStrandsPerBlock - 1) / pose::kStrandsPerBlock;
    for (std::size_t k = 0; k < blocks; ++k) blocks_.push_back(static_cast<std::uint32_t>(tile.first_block + k));
  }
}

std::span<const glm::vec2> StrandTiles::bends(const pose::StrandPose& pose) {
  bends_.clear();
  for (const std::uint32_t block : blocks_) {
    for (std::size_t i = block * pose::kStrandsPerBlock; i < (block + 1) * pose::kStrandsPerBlock; ++i) {
      bends_.emplace_back(pose.bend_east_rad[source_[i]], pose.bend_south_rad[source_[i]]);
    }
  }
  return bends_;
}

}  // namespace yuragi::viewer::meshes
