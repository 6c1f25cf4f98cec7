#include "engine/wind/blend/direction_keeper.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/units.hpp"
#include "engine/wind/turbulence/von_karman.hpp"

namespace yuragi::wind::blend {
namespace {

/// Below this speed a vane's direction has decreasing weight.
constexpr double kVaneCalm_m_s = 0.5;
/// After this many consecutive whole steps a vane counts as coarse; a fine one makes such steps by chance, one in 15 at
/// most, so that after other turns more of them are needed.
constexpr std::size_t kTurnsToDecide = 3;
constexpr std::size_t kTurnsToDecideIfFine = 12;
/// 22.5 degrees can be sent as 22 or 23.
constexpr double kRounding_deg = 0.6;
/// The longest smoothing: a coarse vane that has turned is followed within about 100 s, however low the turbulence.
constexpr double kMaxMemory_s = 100.0;

bool is_multiple(double turn_deg, double step_deg) noexcept {
  return std::abs(turn_deg) > 0.5 * step_deg && std::abs(std::remainder(turn_deg, step_deg)) <= kRounding_deg;
}

}  // namespace

Vector turned_toward(Vector unit, Vector other, double part) noexcept {
  if (part >= 1.0) return other;
  const double cross = unit.u_m_s * other.v_m_s - unit.v_m_s * other.u_m_s;
  const double dot = unit.u_m_s * other.u_m_s + unit.v_m_s * other.v_m_s;
  const double angle = part * std::atan2(cross, dot);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const Vector turned{c * unit.u_m_s - s * unit.v_m_s, s * unit.u_m_s + c * unit.v_m_s};
  return (1.0 / speed_of(turned)) * turned;
}

Vector DirectionKeeper::take(const Reading& reading, double dt_s, Vector otherwise, bool otherwise_is_live) noexcept {
  has_vane_ = reading.direction_deg.has_value();
  if (!has_vane_) {
    if (otherwise_is_live || !is_known_) toward_ = otherwise;
    return toward_;
  }
  const Vector measured = wind_from(1.0, *reading.direction_deg);
  note_step(*reading.direction_deg);
  const double wind = std::clamp(reading.speed_m_s / kVaneCalm_m_s, 0.0, 1.0);
  const double smoothed = is_known_ && memory_s_ > 0.0 ? -std::expm1(-dt_s / memory_s_) : 1.0;
  toward_ = turned_toward(is_known_ ? toward_ : otherwise, measured, wind * wind * smoothed);
  is_known_ = is_known_ || wind > 0.0;
  return toward_;
}

double DirectionKeeper::step_deg() const noexcept {
  if (given_step_deg_ > 0.0) return given_step_deg_;
  const std::size_t needed = was_fine_ ? kTurnsToDecideIfFine : kTurnsToDecide;
  return turns_of_8_ >= needed ? 45.0 : turns_of_16_ >= needed ? 22.5 : 0.0;
}

void DirectionKeeper::expect(double swing_rad, double time_scale_s, double interval_s) noexcept {
  if (!is_coarse()) {
    memory_s_ = 0.0;
    return;
  }
  // Quantisation noise is white if the fluctuation covers several steps, otherwise as slow as the gusts.
  const double step_rad = step_deg() * kRadPerDeg;
  const double steps = std::numbers::pi * swing_rad / step_rad;
  const double correlated_s = interval_s + time_scale_s * std::exp(-2.0 * steps * steps);
  // Von Karman's inertial range has the density of the steps at S(f) = sigma^2 T a (f T)^(-5/3) = step^2 / 12 * 2 dt.
  const double stairs = step_rad * step_rad / 12.0 * 2.0 * correlated_s;
  const double swing = turbulence::von_karman_inertial_factor() * swing_rad * swing_rad * time_scale_s;
  const double corner_hz = std::pow(swing / stairs, 0.6) / time_scale_s;
  memory_s_ = std::min(1.0 / (2.0 * std::numbers::pi * corner_hz), kMaxMemory_s);
}

/// A reading equal to the one before carries no information on the step.
void DirectionKeeper::note_step(double direction_deg) noexcept {
  const double turn_deg = direction_deg - last_deg_;
  const bool is_first = last_deg_ < 0.0;
  last_deg_ = direction_deg;
  if (is_first || std::abs(turn_deg) < 1e-9) return;
  turns_of_16_ = is_multiple(turn_deg, 22.5) ? turns_of_16_ + 1 : 0;
  turns_of_8_ = is_multiple(turn_deg, 45.0) ? turns_of_8_ + 1 : 0;
  if (turns_of_16_ == 0) was_fine_ = true;
  if (turns_of_16_ >= kTurnsToDecideIfFine) was_fine_ = false;
}

}  // namespace yuragi::wind::blend
