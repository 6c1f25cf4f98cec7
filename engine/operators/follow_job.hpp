#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/simd_row.hpp"

namespace yuragi {

/// Inertia for many values at once: each follows its target as CriticallyDamped does (engine/math), whose closed form
/// this steps in floats: q'' + 2 w q' + w^2 (q - target) = 0.
///
/// However the targets jump, values and rates are continuous; a target whose magnitude never exceeds m moves its value
/// by at most 2 m w / e in a second, and never beyond m (the impulse response w^2 t exp(-w t) is positive, integrates
/// to 1, and its derivative's magnitude to 2 w / e). That holds for vectors spread over several values as well. What
/// has come closer to 0 than 1e-9 comes to rest there. Units: the value's own, and per second. Owns nothing; `value`
/// and `rate_per_s` are the state, the caller's from step to step, 0 at the start. Thread-safe: jobs with different
/// state, yes. Realtime-safe: yes. Every SIMD row computes the same bits. Cost:
/// about 0.3 ns a value (x86-64-v3).
struct FollowJob {
  std::span<const float> target;
  double omega_rad_s = 8.0;  ///< larger follows faster: after 4.75 / omega 95 % of a step is done
  double dt_s = 0.0;
  std::optional<SimdRow> row = std::nullopt;  ///< unset: the widest that this machine can run

  std::span<float> value;
  std::span<float> rate_per_s;

  enum class Problem : std::uint8_t {
    kNone,
    kOmega,            ///< not a finite number above 0
    kStepNotPositive,  ///< dt_s is not a finite number above 0
    kSizesDiffer,
    kRowNotRunnable,
  };
  [[nodiscard]] Problem validate() const noexcept;

  /// Does the work, if validate() has nothing against it; returns what validate() says.
  Problem run() const noexcept;
};

}  // namespace yuragi
