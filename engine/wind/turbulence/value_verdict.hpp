#pragma once

#include <cstddef>

#include "engine/base/state_pass.hpp"
#include "engine/wind/reading_value.hpp"
#include "engine/wind/turbulence/haar_squares.hpp"

namespace yuragi::wind::turbulence {

/// Judges from the readings of a station whether each is a mean over the interval or the instantaneous wind (W43).
///
/// Means reduce the differences between neighbouring readings more than those between longer means; instantaneous wind
/// does not. It compares the likelihoods of Haar's variances over 1 to 32 readings by W28 and by W39, over all lengths
/// by their prior. It judges after 30 min, and only while the readings are close enough to show gusts of the inertial
/// range, which have the same shape everywhere; at longer intervals averaging cannot be distinguished from a longer
/// gust.
///
/// Thread-safe: no. Realtime-safe after construction: yes; at most once a minute judge() takes about 20 us.
class ValueVerdict {
 public:
  static constexpr std::size_t kScales = 6;

  /// `length_m`: integral length scale before anything is measured; above 0.
  explicit ValueVerdict(double length_m);

  /// HaarSquares::add() of a difference over the mean speed. Scales from kScales on are not judged.
  void add(std::size_t scale, double difference, double weight) noexcept { squares_.add(scale, difference, weight); }
  /// Fades the memory by dt_s.
  void forget(double dt_s) noexcept;

  /// Judges readings every `interval_s` in a wind of mean speed `speed_m_s`, both above 0. If the interval changes by
  /// more than a fifth, judging starts again.
  void judge(double interval_s, double speed_m_s) noexcept;

  /// kMean or kInstant; kUnknown while neither is 20 times as likely as the other. A verdict is kept until the other
  /// one is reached.
  ReadingValue verdict() const noexcept { return verdict_; }

  /// The logarithm of the likelihood of the readings as instantaneous values over that as means.
  double log_likelihood_ratio(double interval_s, double speed_m_s) const noexcept;

  void list_state(StatePass& pass) {
    pass(squares_, interval_s_);
    pass.total(known_s_);
    pass.total(judged_s_);
    pass.choice(verdict_, ReadingValue::kUnknown);
  }

 private:
  void begin(double interval_s) noexcept;

  double length_m_;
  HaarSquares squares_;
  double known_s_ = 0.0;
  double judged_s_ = 0.0;  ///< of the known time, at the last judgement
  double interval_s_ = 0.0;
  ReadingValue verdict_ = ReadingValue::kUnknown;
};

}  // namespace yuragi::wind::turbulence
