#include "viewer/meshes/body.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/base/units.hpp"
#include "viewer/meshes/bounds.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr std::size_t kUnknowns = 7;
constexpr float kBelow_m = 0.02F;
constexpr double kHairsAway = 2.5;  // a camera stays this many hair lengths away from the skin
constexpr std::size_t kSkinRows = 40;
constexpr std::size_t kSkinColumns = 80;
using Equations = std::array<std::array<double, kUnknowns + 1>, kUnknowns>;

/// Solves them in place (Gauss). Returns false if there is no unique solution.
bool solve(Equations& equations, std::array<double, kUnknowns>& solution) {
  for (std::size_t column = 0; column < kUnknowns; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column; row < kUnknowns; ++row) {
      if (std::abs(equations[row][column]) > std::abs(equations[pivot][column])) pivot = row;
    }
    std::swap(equations[column], equations[pivot]);
    if (!(std::abs(equations[column][column]) > 1e-9)) return false;
    for (std::size_t row = 0; row < kUnknowns; ++row) {
      if (row == column) continue;
      const double factor = equations[row][column] / equations[column][column];
      for (std::size_t i = column; i <= kUnknowns; ++i) equations[row][i] -= factor * equations[column][i];
    }
  }
  for (std::size_t i = 0; i < kUnknowns; ++i) solution[i] = equations[i][kUnknowns] / equations[i][i];
  return true;
}

/// Fits x^2, y^2, z^2, x z, x, y and z to 1 for all roots, in box coordinates. Returns true if the result is an
/// ellipsoid.
bool fit(const pose::StrandSkeleton& coat, const glm::dvec3& middle_m, double unit_m, Body& body) {
  Equations equations{};
  for (std::size_t i = 0; i < coat.strand_count; ++i) {
    const glm::dvec3 p = (glm::dvec3(coat.root_x_m[i], coat.root_y_m[i], coat.root_z_m[i]) - middle_m) / unit_m;
    const std::array<double, kUnknowns + 1> terms{p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.z, p.x, p.y, p.z, 1.0};
    for (std::size_t row = 0; row < kUnknowns; ++row) {
      for (std::size_t column = 0; column <= kUnknowns; ++column) equations[row][column] += terms[row] * terms[column];
    }
  }
  for (auto& row : equations) {
    for (double& value : row) value /= static_cast<double>(coat.strand_count);
  }
  std::array<double, kUnknowns> s{};
  if (!solve(equations, s)) return false;
  const double level = s[0] * s[2] - 0.25 * s[3] * s[3];
  if (!(s[0] > 0.0 && s[1] > 0.0 && s[2] > 0.0 && level > 0.0)) return false;
  const glm::dvec3 off(-0.5 * (s[2] * s[4] - 0.5 * s[3] * s[6]) / level, -0.5 * s[5] / s[1],
                       -0.5 * (s[0] * s[6] - 0.5 * s[3] * s[4]) / level);
  const double reach = 1.0 + s[0] * off.x * off.x + s[1] * off.y * off.y + s[2] * off.z * off.z + s[3] * off.x * off.z;
  if (!(reach > 0.0) || glm::length(off) > 20.0) return false;
  const double scale = 1.0 / (reach * unit_m * unit_m);
  body.middle_m = glm::vec3(middle_m + off * unit_m);
  body.shape = glm::mat3(
      glm::dmat3(s[0] * scale, 0.0, 0.5 * s[3] * scale, 0.0, s[1] * scale, 0.0, 0.5 * s[3] * scale, 0.0, s[2] * scale));
  return true;
}

}  // namespace

