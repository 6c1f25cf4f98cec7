#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "engine/base/time.hpp"

namespace yuragi {

/// How often something comes, learnt from the last of its arrivals, and for how long it has not come now.
/// Realtime-safe: yes.
class ArrivalWatch {
 public:
  /// Begins to wait anew: a pause in which nothing could come says nothing about how often it does.
  void restart(MonoTime now) noexcept {
    last_ = now;
    has_come_ = false;
  }

  void arrive(MonoTime now) noexcept {
    if (has_come_) {
      pauses_[next_] = now - last_;
      next_ = (next_ + 1) % pauses_.size();
      count_ = std::min(count_ + 1, std::ssize(pauses_));
    }
    last_ = now;
    has_come_ = true;
  }

  /// Since the last arrival, or since restart().
  Nanoseconds quiet_for(MonoTime now) const noexcept { return now - last_; }
  bool has_come_since_restart() const noexcept { return has_come_; }

  /// The longest of the last eight pauses between arrivals; zero as long as there was none.
  Nanoseconds longest_pause() const noexcept {
    return count_ == 0 ? Nanoseconds::zero() : *std::max_element(pauses_.begin(), pauses_.begin() + count_);
  }

 private:
  std::array<Nanoseconds, 8> pauses_{};
  std::size_t next_ = 0;
  std::ptrdiff_t count_ = 0;
  MonoTime last_{};
  bool has_come_ = false;
};

}  // namespace yuragi
