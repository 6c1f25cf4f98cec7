#include "engine/noise/torus.hpp"

#include <bit>
#include <cmath>

#include "engine/noise/torus_read.hpp"

namespace yuragi::noise {
namespace {

constexpr double kPhasesPerPeriod = 4294967296.0;  // 2^32

/// A distance in units of the phase, without whole periods: at most half of 2^32 in either direction.
double phases_in(double distance_m, double period_m) noexcept {
  const double periods = distance_m / period_m;
  return (periods - std::nearbyint(periods)) * kPhasesPerPeriod;
}

/// An integer as a phase; negative ones count back from 2^32.
std::uint32_t wrapped(double whole) noexcept {
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(whole));
}

bool is_readable_size(std::size_t size) noexcept {
  return std::has_single_bit(size) && size >= 2 && size <= 65536;
}

unsigned log2_of(std::size_t size) noexcept {
  return static_cast<unsigned>(std::countr_zero(size));
}

}  // namespace

std::uint32_t torus_phase(double position_m, double period_m) noexcept {
  return wrapped(std::nearbyint(phases_in(position_m, period_m)));
}

void TorusTravel::add(double distance_m, double period_m) noexcept {
  const double step = phases_in(distance_m, period_m) + remainder_;
  const double whole = std::nearbyint(step);
  phase_ += wrapped(whole);
  remainder_ = step - whole;
}

bool is_readable(const Tile1& tile) noexcept {
  return is_readable_size(tile.size());
}

bool is_readable(const Tile2& tile) noexcept {
  return is_readable_size(tile.size) && tile.values.size() == tile.size * tile.size;
}

float read_noise(const Tile1& tile, std::uint32_t at) noexcept {
  const TorusCell cell = torus_cell(at, log2_of(tile.size()));
  return between(tile.values[cell.first], tile.values[cell.second], cell.fraction);
}

float read_noise(const Tile2& tile, TorusPhase at) noexcept {
  return read_bilinear(tile.values.data(), log2_of(tile.size), at.x, at.z);
}

}  // namespace yuragi::noise