Body body_of(const pose::StrandSkeleton& coat) {
  Body body;
  if (coat.strand_count == 0) return body;
  Bounds roots{glm::vec3(1e9F), glm::vec3(-1e9F)};
  for (std::size_t i = 0; i < coat.strand_count; ++i) {
    const glm::vec3 root(coat.root_x_m[i], coat.root_y_m[i], coat.root_z_m[i]);
    roots = united(roots, {root, root});
  }
  const glm::vec3 half_m = glm::max((roots.high_m - roots.low_m) / 2.0F, glm::vec3(0.01F));
  const glm::vec3 middle_m = (roots.low_m + roots.high_m) / 2.0F;
  body.low_m = roots.low_m.y;
  body.is_known = fit(coat, glm::dvec3(middle_m), static_cast<double>(std::max({half_m.x, half_m.y, half_m.z})), body);
  if (!body.is_known) {
    body.middle_m = middle_m;
    const glm::vec3 inverse = 1.0F / (half_m * half_m);
    body.shape = glm::mat3(inverse.x, 0.0F, 0.0F, 0.0F, inverse.y, 0.0F, 0.0F, 0.0F, inverse.z);
  }
  for (std::size_t i = 0; i < std::min(coat.strand_count, coat.link_length_m.size()); ++i) {
    body.hair_m += coat.link_length_m[i] * static_cast<float>(coat.links_per_strand);
  }
  body.hair_m /= static_cast<float>(coat.strand_count);
  // The area under the hairs is nearly that of an ellipse, bulged.
  const float area_m2 = 2.0F * (half_m.x * half_m.y + half_m.y * half_m.z + 1.5F * half_m.z * half_m.x);
  body.spacing_m = std::sqrt(area_m2 / static_cast<float>(coat.strand_count));
  return body;
}

CameraPlace outside(const Body& body, const CameraPlace& place) {
  // On the view's line the eye is target + distance * back. It leaves an ellipsoid whose half axes are extended by the
  // distance to keep at the larger root of a quadratic.
  const double away_m = kHairsAway * static_cast<double>(body.hair_m);
  const double half_m =
      1.0 / std::sqrt(static_cast<double>(std::max({body.shape[0][0], body.shape[1][1], body.shape[2][2]})));
  const double larger = (half_m + away_m) / half_m;
  const glm::dmat3 shape(body.shape / static_cast<float>(larger * larger));
  const glm::dvec3 back = glm::normalize(eye_of(place) - place.target_m);
  const glm::dvec3 from_middle_m = place.target_m - glm::dvec3(body.middle_m);
  const double a = glm::dot(back, shape * back);
  const double b = glm::dot(back, shape * from_middle_m);
  const double c = glm::dot(from_middle_m, shape * from_middle_m) - 1.0;
  const double square = b * b - a * c;
  if (!(square > 0.0)) return place;
  const double in_m = (-b - std::sqrt(square)) / a;
  const double out_m = (-b + std::sqrt(square)) / a;
  CameraPlace there = place;
  if (place.distance_m > in_m && place.distance_m < out_m) there.distance_m = out_m;
  return there;
}

Skin skin_of(const Body& body) {
  Skin skin;
  for (std::size_t row = 0; row <= kSkinRows; ++row) {
    const auto up_rad = static_cast<float>(kPi * (static_cast<double>(row) / kSkinRows - 0.5));
    for (std::size_t column = 0; column < kSkinColumns; ++column) {
      const auto bearing_rad = static_cast<float>(2.0 * kPi * static_cast<double>(column) / kSkinColumns);
      const glm::vec3 way(std::cos(up_rad) * std::cos(bearing_rad), std::sin(up_rad),
                          std::cos(up_rad) * std::sin(bearing_rad));
      skin.places_m.push_back(body.middle_m + way / std::sqrt(glm::dot(way, body.shape * way)));
    }
  }
  for (std::size_t row = 0; row < kSkinRows; ++row) {
    for (std::size_t column = 0; column < kSkinColumns; ++column) {
      const auto here = static_cast<std::uint32_t>(row * kSkinColumns + column);
      const auto beside = static_cast<std::uint32_t>(row * kSkinColumns + (column + 1) % kSkinColumns);
      constexpr auto kUp = static_cast<std::uint32_t>(kSkinColumns);
      const auto is_low = [&](std::uint32_t i) { return skin.places_m[i].y < body.low_m - kBelow_m; };
      if (is_low(here) && is_low(here + kUp)) continue;
      skin.triangles.insert(skin.triangles.end(), {here, beside, here + kUp, here + kUp, beside, beside + kUp});
    }
  }
  return skin;
}

}  // namespace yuragi::viewer::meshes
