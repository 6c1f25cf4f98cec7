#pragma once

#include "daemon/values/quantity.hpp"
#include "daemon/values/three_second_mean.hpp"

namespace yuragi::daemon::feeds {

/// The wind of some seconds. Times with a weight are those between two moments, of which at most a second counts.
/// Thread-safe: no.
class WindWindow {
 public:
  struct Summary {
    double mean_m_s = 0.0;
    double strongest_3_s_m_s = 0.0;  ///< the largest mean of 3 s that ended within these seconds, at least mean_m_s
    double min_m_s = 0.0;
    double u_m_s = 0.0, v_m_s = 0.0;  ///< mean, toward which it blows
    double norm = 0.0;                ///< mean
  };

  void add(const values::Readout& wind, double time_s);

  /// Of all since the last call; nothing has been added: the last wind.
  Summary take();

 private:
  Summary sums_, last_;
  double time_s_ = 0.0;
  bool is_first_ = true;
  double before_s_ = 0.0;
  values::ThreeSecondMean gust_;
};

}  // namespace yuragi::daemon::feeds
