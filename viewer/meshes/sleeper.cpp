#include "viewer/meshes/sleeper.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr float kLongForAnimal = 1.8F;
constexpr std::size_t kLimbSides = 14;
constexpr std::size_t kRingsBetween = 5;

/// Hairs on limbs: their number on a square as wide as the body's half width; their length, in radii of the limb, and
/// its minimum; their width, in lengths; and how far they stand up.
constexpr float kHairsPerSquare = 9000.0F;
constexpr float kLongHair = 0.34F;
constexpr float kMinHair = 0.045F;  // in half widths of the body
constexpr float kHairWidth = 0.10F;
constexpr float kHairRise = 0.42F;

constexpr glm::vec3 kCoat{0.42F, 0.215F, 0.095F};
constexpr glm::vec3 kPale{0.58F, 0.44F, 0.30F};
constexpr glm::vec3 kDark{0.055F, 0.035F, 0.025F};

/// A place along a limb: ahead of the body's middle, up from the ground, to the right; and how thick it is. Metres.
struct Station {
  glm::vec3 at_m{0.0F};
  float radius_m = 0.0F;
  glm::vec3 tint = kCoat;
};

Station between(const Station& a, const Station& b, const Station& c, const Station& d, float t) {
  const auto spline = [t](auto p, auto q, auto r, auto s) {
    return q + 0.5F * t * (r - p + t * (2.0F * p - 5.0F * q + 4.0F * r - s + t * (3.0F * (q - r) + s - p)));
  };
  return {spline(a.at_m, b.at_m, c.at_m, d.at_m), spline(a.radius_m, b.radius_m, c.radius_m, d.radius_m),
          b.tint + t * (c.tint - b.tint)};
}

/// Builds limbs in the body's own axes.
class LimbBuilder {
 public:
  LimbBuilder(Limbs& limbs, const glm::vec3& origin_m, const glm::vec3& ahead) : limbs_(&limbs), origin_m_(origin_m) {
    ahead_ = ahead;
    right_ = glm::cross(ahead, glm::vec3(0.0F, 1.0F, 0.0F));
  }

  /// Adds a round limb along a smooth line through its stations, closed at both ends; `flat`: its thickness (upright
  /// or, for a standing limb, forward) relative to its width. Stations with a radius of 0 are its ends.
  void add(std::span<const Station> stations, float flat = 1.0F) {
    const auto base = static_cast<std::uint32_t>(limbs_->vertices.size());
    const std::size_t rings = (stations.size() - 1) * kRingsBetween + 1;
    const auto station = [&](std::size_t ring) {
      const std::size_t first = std::min(ring / kRingsBetween, stations.size() - 2);
      const auto t = static_cast<float>(ring - first * kRingsBetween) / static_cast<float>(kRingsBetween);
      const std::size_t last = stations.size() - 1;
      return between(stations[first == 0 ? 0 : first - 1], stations[first], stations[first + 1],
                     stations[std::min(first + 2, last)], t);
    };
    float along_m = 0.0F;
    for (std::size_t ring = 0; ring < rings; ++ring) {
      const Station here = station(ring);
      const Station before = station(ring == 0 ? 0 : ring - 1);
      const Station next = station(std::min(ring + 1, rings - 1));
      const glm::vec3 way_m = next.at_m - before.at_m;
      const float long_m = glm::length(way_m);
      const glm::vec3 along = way_m / long_m;
      const bool stands = std::abs(along.y) > 0.8F;
      const glm::vec3 aside = glm::normalize(stands ? glm::cross(glm::vec3(1.0F, 0.0F, 0.0F), along)
                                                    : glm::cross(along, glm::vec3(0.0F, 1.0F, 0.0F)));
      const glm::vec3 over = glm::cross(aside, along);
      const float taper = (next.radius_m - before.radius_m) / long_m;
      along_m += glm::distance(here.at_m, before.at_m);
      for (std::size_t side = 0; side <= kLimbSides; ++side) {
        const float turn_rad =
            static_cast<float>(2.0 * kPi) * static_cast<float>(side) / static_cast<float>(kLimbSides);
        const glm::vec3 out = std::cos(turn_rad) * aside + std::sin(turn_rad) * flat * over;
        const glm::vec3 facing =
            glm::normalize(std::cos(turn_rad) * flat * aside + std::sin(turn_rad) * over - taper * flat * along);
        limbs_->vertices.push_back({origin_m_ + in_world(here.at_m + std::max(here.radius_m, 0.0F) * out),
                                    in_world(facing),
                                    here.tint,
                                    {along_m, turn_rad * stations[1].radius_m},
                                    in_world(along),
                                    std::max(here.radius_m, 0.0F)});
        if (ring + 1 == rings || side == kLimbSides) continue;
        const auto corner = static_cast<std::uint32_t>(base + ring * (kLimbSides + 1) + side);
        constexpr auto kRing = static_cast<std::uint32_t>(kLimbSides + 1);
        limbs_->indices.insert(limbs_->indices.end(),
                               {corner, corner + kRing, corner + 1, corner + 1, corner + kRing, corner + kRing + 1});
      }
    }
  }

