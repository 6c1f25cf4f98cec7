#include "daemon/feeds/wind_window.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::daemon::feeds {

using values::Quantity;

void WindWindow::add(const values::Readout& wind, double time_s) {
  const double dt_s = is_first_ ? 0.0 : std::clamp(time_s - before_s_, 0.0, 1.0);
  const double speed_m_s = wind[Quantity::kSpeed];
  last_ = {.mean_m_s = speed_m_s,
           .strongest_3_s_m_s = speed_m_s,
           .min_m_s = speed_m_s,
           .u_m_s = wind[Quantity::kU],
           .v_m_s = wind[Quantity::kV],
           .norm = wind[Quantity::kNorm]};
  before_s_ = time_s;
  if (std::exchange(is_first_, false) || dt_s <= 0.0) return;
  sums_.min_m_s = time_s_ > 0.0 ? std::min(sums_.min_m_s, speed_m_s) : speed_m_s;
  sums_.mean_m_s += speed_m_s * dt_s;
  sums_.u_m_s += last_.u_m_s * dt_s;
  sums_.v_m_s += last_.v_m_s * dt_s;
  sums_.norm += last_.norm * dt_s;
  time_s_ += dt_s;
  const double gust_m_s = gust_.add(speed_m_s, dt_s).value_or(gust_.mean());
  sums_.strongest_3_s_m_s = std::max(sums_.strongest_3_s_m_s, gust_m_s);
}

WindWindow::Summary WindWindow::take() {
  const Summary sums = std::exchange(sums_, {});
  const double time_s = std::exchange(time_s_, 0.0);
  if (time_s <= 0.0) return last_;
  const double mean_m_s = sums.mean_m_s / time_s;
  return {.mean_m_s = mean_m_s,
          .strongest_3_s_m_s = std::max(sums.strongest_3_s_m_s, mean_m_s),
          .min_m_s = sums.min_m_s,
          .u_m_s = sums.u_m_s / time_s,
          .v_m_s = sums.v_m_s / time_s,
          .norm = sums.norm / time_s};
}

}  // namespace yuragi::daemon::feeds
