#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/decode/network/json_wind.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::json {

/// What an answer is.
enum class Novelty : std::uint8_t {
  kNew,       ///< a new observation
  kRepeated,  ///< the last one again, which is still the wind
  kOld,       ///< an observation that no longer holds: of a station that has stopped
};

/// Tells new observations from repeated ones: a server is asked more often than it has a new value.
///
/// With a time in the answers, an observation is new if its time is another one, and old if the same time comes for
/// longer than `silence`, or if it names a moment that is further back by the machine's clock. A text without a zone
/// names no moment. Without a time, the same values are new only after `interval`, because a calm repeats them.
/// Thread-safe: no.
class ObservationWatch {
 public:
  ObservationWatch(Nanoseconds interval, Nanoseconds silence) : interval_(interval), silence_(silence) {}

  Novelty take(const decode::network::JsonWind& observation, const Instant& now);

  /// The server has confirmed that the last answer has not changed. Only after a take().
  Novelty take_unchanged(const Instant& now);

  /// The last one that was taken; nullopt: none yet.
  const std::optional<decode::network::JsonWind>& last() const noexcept { return last_; }

 private:
  bool is_of_the_past(const Instant& now) const;

  Nanoseconds interval_;
  Nanoseconds silence_;
  std::optional<decode::network::JsonWind> last_;
  std::optional<UtcTime> moment_;  ///< of `last_`, if its time names one
  MonoTime new_at_{};
};

/// The moment that a time in an answer names: seconds or milliseconds since 1970, or ISO 8601 with a zone; nullopt:
/// none. Thread-safe: yes.
std::optional<UtcTime> moment_of(const std::string& time);

}  // namespace yuragi::drivers::json
