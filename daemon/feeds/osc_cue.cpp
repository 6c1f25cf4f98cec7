#include "daemon/feeds/osc_cue.hpp"

#include "engine/wind/judging/sensor_state.hpp"

namespace yuragi::daemon::feeds {
namespace {

using settings::feeds::OscCondition;

constexpr double kRiseWithin_s = 2.0;

}  // namespace

/// Keeps those of the last 2 s that can be the weakest, in order.
bool CueTrigger::rises(double speed_m_s, double time_s) {
  while (!recent_.empty() && time_s - recent_.front().time_s > kRiseWithin_s) recent_.pop_front();
  while (!recent_.empty() && recent_.back().m_s >= speed_m_s) recent_.pop_back();
  recent_.push_back({time_s, speed_m_s});
  return speed_m_s - recent_.front().m_s >= cue_.rise_m_s;
}

bool CueTrigger::is_any_silent(const values::Moment& moment) const {
  for (std::size_t i = 0; i < moment.sensors.size() && i < moment.names->sensors.size(); ++i) {
    const bool is_meant = cue_.sensor.empty() || moment.names->sensors[i] == cue_.sensor;
    if (is_meant && !wind::judging::is_believed(moment.sensors[i].state)) return true;
  }
  return false;
}

bool CueTrigger::holds(const values::Moment& moment, values::Wind wind) const {
  const double speed_m_s = moment.wind(wind)[values::Quantity::kSpeed];
  switch (cue_.when) {
    case OscCondition::kWindAbove:
      return speed_m_s > cue_.limit_m_s();
    case OscCondition::kCalm:
      return speed_m_s < cue_.limit_m_s();
    case OscCondition::kSensorSilent:
      return is_any_silent(moment);
    case OscCondition::kGust:
      break;
  }
  return false;
}

bool CueTrigger::is_due(const values::Moment& moment, values::Wind wind) {
  const double now_s = moment.time_s;
  const bool is_gust = cue_.when == OscCondition::kGust;
  if (!(is_gust ? rises(moment.wind(wind)[values::Quantity::kSpeed], now_s) : holds(moment, wind))) {
    held_since_s_.reset();
    is_sent_ = false;
    return false;
  }
  if (!held_since_s_) held_since_s_ = now_s;
  if (is_sent_ || (!is_gust && now_s - *held_since_s_ < cue_.holds_for_s())) return false;
  if (sent_s_ && now_s - *sent_s_ < cue_.again_after_s) return false;
  is_sent_ = true;
  sent_s_ = now_s;
  return true;
}

}  // namespace yuragi::daemon::feeds
