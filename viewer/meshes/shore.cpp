#include "viewer/meshes/shore.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr auto kTurn_rad = static_cast<float>(2.0 * kPi);
constexpr float kSquareness = 2.4F;  // exponent of the outline: 2 is an ellipse, more reaches farther into the corners
constexpr float kBank_m = 0.42F;
constexpr float kFullHalf_m = 3.5F;
constexpr float kShelf = 0.10F;  // slope of the bed at the shore
constexpr float kDeepest_m = 0.8F;
constexpr float kDropOff_m = 1.6F;  // distance at which the bed has half of its depth
constexpr float kCalmed = 0.15F;    // a wave's height at the shore, as a share
constexpr float kCalming_m = 1.2F;  // distance from which waves have their full height
constexpr float kUnderTurf_m = 0.012F;
constexpr std::size_t kBearings = 224;
constexpr std::array kEdges{-0.25F, 0.0F, 0.12F, 0.28F, 0.48F, 0.72F, 1.0F, 1.35F};

float smooth_step(float t) {
  const float x = std::clamp(t, 0.0F, 1.0F);
  return x * x * (3.0F - 2.0F * x);
}

/// The extent of the outline's square at a bearing, relative to an ellipse of the same sides.
glm::vec2 on_square(float bearing_rad) {
  const glm::vec2 way(std::cos(bearing_rad), std::sin(bearing_rad));
  const float norm = std::pow(std::abs(way.x), kSquareness) + std::pow(std::abs(way.y), kSquareness);
  return way * std::pow(norm, -1.0F / kSquareness);
}

}  // namespace

Shore::Shore(const pose::SurfaceSkeleton& surface) {
  if (surface.columns < 2 || surface.rows < 2 || surface.is_closed) return;
  const auto place = [&](std::size_t i) { return glm::vec2(surface.rest_x_m[i], surface.rest_z_m[i]); };
  const std::size_t last_row = surface.columns * (surface.rows - 1);
  const glm::vec2 row = place(surface.columns - 1) - place(0);
  const glm::vec2 column = place(last_row) - place(0);
  const glm::vec2 sides_m(glm::length(row), glm::length(column));
  if (!(std::min(sides_m.x, sides_m.y) > 0.01F)) return;
  along_ = row / sides_m.x;
  across_ = column / sides_m.y;
  half_m_ = 0.5F * sides_m;
  middle_m_ = 0.5F * (place(0) + place(last_row + surface.columns - 1));
  scale_ = std::clamp(std::min(half_m_.x, half_m_.y) / kFullHalf_m, 0.1F, 1.0F);
  turn_rad_ = 1.7F * half_m_.x + 2.9F * half_m_.y;
}

float Shore::bearing_of(const glm::vec2& off_m) const {
  const glm::vec2 part = glm::vec2(glm::dot(off_m, along_), glm::dot(off_m, across_)) / half_m_;
  return std::atan2(part.y, part.x);
}

float Shore::reach(float bearing_rad) const {
  const float b = bearing_rad;
  return 0.84F + 0.055F * std::sin(2.0F * b + turn_rad_) + 0.045F * std::sin(3.0F * b + 2.1F * turn_rad_) +
         0.028F * std::sin(5.0F * b + 3.3F * turn_rad_) + 0.012F * std::sin(11.0F * b + 0.7F * turn_rad_) +
         0.006F * std::sin(23.0F * b + 1.9F * turn_rad_);
}

float Shore::bank_at(float bearing_rad) const {
  return kBank_m * scale_ *
         (1.0F + 0.30F * std::sin(4.0F * bearing_rad + turn_rad_) +
          0.20F * std::sin(7.0F * bearing_rad + 2.3F * turn_rad_));
}

glm::vec2 Shore::at(float bearing_rad, float out_m) const {
  const glm::vec2 part = on_square(bearing_rad) * half_m_;
  const float unit_m = glm::length(part);
  return middle_m_ + (part.x * along_ + part.y * across_) * (reach(bearing_rad) + out_m / unit_m);
}

float Shore::out_m(const glm::vec2& at_m) const {
  const glm::vec2 off_m = at_m - middle_m_;
  const float bearing_rad = bearing_of(off_m);
  return glm::length(off_m) - reach(bearing_rad) * glm::length(on_square(bearing_rad) * half_m_);
}

float Shore::bank_m(const glm::vec2& at_m) const {
  return bank_at(bearing_of(at_m - middle_m_));
}

float Shore::bed_m(const glm::vec2& at_m) const {
  const float out = out_m(at_m);
  if (out > 0.0F) {
    const float edge = out / bank_m(at_m);
    return edge < 1.0F ? -kSunk_m * (1.0F - smooth_step(0.5F + 0.5F * edge)) * 2.0F : -kUnderTurf_m;
  }
  const float in_m = -out;
  const float drop = in_m * in_m / (in_m * in_m + kDropOff_m * kDropOff_m * scale_ * scale_);
  return -kSunk_m - kShelf * std::min(in_m, scale_) - kDeepest_m * scale_ * drop;
}

float Shore::wave_share(const glm::vec2& at_m) const {
  return kCalmed + (1.0F - kCalmed) * smooth_step(-out_m(at_m) / (kCalming_m * scale_));
}