 private:
  glm::vec3 in_world(const glm::vec3& way) const {
    return way.x * ahead_ + glm::vec3(0.0F, way.y, 0.0F) + way.z * right_;
  }

  Limbs* limbs_;
  glm::vec3 origin_m_, ahead_{0.0F}, right_{0.0F};
};

/// Level, of length 1: opposite to the hairs' mean direction. 0 if they stand up.
glm::vec3 ahead_of(const pose::StrandSkeleton& coat) {
  glm::vec3 lie(0.0F);
  for (std::size_t i = 0; i < coat.strand_count; ++i) lie += glm::vec3(coat.rest_x[i], 0.0F, coat.rest_z[i]);
  const float length = glm::length(lie);
  return length > 0.0F ? -lie / length : glm::vec3(0.0F);
}

/// A step that visits each of `count` things once and returns to the first, such that any first part of them is evenly
/// spread over all: a number without a common divisor, near the golden ratio's part of them.
std::size_t spreading_step(std::size_t count) {
  auto step = static_cast<std::size_t>(static_cast<double>(count) / std::numbers::phi);
  while (std::gcd(step, count) != 1) ++step;
  return step;
}

/// Adds hairs over the whole skin, along its limbs; `unit_m`: half the body's width.
void add_hairs(Limbs& limbs, float unit_m) {
  limbs.skin_count = limbs.indices.size();
  const math::RandomStream chance(0, math::stream_id("viewer limb hairs"));
  std::uint64_t drawn = 0;
  std::vector<std::uint32_t> feet;  // the first vertex of each hair
  for (std::size_t first = 0; first < limbs.skin_count; first += 3) {
    const auto corner = [&](std::size_t i) { return limbs.vertices[limbs.indices[first + i]]; };
    const LimbVertex a = corner(0);
    const LimbVertex b = corner(1);
    const LimbVertex c = corner(2);
    const float area_m2 = 0.5F * glm::length(glm::cross(b.place_m - a.place_m, c.place_m - a.place_m));
    const float wanted = kHairsPerSquare * area_m2 / (unit_m * unit_m);
    const auto count = static_cast<int>(wanted + static_cast<float>(chance.uniform(2 * drawn++)));
    for (int i = 0; i < count; ++i) {
      const auto [u, v] = chance.uniform_pair(drawn++);
      const auto [turn, size] = chance.uniform_pair(drawn++);
      // Evenly over the triangle (R. Osada and others 2002, "Shape distributions").
      const auto root = static_cast<float>(std::sqrt(u));
      const auto part = static_cast<float>(v);
      const auto mixed = [&](auto LimbVertex::*of) {
        return (1.0F - root) * (a.*of) + root * (1.0F - part) * (b.*of) + root * part * (c.*of);
      };
      const glm::vec3 place_m = mixed(&LimbVertex::place_m);
      const glm::vec3 normal = glm::normalize(mixed(&LimbVertex::normal));
      const glm::vec3 lie = mixed(&LimbVertex::lie);
      const glm::vec3 level = lie - glm::dot(lie, normal) * normal;
      if (!(glm::length(level) > 1e-3F)) continue;
      const glm::vec3 along = glm::normalize(level);
      const glm::vec3 across = glm::cross(along, normal);
      const auto aside = static_cast<float>(turn) - 0.5F;
      const float length_m = std::max(kLongHair * mixed(&LimbVertex::radius_m), kMinHair * unit_m) *
                             (0.6F + 0.6F * static_cast<float>(size));
      const glm::vec3 way = glm::normalize(along + 0.7F * aside * across + (kHairRise + 0.3F * aside) * normal);
      const glm::vec3 half_m = 0.5F * kHairWidth * length_m * across;
      const glm::vec3 tint = mixed(&LimbVertex::tint) * (0.75F + 0.5F * static_cast<float>(size));
      const glm::vec2 hair_m = mixed(&LimbVertex::hair_m);
      const auto at = static_cast<std::uint32_t>(limbs.vertices.size());
      const float radius_m = mixed(&LimbVertex::radius_m);
      // Rooted a little below the skin, and paler at the tip.
      const glm::vec3 foot_m = place_m - 0.1F * length_m * normal;
      limbs.vertices.push_back({foot_m - half_m, normal, 0.8F * tint, hair_m, lie, radius_m, -half_m});
      limbs.vertices.push_back({foot_m + half_m, normal, 0.8F * tint, hair_m, lie, radius_m, half_m});
      limbs.vertices.push_back({foot_m + length_m * way, normal, 1.35F * tint, hair_m, lie, radius_m});
      feet.push_back(at);
      limbs.hair_m = std::max(limbs.hair_m, length_m);
    }
  }
  if (feet.empty()) return;
  const std::size_t step = spreading_step(feet.size());
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const std::uint32_t foot = feet[i * step % feet.size()];
    limbs.indices.insert(limbs.indices.end(), {foot, foot + 1, foot + 2});
  }
}

}  // namespace

