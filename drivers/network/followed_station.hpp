#pragma once

#include <optional>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::drivers::network {

/// Whose wind is taken if more than one station is received: the configured station's, or that of the first one that is
/// heard, until it has been silent for long. Thread-safe: no.
class FollowedStation {
 public:
  /// `chosen`: the identity of the configured station; empty: none is configured.
  explicit FollowedStation(std::string chosen) : chosen_(std::move(chosen)) {}

  /// Call for a message of a station. Returns true if it is the followed one. `name`: what people may see of it, which
  /// its identity need not be.
  bool hears(const std::string& identity, const std::string& name, MonoTime now);

  /// The followed station was silent for too long: if none is configured, the next one that sends is followed.
  void lose();

  /// Returns the name of another one, if none is configured and another one has been received in the last minutes;
  /// empty: none.
  std::string rival(MonoTime now) const;

 private:
  /// Some stations send only every 5 or 10 minutes (S9.1, S9.3).
  static constexpr Nanoseconds kStillThere = std::chrono::minutes(11);

  struct Heard {
    std::string identity;
    std::string name;
    MonoTime at{};
  };

  std::string chosen_;
  std::optional<std::string> followed_;  ///< where none is configured
  std::optional<Heard> other_;           ///< the last one that is not followed
};

}  // namespace yuragi::drivers::network
