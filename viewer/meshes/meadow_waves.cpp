#include "viewer/meshes/meadow_waves.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

// Waves of the tile: minimum and maximum number of periods along a side; those with more are weaker.
constexpr double kMinPeriods = 1.5;
constexpr double kMaxPeriods = 9.0;
constexpr double kSteepness = 1.4;
constexpr float kMaxGust = 2.2F;  // standard deviations

/// Grass bends under the wind's pressure, less and less the farther it is down.
constexpr float kLyingDown_rad = 0.85F;
constexpr float kHalfDown_m_s = 8.0F;

constexpr float kFullWaves_m_s = 1.0F;  // in less wind waves are smaller; in still air there are none

/// After a slow frame the waves still travel less than the tile.
constexpr double kMaxStep_s = 1.0;

}  // namespace

MeadowWaves::MeadowWaves() : gusts_(kNodes * kNodes, 0.0F) {
  const math::RandomStream chance(0, math::stream_id("viewer meadow waves"));
  constexpr int most = static_cast<int>(kMaxPeriods);
  std::uint64_t draw = 0;
  for (int along = 0; along <= most; ++along) {
    for (int across = -most; across <= most; ++across) {
      if (along == 0 && across <= 0) continue;  // the same wave as the opposite one
      const double periods = std::hypot(along, across);
      const double phase_rad = 2.0 * kPi * chance.uniform(draw++);
      if (periods < kMinPeriods || periods > kMaxPeriods) continue;
      const double height = std::pow(periods, -kSteepness);
      for (std::size_t row = 0; row < kNodes; ++row) {
        for (std::size_t column = 0; column < kNodes; ++column) {
          const double turns =
              (along * static_cast<double>(column) + across * static_cast<double>(row)) / static_cast<double>(kNodes);
          gusts_[row * kNodes + column] += static_cast<float>(height * std::cos(2.0 * kPi * turns + phase_rad));
        }
      }
    }
  }
  double squares = 0.0;
  for (const float gust : gusts_) squares += static_cast<double>(gust) * static_cast<double>(gust);
  const auto deviation = static_cast<float>(std::sqrt(squares / static_cast<double>(gusts_.size())));
  for (float& gust : gusts_) gust = std::clamp(gust / deviation, -kMaxGust, kMaxGust);
}

void MeadowWaves::advance_to(double time_s, const glm::vec2& wind_m_s) {
  const double passed_s = time_s - time_s_;
  time_s_ = time_s;
  if (!is_settled_ || !(passed_s >= 0.0)) {
    is_settled_ = true;
    wind_m_s_ = wind_m_s;
    drifted_m_ = glm::vec2(0.0F);
    return;
  }
  const auto step_s = static_cast<float>(std::min(passed_s, kMaxStep_s));
  wind_m_s_ = glm::mix(wind_m_s_, wind_m_s, -std::expm1(-step_s / kSettling_s));
  drifted_m_ = glm::mod(drifted_m_ + wind_m_s_ * step_s, kSide_m);
}

glm::vec2 MeadowWaves::mean_bend() const {
  const float speed_m_s = glm::length(wind_m_s_);
  const float square = speed_m_s * speed_m_s;
  return speed_m_s > 0.0F ? wind_m_s_ * (kLyingDown_rad * speed_m_s / (square + kHalfDown_m_s * kHalfDown_m_s))
                          : glm::vec2(0.0F);
}

void MeadowWaves::fill(const glm::vec2& mean, std::span<glm::vec2> bends) const {
  const float square = glm::dot(wind_m_s_, wind_m_s_);
  constexpr float half = kHalfDown_m_s * kHalfDown_m_s;
  const float turbulence = kTurbulence * std::min(glm::length(wind_m_s_) / kFullWaves_m_s, 1.0F);
  for (std::size_t i = 0; i < std::min(bends.size(), gusts_.size()); ++i) {
    const float faster = 1.0F + turbulence * gusts_[i];
    const float pressure = faster * faster;
    bends[i] = mean * (pressure * (square + half) / (pressure * square + half));
  }
}

}  // namespace yuragi::viewer::meshes
