#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/base/state_pass.hpp"
#include "engine/wind/turbulence/gust_variances.hpp"
#include "engine/wind/turbulence/turbulence_fit.hpp"
#include "engine/wind/turbulence/value_verdict.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::turbulence {

/// The turbulence in the readings of one source, along the wind and across it: the differences between the mean of the
/// last 2^s readings and that of the 2^s before, relative to the mean speed.
///
/// Each difference is weighted by that speed: in weak wind the relative differences are large but have little effect,
/// and with equal weights the gusts of a stronger wind after it would be too strong.
///
/// A difference is at most the mean speed: a wind that rises out of a calm differs by many times the previous mean,
/// which depends on how fast that mean follows and not on the gusts.
///
/// The mean of any number of last readings is the difference of two running sums. Each turn of their ring starts with
/// sums of 0 again, so that rounding does not grow over time: means are exact to 1e-11 m/s (readings of up to 60 m/s).
/// Allocates at construction only. Thread-safe: no. Realtime-safe: yes. Cost of a reading: about 20 ns, and 2 us once a
/// turn.
class WindTurbulence {
 public:
  /// `prior`: along the wind; across it, the intensity is kAcrossPerAlong of it. Of kUnknown, the readings are judged.
  WindTurbulence(const Prior& prior, double memory_s, ReadingValue value = ReadingValue::kMean);

  /// Fit::take_as() of both.
  void take_as(ReadingValue value) noexcept {
    along_.take_as(value);
    across_.take_as(value);
  }
  /// Fades the memory by dt_s.
  void forget(double dt_s) noexcept;
  /// Call after a gap: later readings are not compared with earlier ones.
  void break_off() noexcept { history_size_ = 0; }
  /// The next reading, in a wind that blows toward the unit vector `ahead` with a mean of speed_m_s (above 0).
  void take(Vector wind, Vector ahead, double speed_m_s, bool has_across) noexcept;
  /// Fits both, for readings every interval_s, and judges the value of the readings.
  void fit(double interval_s, double speed_m_s) noexcept;

  const Fit& along() const noexcept { return along_; }
  const Fit& across() const noexcept { return across_; }

  /// ValueVerdict::verdict(); kUnknown if the readings are not judged.
  ReadingValue verdict() const noexcept { return verdict_ ? verdict_->verdict() : ReadingValue::kUnknown; }

  void list_state(StatePass& pass) {
    pass(along_, across_, sums_);
    if (verdict_) pass(*verdict_);
    pass.index(last_, sums_.size());
    pass.index(history_size_, sums_.size() / 2 + 1);
  }

 private:
  void begin_turn() noexcept;

  Fit along_, across_;
  std::optional<ValueVerdict> verdict_;
  std::vector<Vector> sums_;      ///< a ring: of all readings up to each of the last ones
  std::size_t last_ = 0;          ///< the last reading's place in it
  std::size_t history_size_ = 0;  ///< readings without a gap up to the last
};

}  // namespace yuragi::wind::turbulence
