#pragma once

#include <optional>
#include <string>

#include "engine/base/time.hpp"

namespace yuragi::drivers::network {

/// Whose wind is taken where the hubs of a network speak of more than one station: the configured station's, or that of
/// the first one that is heard, until it has been silent for long. Thread-safe: no.
class TempestStations {
 public:
  /// `chosen`: the serial number of the configured station; empty: none is configured.
  explicit TempestStations(std::string chosen) : chosen_(std::move(chosen)) {}

  /// A station has spoken of its wind. Is it the one that is followed?
  bool hears(const std::string& serial_number, MonoTime now);

  /// The one that is followed has been silent for too long: without a configured one the next that speaks is followed.
  void lose();

  /// Its serial number; empty where none is configured and none has been heard.
  const std::string& followed() const noexcept { return chosen_.empty() ? followed_ : chosen_; }

  /// What a person should know of the others that have been heard in the last minutes; empty: nothing.
  std::string warning(MonoTime now) const;

 private:
  /// A station that saves its battery speaks every 5 minutes (S9.1).
  static constexpr Nanoseconds kStillThere = std::chrono::minutes(11);

  std::string chosen_;
  std::string followed_;
  std::string other_;  ///< the last one that is not followed
  std::optional<MonoTime> other_heard_at_;
};

}  // namespace yuragi::drivers::network
