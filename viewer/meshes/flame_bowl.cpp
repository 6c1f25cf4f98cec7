#include "viewer/meshes/flame_bowl.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "viewer/meshes/bounds.hpp"

namespace yuragi::viewer::meshes {
namespace {

const glm::vec3 kIron(0.034F, 0.030F, 0.027F);
const glm::vec3 kRust(0.060F, 0.034F, 0.020F);
const glm::vec3 kAsh(0.026F, 0.022F, 0.020F);
const glm::vec3 kChar(0.011F, 0.009F, 0.008F);
const glm::vec3 kBark(0.045F, 0.030F, 0.020F);
const glm::vec3 kStone(0.150F, 0.140F, 0.128F);

constexpr int kLogs = 6;
constexpr int kStones = 15;

glm::vec3 on_ring(float turn_rad, float radius_m, float y_m) {
  return {radius_m * std::cos(turn_rad), y_m, radius_m * std::sin(turn_rad)};
}

}  // namespace

FlameBowl flame_bowl(const pose::SurfaceSkeleton& surface) {
  FlameBowl bowl;
  if (surface.rest_x_m.empty()) return bowl;
  const Bounds bounds = bounds_of(surface);
  const float foot_m = *std::min_element(surface.rest_y_m.begin(), surface.rest_y_m.end());
  const glm::vec3 middle((bounds.low_m.x + bounds.high_m.x) / 2.0F, 0.0F, (bounds.low_m.z + bounds.high_m.z) / 2.0F);
  // (A flat sheet is wider, so that its flames can lean; they burn from its middle.)
  const float reach_m = std::max(bounds.high_m.x - bounds.low_m.x, bounds.high_m.z - bounds.low_m.z);
  const float radius_m = 0.5F * (surface.is_closed ? 1.0F : 0.22F) * reach_m;

  SolidMesh& mesh = bowl.mesh;
  const auto at = [&](float turn_rad, float out_m, float y_m) { return middle + on_ring(turn_rad, out_m, y_m); };
  const auto up = [&](float y_m) { return middle + glm::vec3(0.0F, y_m, 0.0F); };

  // The bowl: its outside in three steps, its inside, and a rolled rim.
  const float rim_m = foot_m + 0.50F * radius_m;
  const float bottom_m = std::max(rim_m - 0.52F * radius_m, 0.16F * radius_m);
  const float deep_m = rim_m - bottom_m;
  constexpr std::array<std::array<float, 2>, 4> kOutline{
      {{0.45F, 0.0F}, {0.90F, 0.25F}, {1.15F, 0.62F}, {1.27F, 1.0F}}};
  for (std::size_t i = 0; i + 1 < kOutline.size(); ++i) {
    const auto [low_out, low_up] = kOutline[i];
    const auto [high_out, high_up] = kOutline[i + 1];
    mesh.add_tube(up(bottom_m + low_up * deep_m), up(bottom_m + high_up * deep_m), low_out * radius_m,
                  high_out * radius_m, i == 1 ? kRust : kIron);
  }
  mesh.add_tube(up(bottom_m), up(bottom_m + 0.001F), 0.0F, 0.45F * radius_m, kIron);
  mesh.add_tube(up(rim_m), up(rim_m - 0.001F), 1.27F * radius_m, 1.20F * radius_m, kRust);
  const float embers_m = bottom_m + 0.62F * deep_m;
  mesh.add_tube(up(rim_m), up(embers_m), 1.20F * radius_m, 1.08F * radius_m, kIron);
  mesh.add_tube(up(embers_m), up(embers_m + 0.10F * radius_m), 1.10F * radius_m, 0.0F, kAsh);
  bowl.embers_m = up(embers_m + 0.105F * radius_m);
  bowl.embers_radius_m = 0.95F * radius_m;

  // Three legs, spread outward, with feet.
  for (int leg = 0; leg < 3; ++leg) {
    const float turn_rad = static_cast<float>(2.0 * kPi) * (static_cast<float>(leg) + 0.2F) / 3.0F;
    const float top_m = bottom_m + 0.45F * deep_m;
    const float spread_m = (1.02F + 0.10F * std::min(top_m / radius_m, 3.0F)) * radius_m;
    mesh.add_tube(at(turn_rad, spread_m, 0.02F * radius_m), at(turn_rad, 0.98F * radius_m, top_m), 0.045F * radius_m,
                  0.055F * radius_m, kIron);
    mesh.add_ball(at(turn_rad, spread_m, 0.03F * radius_m), 0.085F * radius_m, kIron);
  }

  // Logs lean together over the embers; their lower ends are less charred.
  const math::RandomStream chance(0, math::stream_id("logs and stones"));
  std::uint64_t drawn = 0;
  const auto between = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(chance.uniform(drawn++));
  };
  for (int log = 0; log < kLogs; ++log) {
    const float turn_rad = static_cast<float>(2.0 * kPi) * (static_cast<float>(log) + between(-0.25F, 0.25F)) / kLogs;
    const glm::vec3 low = at(turn_rad, between(0.80F, 0.98F) * radius_m, embers_m + 0.10F * radius_m);
    const glm::vec3 high = at(turn_rad + between(2.3F, 3.7F), between(0.08F, 0.30F) * radius_m,
                              embers_m + between(0.34F, 0.60F) * radius_m);
    const float thick_m = between(0.085F, 0.125F) * radius_m;
    const glm::vec3 charred_from = low + 0.35F * (high - low);
    mesh.add_tube(low, charred_from, thick_m, 0.97F * thick_m, kBark);
    mesh.add_tube(charred_from, high, 0.97F * thick_m, 0.72F * thick_m, kChar);
    mesh.add_ball(high, 0.72F * thick_m, kChar);
    mesh.add_ball(low, thick_m, kBark);
  }

  // Stones in a ring on the ground, half sunk in.
  for (int stone = 0; stone < kStones; ++stone) {
    const float turn_rad =
        static_cast<float>(2.0 * kPi) * (static_cast<float>(stone) + between(-0.22F, 0.22F)) / kStones;
    const float size_m = between(0.17F, 0.29F) * radius_m;
    const glm::vec3 here = at(turn_rad, between(1.72F, 1.86F) * radius_m, -0.25F * size_m);
    const float grey = between(0.65F, 1.15F);
    mesh.add_ball(here, size_m, grey * kStone);
    mesh.add_ball(here + on_ring(between(0.0F, 6.28F), 0.45F * size_m, between(-0.2F, 0.1F) * size_m), 0.75F * size_m,
                  0.95F * grey * kStone);
  }
  return bowl;
}

}  // namespace yuragi::viewer::meshes
