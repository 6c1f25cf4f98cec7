#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::drivers::network {

/// When a station that speaks at an interval of its own counts as silent: without wind for the configured time and for
/// a few of its usual intervals. A station that takes the place of another one starts anew. Thread-safe: no.
class StationSilence {
 public:
  /// `shortest`: a silence is at least this long; `intervals`: and at least so many usual intervals.
  StationSilence(Nanoseconds shortest, int intervals) : shortest_(shortest), intervals_(intervals) {}

  /// Forgets all: there could be wind from now on.
  void begin(MonoTime now) {
    since_ = now;
    identity_.reset();
    last_pauses_ = {};
  }

  /// The station of this identity has given a wind.
  void end(const std::string& identity, MonoTime now) {
    if (identity_ == identity) {
      last_pauses_ = {last_pauses_[1], now - since_};
    } else {
      last_pauses_ = {};
    }
    identity_ = identity;
    since_ = now;
  }

  Nanoseconds length(MonoTime now) const noexcept { return now - since_; }

  bool is_long(MonoTime now) const noexcept {
    // The smaller one of two pauses: one message that is lost is not the usual interval.
    return length(now) >= std::max(shortest_, intervals_ * std::min(last_pauses_[0], last_pauses_[1]));
  }

 private:
  Nanoseconds shortest_;
  int intervals_;
  MonoTime since_{};                     ///< the last wind, or since when there could have been one
  std::optional<std::string> identity_;  ///< of the station that gave the last wind
  std::array<Nanoseconds, 2> last_pauses_{};
};

}  // namespace yuragi::drivers::network
