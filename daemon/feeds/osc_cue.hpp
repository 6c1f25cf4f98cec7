#pragma once

#include <deque>
#include <optional>

#include "daemon/settings/feeds/osc.hpp"
#include "daemon/values/moment.hpp"

namespace yuragi::daemon::feeds {

/// Decides when an [[osc.cue]] is sent: once when its condition begins to hold, and not again before `again_after`.
/// Time is the moments'. Thread-safe: no.
class CueTrigger {
 public:
  explicit CueTrigger(const settings::feeds::OscCue& cue) : cue_(cue) {}

  /// Returns true if the cue is to be sent now.
  bool is_due(const values::Moment& moment, values::Wind wind);

 private:
  struct Speed {
    double time_s, m_s;
  };
  bool rises(double speed_m_s, double time_s);
  bool holds(const values::Moment& moment, values::Wind wind) const;
  bool is_any_silent(const values::Moment& moment) const;

  settings::feeds::OscCue cue_;
  std::deque<Speed> recent_;  ///< rising: each is weaker than all after it
  std::optional<double> held_since_s_, sent_s_;
  bool is_sent_ = false;  ///< since it holds
};

}  // namespace yuragi::daemon::feeds
