#include "viewer/looks/water_memory.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace yuragi::viewer::looks {
namespace {

/// Waves of 0.4 to 1.2 m travel as groups at 0.4 to 0.7 m/s, and the wind drags the surface at 3 % of its speed.
constexpr float kCarriedPart = 0.06F;
constexpr float kMaxCarried_m_s = 1.0F;

/// The part of the way to a steady state that is covered after `passed_s`.
float part_gone(double passed_s, float time_constant_s) {
  return static_cast<float>(-std::expm1(-passed_s / static_cast<double>(time_constant_s)));
}

}  // namespace

WaterMemory::WaterMemory(std::size_t columns, std::size_t rows, const glm::vec2& to_next_m,
                         const glm::vec2& to_next_row_m)
    : columns_(columns),
      rows_(rows),
      to_cells_(glm::inverse(glm::mat2(to_next_m, to_next_row_m))),
      cells_(2 * columns * rows, 0.0F),
      carried_(2 * columns * rows, 0.0F) {}

void WaterMemory::advance_to(double time_s, const Forces& forces) {
  const std::size_t count = columns_ * rows_;
  if (count == 0 || forces.gusts.size() != count || forces.breaking.size() != count) return;
  if (!is_settled_ || !(time_s >= time_s_)) {
    settle(forces);
    time_s_ = time_s;
    return;
  }
  const double passed_s = time_s - time_s_;
  time_s_ = time_s;
  if (passed_s == 0.0) return;

  const float calmed = part_gone(passed_s, kDecay_s);
  shaping_wind_m_s_ += calmed * (forces.wind_m_s - shaping_wind_m_s_);
  const float speed_m_s = glm::length(shaping_wind_m_s_);
  const glm::vec2 way_m = speed_m_s > 0.0F ? shaping_wind_m_s_ * (std::min(kCarriedPart * speed_m_s, kMaxCarried_m_s) *
                                                                  static_cast<float>(passed_s) / speed_m_s)
                                           : glm::vec2(0.0F);
  drifted_m_ += way_m;
  carry(to_cells_ * way_m);

  const float woken = part_gone(passed_s, kRise_s);
  const float broken = part_gone(passed_s, kBreaking_s);
  for (std::size_t i = 0; i < count; ++i) {
    const float gust = forces.gusts[i] - cells_[2 * i];
    cells_[2 * i] += (gust > 0.0F ? woken : calmed) * gust;
    const float foam = forces.breaking[i] - cells_[2 * i + 1];
    cells_[2 * i + 1] += (foam > 0.0F ? broken : calmed) * foam;
  }
}

void WaterMemory::settle(const Forces& forces) {
  for (std::size_t i = 0; i < forces.gusts.size(); ++i) {
    cells_[2 * i] = forces.gusts[i];
    cells_[2 * i + 1] = forces.breaking[i];
  }
  shaping_wind_m_s_ = forces.wind_m_s;
  drifted_m_ = glm::vec2(0.0F);
  is_settled_ = true;
}

/// Semi-Lagrangian (J. Stam 1999, "Stable fluids"): each cell takes the value upwind of it. At the upwind shore the
/// edge value continues.
void WaterMemory::carry(const glm::vec2& by_cells) {
  const glm::vec2 last(static_cast<float>(columns_ - 1), static_cast<float>(rows_ - 1));
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      const glm::vec2 here(static_cast<float>(column), static_cast<float>(row));
      const glm::vec2 from = glm::clamp(here - by_cells, glm::vec2(0.0F), last);
      const glm::vec2 low = glm::min(glm::floor(from), glm::max(last - 1.0F, 0.0F));
      const glm::vec2 part = from - low;
      const std::size_t at = static_cast<std::size_t>(low.y) * columns_ + static_cast<std::size_t>(low.x);
      const std::size_t right = columns_ > 1 ? 1 : 0;
      const std::size_t down = rows_ > 1 ? columns_ : 0;
      for (std::size_t k = 0; k < 2; ++k) {
        const float above = glm::mix(cells_[2 * at + k], cells_[2 * (at + right) + k], part.x);
        const float below = glm::mix(cells_[2 * (at + down) + k], cells_[2 * (at + down + right) + k], part.x);
        carried_[2 * (row * columns_ + column) + k] = glm::mix(above, below, part.y);
      }
    }
  }
  cells_.swap(carried_);
}

}  // namespace yuragi::viewer::looks
