#pragma once

#include <vector>

#include "engine/math/critically_damped.hpp"
#include "engine/wind/source_record.hpp"
#include "engine/wind/synthetic_wind.hpp"
#include "engine/wind/wind_estimator.hpp"

namespace yuragi {

struct FollowingEstimatorSettings {
  SyntheticWindSettings default_wind;  ///< what blows where no sensor speaks
  double handover_s = 3.0;             ///< about how long the way from one source to another takes
  double stale_intervals = 5.0;        ///< silent for this many of its own intervals: stale
};

/// The first estimator: follows the first live source in the order of their numbers, and the default wind where there
/// is none.
///
/// Each source has a critically damped follower of its readings, as quick as its measured interval allows, and a
/// critically damped weight that goes to 1 when it is chosen and to 0 when it is not; the default wind has the rest. A
/// critically damped response is never negative and adds up to 1, so the weights stay between 0 and 1 and sum to at
/// most 1, and the state moves continuously whatever comes in.
class FollowingEstimator final : public WindEstimator {
 public:
  FollowingEstimator(std::size_t source_count, const FollowingEstimatorSettings& settings);

  bool accept(std::size_t source, const WindReading& reading) noexcept override;
  WindState advance(MonoTime now) noexcept override;
  SourceReport report(std::size_t source) const noexcept override;

 private:
  struct Source {
    SourceRecord record;
    CriticallyDamped u, v, weight;
  };

  bool is_live(const Source& source) const noexcept;
  const Source* choose() const noexcept;

  FollowingEstimatorSettings settings_;
  SyntheticWind default_wind_;
  std::vector<Source> sources_;
  std::optional<MonoTime> begun_;
  WindState state_;
};

}  // namespace yuragi