Limbs limbs_of(const pose::StrandSkeleton& coat, const Body& body) {
  Limbs limbs;
  if (!body.is_known || coat.rest_x.size() < coat.strand_count) return limbs;
  const glm::vec3 ahead = ahead_of(coat);
  if (!(glm::length(ahead) > 0.0F)) return limbs;
  const glm::vec3 right = glm::cross(ahead, glm::vec3(0.0F, 1.0F, 0.0F));
  const float a = 1.0F / std::sqrt(glm::dot(ahead, body.shape * ahead));  // half its length, its height, half its width
  const float b = 1.0F / std::sqrt(body.shape[1][1]);
  const float c = 1.0F / std::sqrt(glm::dot(right, body.shape * right));
  if (a < kLongForAnimal * c) return limbs;

  const float k = std::min(c, 0.5F * a);
  LimbBuilder builder(limbs, body.middle_m, ahead);
  const auto at = [&](float ahead_a, float ahead_k, float up_k, float right_k, float radius_k,
                      const glm::vec3& tint = kCoat) {
    return Station{{ahead_a * a + ahead_k * k, up_k * k, right_k * k}, radius_k * k, tint};
  };
  const float shoulder = 0.62F * b / k;
  // Neck, head and muzzle, turned a little aside, the chin on the forepaws.
  const Station head[] = {at(0.40F, 0.0F, shoulder, 0.0F, 0.0F),       at(0.58F, 0.0F, shoulder, 0.0F, 0.62F),
                          at(0.88F, 0.0F, 1.00F, 0.08F, 0.50F),        at(1.0F, 0.25F, 0.80F, 0.20F, 0.42F),
                          at(1.0F, 0.55F, 0.64F, 0.30F, 0.43F),        at(1.0F, 0.86F, 0.47F, 0.38F, 0.30F, kPale),
                          at(1.0F, 1.22F, 0.36F, 0.48F, 0.17F, kPale), at(1.0F, 1.44F, 0.34F, 0.53F, 0.13F, kDark),
                          at(1.0F, 1.54F, 0.33F, 0.56F, 0.0F, kDark)};
  builder.add(head);
  for (const float side : {-1.0F, 1.0F}) {
    const Station ear[] = {
        at(1.0F, 0.42F, 0.92F, 0.28F + 0.22F * side, 0.0F), at(1.0F, 0.38F, 1.02F, 0.28F + 0.26F * side, 0.24F),
        at(1.0F, 0.28F, 1.30F, 0.28F + 0.40F * side, 0.19F), at(1.0F, 0.18F, 1.60F, 0.28F + 0.50F * side, 0.0F, kDark)};
    builder.add(ear, 0.4F);
    const Station foreleg[] = {
        at(0.45F, 0.0F, 0.50F, 0.45F * side, 0.0F),         at(0.70F, 0.0F, 0.34F, 0.55F * side, 0.34F),
        at(1.0F, 0.20F, 0.18F, 0.58F * side, 0.18F),        at(1.0F, 1.00F, 0.13F, 0.46F * side, 0.13F),
        at(1.0F, 1.30F, 0.12F, 0.44F * side, 0.15F, kPale), at(1.0F, 1.48F, 0.10F, 0.44F * side, 0.0F, kPale)};
    builder.add(foreleg);
    const Station haunch[] = {at(-0.85F, 0.0F, 0.50F, 0.70F * side, 0.0F), at(-0.66F, 0.0F, 0.60F, 0.74F * side, 0.46F),
                              at(-0.38F, 0.0F, 0.62F, 0.78F * side, 0.56F),
                              at(-0.12F, 0.0F, 0.40F, 0.90F * side, 0.34F), at(0.02F, 0.0F, 0.26F, 0.98F * side, 0.0F)};
    builder.add(haunch);
    const Station hind_paw[] = {
        at(-0.40F, 0.0F, 0.15F, 1.12F * side, 0.0F), at(-0.32F, 0.0F, 0.15F, 1.14F * side, 0.16F),
        at(-0.02F, 0.0F, 0.12F, 1.20F * side, 0.13F), at(0.08F, 0.0F, 0.12F, 1.20F * side, 0.15F, kPale),
        at(0.18F, 0.0F, 0.10F, 1.20F * side, 0.0F, kPale)};
    builder.add(hind_paw);
  }
  // A bushy tail, from behind around its right side.
  const Station tail[] = {at(-0.85F, 0.0F, 0.50F, 0.0F, 0.0F),       at(-1.0F, 0.0F, 0.36F, 0.15F, 0.24F),
                          at(-1.0F, -0.35F, 0.27F, 0.85F, 0.30F),    at(-0.85F, 0.0F, 0.30F, 1.62F, 0.35F),
                          at(-0.40F, 0.0F, 0.30F, 1.78F, 0.35F),     at(0.0F, 0.0F, 0.26F, 1.72F, 0.27F, kPale),
                          at(0.25F, 0.0F, 0.20F, 1.58F, 0.0F, kPale)};
  builder.add(tail);
  add_hairs(limbs, k);
  return limbs;
}

}  // namespace yuragi::viewer::meshes
