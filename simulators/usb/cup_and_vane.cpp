#include "simulators/usb/cup_and_vane.hpp"

#include <algorithm>

namespace yuragi::simulators::usb {

void CupAndVane::advance(double time_s, const core::PlayedMoment& wind, bool is_jammed) {
  const double step_s = std::max(time_s - time_s_, 0.0);
  time_s_ = std::max(time_s, time_s_);
  if (is_jammed) return;
  passed_m_ += wind.speed_m_s * step_s;
  const bool is_on_track = wind.direction_deg <= kTrack_deg;
  wiper_v_ = is_on_track ? wind.direction_deg / kTrack_deg * kReference_v : kOpenWiper_v;
}

std::uint64_t CupAndVane::pulses() const noexcept {
  return static_cast<std::uint64_t>(passed_m_ / kMetresPerPulse);
}

}  // namespace yuragi::simulators::usb
