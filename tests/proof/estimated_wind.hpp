#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi::proof {

/// The gusts that all runs of a program share.
std::shared_ptr<const GustNoise> shared_noise();

/// A sensor's readings on their way to the wind, as in the daemon: what is no wind at all is refused, what its judge
/// does not believe is held back, and the estimator hears the rest.
class EstimatedWind {
 public:
  explicit EstimatedWind(std::uint64_t seed) : estimator_(1, {.climate = {.seed = seed}}, shared_noise()) {}

  void take(const WindReading& reading) {
    if (is_plausible(reading) && judge_.judge(reading)) estimator_.accept(0, reading);
  }

  /// Goes on to `now`.
  WindVector advance(MonoTime now) { return estimator_.advance(now).wind; }

  const BlendedEstimator& estimator() const { return estimator_; }
  const ReadingJudge& judge() const { return judge_; }

 private:
  ReadingJudge judge_;
  BlendedEstimator estimator_;
};

/// The states of a run: from `from_s` on and before `to_s`, 60 a second, the readings told at their own times. Those
/// before `from_s` are not told.
std::vector<WindVector> wind_of(EstimatedWind& estimated, const std::vector<WindReading>& readings, double from_s,
                                double to_s);

}  // namespace yuragi::proof
