#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::drivers::network {

/// Decides when a station with its own interval counts as silent: without wind for the configured time and for a few of
/// its usual intervals. A station that replaces another one starts again. Thread-safe: no.
class StationSilence {
 public:
  /// `shortest`: minimum length of a silence; `intervals`: and its minimum number of usual intervals.
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
  MonoTime since_{};                     ///< the last wind, or the time since when wind could have been received
  std::optional<std::string> identity_;  ///< of the station that gave the last wind
  std::array<Nanoseconds, 2> last_pauses_{};
};

}  // namespace yuragi::drivers::network
