#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/wind/turbulence/gust_variances.hpp"
#include "engine/wind/turbulence/turbulence_fit.hpp"
#include "engine/wind/turbulence/value_verdict.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::turbulence {

/// The turbulence that the readings of one source show, along the wind and across it: of the last readings the
/// differences between the mean of 2^s and that of as many before, each a part of the mean speed.
///
/// Each difference counts as much as the speed that it is a part of: in weak wind the parts are large and move little,
/// and a fit in which all count alike makes the gusts of the stronger wind behind it too strong.
///
/// A difference is at most the mean speed: a wind that rises out of a calm differs by many times the mean that
/// it rises from, which shows how fast that mean follows and not how strong the gusts are.
///
/// The mean of any number of last readings is the difference of two running sums. Each turn of their ring begins with
/// sums from 0 again, so that rounding does not grow however long this runs: means are exact to 1e-11 m/s (readings of
/// up to 60 m/s). Allocates at construction only. Thread-safe: no. Realtime-safe: yes. Cost of a reading: about 20 ns,
/// and 2 us once a turn.
class WindTurbulence {
 public:
  /// `prior`: along the wind; across it, the intensity is kAcrossPerAlong of it. Of kUnknown, the readings are judged.
  WindTurbulence(const Prior& prior, double memory_s, ReadingValue value = ReadingValue::kMean);

  /// Fit::take_as() of both.
  void take_as(ReadingValue value) noexcept {
    along_.take_as(value);
    across_.take_as(value);
  }
  /// So much time has gone by.
  void forget(double dt_s) noexcept;
  /// After a gap: what comes next is not compared with what was.
  void break_off() noexcept { history_size_ = 0; }
  /// The next reading, in a wind that blows toward the unit vector `ahead` with a mean of speed_m_s (above 0).
  void take(Vector wind, Vector ahead, double speed_m_s, bool has_across) noexcept;
  /// Fits both, for readings every interval_s, and judges what the readings are.
  void fit(double interval_s, double speed_m_s) noexcept;

  const Fit& along() const noexcept { return along_; }
  const Fit& across() const noexcept { return across_; }

  /// ValueVerdict::verdict(); kUnknown if the readings are not judged.
  ReadingValue verdict() const noexcept { return verdict_ ? verdict_->verdict() : ReadingValue::kUnknown; }

 private:
  void begin_turn() noexcept;

  Fit along_, across_;
  std::optional<ValueVerdict> verdict_;
  std::vector<Vector> sums_;      ///< a ring: of all readings up to each of the last ones
  std::size_t last_ = 0;          ///< the last reading's place in it
  std::size_t history_size_ = 0;  ///< readings without a gap up to the last
};

}  // namespace yuragi::wind::turbulence
