#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "engine/base/time.hpp"

namespace yuragi::drivers::text {

/// Measures the usual pause between messages from the last arrivals, and the time since the last one. An outage is left
/// out of it, unless it repeats: then it is the usual pause.
/// Realtime-safe: yes.
class ArrivalWatch {
 public:
  /// Restarts the wait: a pause in which nothing could arrive does not count.
  void restart(MonoTime now) noexcept {
    last_ = now;
    has_come_ = false;
  }

  void arrive(MonoTime now) noexcept {
    if (has_come_) learn(now - last_);
    last_ = now;
    has_come_ = true;
  }

  /// Since the last arrival, or since restart().
  Nanoseconds quiet_for(MonoTime now) const noexcept { return now - last_; }

  /// The longest of the last eight pauses between arrivals; zero as long as there was none.
  Nanoseconds usual_pause() const noexcept { return *std::ranges::max_element(pauses_); }

 private:
  static constexpr std::size_t kKnown = 3;  // pauses that the usual one is taken from
  static constexpr int kOutage = 5;         // times the usual pause
  static constexpr int kOutagesInARow = 3;

  void learn(Nanoseconds pause) noexcept {
    const bool is_outage = count_ >= kKnown && pause > kOutage * usual_pause();
    outages_ = is_outage ? outages_ + 1 : 0;
    if (is_outage && outages_ < kOutagesInARow) return;
    if (is_outage) {
      pauses_ = {};
      count_ = 0;
      outages_ = 0;
    }
    pauses_[count_ % pauses_.size()] = pause;
    ++count_;
  }

  std::array<Nanoseconds, 8> pauses_{};  // zero if there was none
  std::size_t count_ = 0;
  int outages_ = 0;
  MonoTime last_{};
  bool has_come_ = false;
};

}  // namespace yuragi::drivers::text
