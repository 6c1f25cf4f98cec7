#include "viewer/light/fire_light.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace yuragi::viewer::light {
namespace {

constexpr double kMinHeat = 0.01;
/// After a jump in time the light is as after the first picture; also if no time has passed: that is another stream, or
/// a test.
constexpr double kJump_s = 2.0;
constexpr float kFollowing = 0.38F;

}  // namespace

Fires nearest_fires(std::span<const Fire> fires, const glm::vec3& eye_m) {
  // Sorted by insertion; there are few.
  std::array<const Fire*, Fires::kMost> nearest{};
  std::size_t count = 0;
  const auto is_nearer = [&](const Fire& a, const Fire& b) {
    return glm::distance(a.place_m, eye_m) < glm::distance(b.place_m, eye_m);
  };
  for (const Fire& fire : fires) {
    std::size_t at = count;
    while (at > 0 && is_nearer(fire, *nearest[at - 1])) --at;
    if (at == Fires::kMost) continue;
    count = std::min(count + 1, Fires::kMost);
    for (std::size_t i = count; --i > at;) nearest[i] = nearest[i - 1];
    nearest[at] = &fire;
  }
  Fires block;
  block.count.x = static_cast<float>(count);
  for (std::size_t i = 0; i < count; ++i) {
    block.place_radius[i] = glm::vec4(nearest[i]->place_m, nearest[i]->radius_m);
    block.light[i] = glm::vec4(nearest[i]->light, 0.0F);
  }
  return block;
}

float flame_brightness(float exposure) {
  return std::pow(std::max(exposure, 1e-3F), kFollowing - 1.0F);
}

float FireFlicker::follow(float heat, double time_s) {
  const double wanted = std::log(std::max(static_cast<double>(heat), kMinHeat));
  const double passed_s = std::abs(time_s - time_s_);
  if (!has_begun_ || passed_s == 0.0 || passed_s > kJump_s) {
    log_ = wanted;
  } else {
    const double reach = kFastest_per_s * passed_s;
    log_ += std::clamp(wanted - log_, -reach, reach);
  }
  has_begun_ = true;
  time_s_ = time_s;
  const double shown = std::exp(log_);
  return shown < 1.01 * kMinHeat ? 0.0F : static_cast<float>(shown);
}

}  // namespace yuragi::viewer::light