BankMesh bank_of(const Shore& shore) {
  BankMesh mesh;
  if (!shore.is_pond()) return mesh;
  constexpr std::size_t rings = kEdges.size();
  for (std::size_t i = 0; i < kBearings; ++i) {
    const float bearing_rad = kTurn_rad * static_cast<float>(i) / static_cast<float>(kBearings);
    const glm::vec2 line_m = shore.at(bearing_rad, 0.0F);
    const float bank_m = shore.bank_m(line_m);
    const glm::vec2 out = glm::normalize(line_m - shore.middle_m());
    for (const float edge : kEdges) {
      const glm::vec2 at_m = shore.at(bearing_rad, edge * bank_m);
      const float slope = (shore.bed_m(at_m + 0.02F * out) - shore.bed_m(at_m - 0.02F * out)) / 0.04F;
      mesh.vertices.push_back({.place_m = {at_m.x, shore.bed_m(at_m), at_m.y},
                               .normal = glm::normalize(glm::vec3(-slope * out.x, 1.0F, -slope * out.y)),
                               .edge = edge});
    }
  }
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({.place_m = {shore.middle_m().x, -Shore::kSunk_m, shore.middle_m().y},
                           .normal = {0.0F, 1.0F, 0.0F},
                           .edge = -1.0F});
  for (std::size_t i = 0; i < kBearings; ++i) {
    const auto here = static_cast<std::uint32_t>(i * rings);
    const auto next = static_cast<std::uint32_t>((i + 1) % kBearings * rings);
    mesh.hole.insert(mesh.hole.end(), {middle, here, next});
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const std::array quad{here + ring, here + ring + 1, next + ring, next + ring, here + ring + 1, next + ring + 1};
      mesh.bank.insert(mesh.bank.end(), quad.begin(), quad.end());
    }
  }
  mesh.hole.insert(mesh.hole.end(), mesh.bank.begin(), mesh.bank.end());
  return mesh;
}

std::vector<Reed> reeds_of(const Shore& shore) {
  constexpr std::size_t kTufts = 130;
  constexpr std::size_t kReeds = 15;  // a tuft
  std::vector<Reed> reeds;
  if (!shore.is_pond()) return reeds;
  const math::RandomStream chance(0, math::stream_id("viewer reeds"));
  const float scale = shore.scale();
  const auto spread = [](double value) { return static_cast<float>(2.0 * value - 1.0); };
  for (std::size_t tuft = 0; tuft < kTufts; ++tuft) {
    const auto [first, second] = chance.uniform_pair(1000 * tuft);
    const float bearing_rad = kTurn_rad * (static_cast<float>(tuft) + static_cast<float>(first)) / kTufts;
    // Belts of reeds, and free shore between them.
    const float belt = std::sin(2.0F * bearing_rad + 1.1F) + 0.8F * std::sin(5.0F * bearing_rad + 0.4F) + 0.25F;
    if (belt + 0.5F * spread(second) < 0.0F) continue;
    const float lush = std::clamp(0.55F + 0.35F * belt, 0.4F, 1.0F);
    const glm::vec2 foot_m = shore.at(bearing_rad, scale * (0.16F * spread(second) - 0.05F));
    for (std::size_t i = 1; i <= kReeds; ++i) {
      const auto [east, south] = chance.uniform_pair(1000 * tuft + 3 * i);
      const auto [tall, look] = chance.uniform_pair(1000 * tuft + 3 * i + 1);
      const auto [way, lean] = chance.uniform_pair(1000 * tuft + 3 * i + 2);
      const glm::vec2 at_m = foot_m + 0.13F * scale * glm::vec2(spread(east), spread(south));
      reeds.push_back({.root_m = {at_m.x, shore.bed_m(at_m), at_m.y},
                       .length_m = scale * lush * (0.45F + 0.65F * static_cast<float>(tall)),
                       .heading_rad = kTurn_rad * static_cast<float>(way),
                       .lean_rad = 0.06F + 0.42F * static_cast<float>(lean * lean),
                       .width_m = scale * (0.008F + 0.007F * static_cast<float>(look)),
                       .chance = static_cast<float>(look)});
    }
  }
  return reeds;
}

WaveSlopes::WaveSlopes(const pose::SurfaceSkeleton& surface, const Shore& shore)
    : columns_(surface.columns), rows_(surface.rows), along_per_m_(0.0F), across_per_m_(0.0F) {
  const std::size_t count = columns_ * rows_;
  heights_m_.assign(count, 0.0F);
  slopes_.assign(4 * count, 0.0F);
  if (!shore.is_pond()) return;
  along_per_m_ = shore.along() * (0.25F * static_cast<float>(columns_ - 1) / shore.half_m().x);
  across_per_m_ = shore.across() * (0.25F * static_cast<float>(rows_ - 1) / shore.half_m().y);
  for (std::size_t i = 0; i < count; ++i) {
    share_.push_back(shore.wave_share({surface.rest_x_m[i], surface.rest_z_m[i]}));
    rest_y_m_.push_back(surface.rest_y_m[i]);
  }
}

void WaveSlopes::move_to(const float* y_m) {
  if (share_.empty()) return;
  for (std::size_t i = 0; i < heights_m_.size(); ++i) {
    heights_m_[i] = rest_y_m_[i] - Shore::kSunk_m + share_[i] * (y_m[i] - rest_y_m_[i]);
  }
  for (std::size_t row = 0; row < rows_; ++row) {
    const std::size_t up = row > 0 ? columns_ : 0;
    const std::size_t down = row + 1 < rows_ ? columns_ : 0;
    for (std::size_t column = 0; column < columns_; ++column) {
      const std::size_t i = row * columns_ + column;
      const std::size_t left = column > 0 ? 1 : 0;
      const std::size_t right = column + 1 < columns_ ? 1 : 0;
      const glm::vec2 slope = along_per_m_ * (heights_m_[i + right] - heights_m_[i - left]) +
                              across_per_m_ * (heights_m_[i + down] - heights_m_[i - up]);
      slopes_[4 * i] = slope.x;
      slopes_[4 * i + 1] = slope.y;
      slopes_[4 * i + 2] = glm::dot(slope, slope);
    }
  }
}

}  // namespace yuragi::viewer::meshes
