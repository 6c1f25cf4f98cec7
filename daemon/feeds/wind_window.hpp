#pragma once

#include <array>
#include <cstddef>

#include "daemon/values/quantity.hpp"

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
  static constexpr std::size_t kParts = 12;  ///< of 3 s, in quarters of a second
  static constexpr double kPart_s = 0.25;

  struct Sum {
    double value = 0.0, time_s = 0.0;
  };
  void add_to_gust(double speed_m_s, double dt_s);

  Summary sums_, last_;
  double time_s_ = 0.0;
  bool is_first_ = true;
  double before_s_ = 0.0;
  std::array<Sum, kParts> parts_{};
  std::size_t part_ = 0;
  double since_part_s_ = 0.0;
};

}  // namespace yuragi::daemon::feeds
