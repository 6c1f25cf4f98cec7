#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"

namespace yuragi::operators {

/// One tick of a damped oscillator (engine/METHOD.md M17): four constants, the same for all oscillators of one rate.
struct OscillatorStep {
  double q_from_e = 0.0;  ///< with e = q - g: q <- g + q_from_e e + q_from_v v
  double q_from_v = 0.0;
  double v_from_e = 0.0;  ///< v <- v_from_e e + v_from_v v
  double v_from_v = 0.0;

  /// The exact solution of q'' + 2 zeta w q' + w^2 q = w^2 g for a g that is constant during dt_s, w = 2 pi
  /// natural_hz: unconditionally stable. natural_hz above 0, damping_ratio zeta in [0, 1), dt_s above 0.
  static OscillatorStep exact(double natural_hz, double damping_ratio, double dt_s) noexcept;

  /// If g changes by at most d a tick, q changes by at most this times d: the integral of the impulse response's
  /// magnitude, coth(pi zeta / (2 sqrt(1 - zeta^2))). zeta above 0.
  static double largest_gain(double damping_ratio) noexcept;

  /// If |g| is at most 1, q moves at most this much per second: the total variation of the impulse response, twice its
  /// first peak over 1 - exp(-pi zeta / sqrt(1 - zeta^2)), since each peak is that much lower than the one before.
  static double largest_rate_per_s(double natural_hz, double damping_ratio) noexcept;
};

/// The same for oscillators with their own rates: an element for each.
struct OscillatorSteps {
  explicit OscillatorSteps(std::size_t count = 0)
      : q_from_e(count), q_from_v(count), v_from_e(count), v_from_v(count) {}

  /// Sets the (finite) step of element i. Thread-safe: on different elements, yes. Realtime-safe: yes.
  void set(std::size_t i, const OscillatorStep& step) noexcept;

  /// Sets all steps by OscillatorStep::exact, each at its own rate (one element each), for ticks of dt_s. The rates
  /// never change: this recomputes only if dt_s has changed. Thread-safe: no. Realtime-safe: yes.
  void set_pace(std::span<const float> natural_hz, double damping_ratio, double dt_s) noexcept;

  std::vector<float> q_from_e, q_from_v, v_from_e, v_from_v;

 private:
  double dt_s_ = 0.0;  ///< of set_pace()
};

/// Positions and speeds of many oscillators, two axes each; initially at rest.
struct Oscillators {
  explicit Oscillators(std::size_t count = 0)
      : value_east(count), rate_east(count), value_south(count), rate_south(count) {}

  void list_state(StatePass& pass) { pass(value_east, rate_east, value_south, rate_south); }

  std::vector<float> value_east, rate_east, value_south, rate_south;
};

/// The hybrid projection: each element is a damped oscillator in two axes that the noise's angle drives, so that it
/// overshoots, continues to sway after a gust, and follows fast noise less (the paper's second future work;
/// engine/METHOD.md M17).
///
/// `east` and `south` hold the noise's angle g on entry, and g + blend (q - g) afterwards; with blend 0 they keep every
/// bit, and the oscillators rest. Values below 1e-9 are set to 0, so that calm ends in the rest pose. Radians (or any
/// unit). Both spans have the same size, within the oscillators. Owns nothing. Thread-safe: jobs on different elements,
/// yes. Realtime-safe: yes. Every SIMD row computes the same bits. Cost: about 0.5 ns an element (x86-64-v3).
struct OscillatorJob {
  OscillatorStep step = {};                   ///< for all, if they have the same rate
  const OscillatorSteps* steps = nullptr;     ///< one for each, instead of `step`
  double blend = 1.0;                         ///< h: 0, the noise alone, to 1, the oscillator alone
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  Oscillators* oscillators = nullptr;
  std::size_t first = 0;  ///< index of the oscillator (and of its element of `steps`) of the first element of `east`
  std::span<float> east = {};
  std::span<float> south = {};

  enum class Problem : std::uint8_t {
    kNone,
    kNoOscillators,
    kStepNotFinite,  ///< `step`; those of `steps` are not looked at
    kBlend,          ///< not a number from 0 to 1
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Runs the job unless validate() finds a problem; returns the result of validate().
  Problem run() const noexcept;
};

}  // namespace yuragi::operators
