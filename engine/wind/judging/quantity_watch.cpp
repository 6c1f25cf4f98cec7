#include "engine/wind/judging/quantity_watch.hpp"

#include <algorithm>

namespace yuragi::wind::judging {

void QuantityWatch::take(MonoTime time, double speed_m_s, bool has_it) noexcept {
  const double step_s = last_reading_ ? std::clamp(seconds(time - *last_reading_), 0.0, kMaxStep_s) : 0.0;
  last_reading_ = time;
  if (!has_it) {
    if (speed_m_s < kCalm_m_s) return;
    missing_readings_ += 1.0;
    missing_for_s_ += step_s;
    return;
  }
  if (last_) {
    const double run = std::min(missing_readings_, kMaxRuns * std::max(usual_run_, 1.0));
    runs_ += 1.0;
    usual_run_ += std::max(1.0 / runs_, kMemory) * (run - usual_run_);
  }
  last_ = time;
  is_expected_ = true;
  missing_readings_ = 0.0;
  missing_for_s_ = 0.0;
}

}  // namespace yuragi::wind::judging
