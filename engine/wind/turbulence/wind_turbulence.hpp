#pragma once

#include <cstddef>
#include <vector>

#include "engine/wind/turbulence/gust_variances.hpp"
#include "engine/wind/turbulence/turbulence_fit.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::turbulence {

/// The turbulence that the readings of one source show, along the wind and across it: of the last readings the
/// differences between the mean of 2^s and that of as many before, each a part of the mean speed.
///
/// Each difference counts as much as the speed that it is a part of: in weak wind the parts are large and move little,
/// and a fit in which all count alike makes the gusts of the stronger wind behind it too strong.
///
/// A difference is at most the mean speed: a wind that rises out of a calm differs by many times the mean that
/// it rises from, which shows how fast that mean follows and not how strong the gusts are. Allocates at construction
/// only. Thread-safe: no. Realtime-safe: yes.
class WindTurbulence {
 public:
  /// `prior`: along the wind; across it, the intensity is kAcrossPerAlong of it.
  WindTurbulence(const TurbulencePrior& prior, double memory_s);

  /// So much time has gone by.
  void forget(double dt_s) noexcept;
  /// After a gap: what comes next is not compared with what was.
  void break_off() noexcept { history_size_ = 0; }
  /// The next reading, in a wind that blows toward the unit vector `ahead` with a mean of speed_m_s (above 0).
  void take(WindVector wind, WindVector ahead, double speed_m_s, bool has_across) noexcept;
  /// Fits both, for readings that are means over interval_s.
  void fit(double interval_s, double speed_m_s) noexcept;

  const TurbulenceFit& along() const noexcept { return along_; }
  const TurbulenceFit& across() const noexcept { return across_; }

 private:
  TurbulenceFit along_, across_;
  std::vector<WindVector> history_;  ///< a ring of the last readings
  std::size_t history_size_ = 0;     ///< those without a gap up to the last
  std::size_t next_ = 0;
};

}  // namespace yuragi::wind::turbulence
