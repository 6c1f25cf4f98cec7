#include "drivers/decode/usb/cup_counter.hpp"

#include <algorithm>
#include <cmath>

#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::decode::usb {
namespace {

/// How much earlier than measured a value can have been read: the delays by USB and the scheduler vary.
constexpr double kReadJitter_s = 0.1;

/// The most pulses that any wind makes in this time; one more falls on a boundary.
double most_pulses(const CupCalibration& cup, double elapsed_s) {
  const double fastest_m_s = wind::kMaxPlausibleSpeed_m_s - std::min(cup.offset_m_s, 0.0);
  return fastest_m_s * (elapsed_s + kReadJitter_s) / cup.metres_per_pulse + 1.0;
}

}  // namespace

std::optional<Result<double, Refusal>> advance_cup(CupState& state, const CupCalibration& cup, std::uint32_t count,
                                                   double elapsed_s) noexcept {
  if (!state.last_count) {
    state = {.last_count = count};
    return std::nullopt;
  }

  // Modulo 2^32 a wrap is a small step, and a step back a very large one.
  const std::uint32_t step = count - *state.last_count;
  const bool is_time = std::isfinite(elapsed_s) && elapsed_s >= 0.0;
  if (!is_time || step > most_pulses(cup, elapsed_s)) {
    state = {.last_count = count};
    return Result<double, Refusal>(Refusal::kImplausible);
  }
  state.last_count = count;
  state.pulses += step;
  state.window_s += elapsed_s;

  const bool is_enough = state.pulses >= std::max(cup.enough_pulses, 1U) && state.window_s >= cup.shortest_window_s;
  if (!is_enough && state.window_s < cup.longest_window_s) return std::nullopt;
  const double pulses_per_s = static_cast<double>(state.pulses) / state.window_s;
  const double speed_m_s =
      state.pulses == 0 ? 0.0 : std::max(cup.metres_per_pulse * pulses_per_s + cup.offset_m_s, 0.0);
  state = {.last_count = count};
  if (!(speed_m_s <= wind::kMaxPlausibleSpeed_m_s)) return Result<double, Refusal>(Refusal::kImplausible);
  return Result<double, Refusal>(speed_m_s);
}

}  // namespace yuragi::drivers::decode::usb
