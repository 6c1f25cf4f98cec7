#pragma once

#include "engine/base/state_pass.hpp"

namespace yuragi::wind::blend {

/// The gain of a relative source: a slow regression against the absolute sources at the same time.
///
/// The gusts' gain comes from the deviations of both in the bands that both know, the mean's from the mean speeds;
/// if little is known of the deviations, the gusts have the mean's gain, and if nothing is known both are 1. Everything
/// fades with `memory_s`; without an absolute source it is kept. Thread-safe: no. Realtime-safe: yes.
class RelativeScale {
 public:
  explicit RelativeScale(double memory_s) : memory_s_(memory_s) {}

  /// Both at one moment.
  struct Pair {
    double speed_m_s = 0.0;  ///< slow mean, absolute
    double relative_speed_m_s = 0.0;
    double gust_m_s = 0.0;  ///< in the bands known to both, without the mean, absolute
    double relative_gust_m_s = 0.0;
    double independent_after_s = 0.0;  ///< time between independent gusts; above 0
  };
  void learn(const Pair& pair, double dt_s) noexcept;

  /// For the mean, and for the gusts: 0.05 to 20.
  double mean_gain() const noexcept { return mean_gain_; }
  double gust_gain() const noexcept { return gust_gain_; }

  void list_state(StatePass& pass) {
    for (double* sum : {&weight_s_, &speed_, &relative_speed_, &square_, &relative_square_, &gusts_seen_}) {
      pass.within(*sum, -StatePass::kLargestTotal, StatePass::kLargestTotal);
    }
    pass(mean_gain_, gust_gain_);
  }

 private:
  double memory_s_;
  double weight_s_ = 0.0;  ///< of the sums: time, with fading
  double speed_ = 0.0, relative_speed_ = 0.0;
  double square_ = 0.0, relative_square_ = 0.0;
  double gusts_seen_ = 0.0;  ///< independent ones
  double mean_gain_ = 1.0, gust_gain_ = 1.0;
};

}  // namespace yuragi::wind::blend
