#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi::proof {

/// The gusts that all runs of a program share.
std::shared_ptr<const wind::turbulence::GustNoise> shared_noise();

/// A sensor's readings on their way to the wind, as in the daemon: what is no wind at all is refused, what its judge
/// does not believe is held back, and the estimator hears the rest.
class EstimatedWind {
 public:
  explicit EstimatedWind(std::uint64_t seed) : estimator_(1, {.climate = {.seed = seed}}, shared_noise()) {}

  void take(const wind::Reading& reading) {
    if (wind::is_plausible(reading) && judge_.judge(reading)) estimator_.accept(0, reading);
  }

  /// Goes on to `now`.
  wind::Vector advance(MonoTime now) { return estimator_.advance(now).wind; }

  const wind::blend::BlendedEstimator& estimator() const { return estimator_; }
  const wind::judging::ReadingJudge& judge() const { return judge_; }

 private:
  wind::judging::ReadingJudge judge_;
  wind::blend::BlendedEstimator estimator_;
};

/// The states of a run: from `from_s` on and before `to_s`, 60 a second, the readings told at their own times. Those
/// before `from_s` are not told.
std::vector<wind::Vector> wind_of(EstimatedWind& estimated, const std::vector<wind::Reading>& readings, double from_s,
                                  double to_s);

}  // namespace yuragi::proof
