#pragma once

#include <optional>
#include <string>

#include "drivers/mqtt/mqtt_payload.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::mqtt {

/// The station that sent a message, in rtl_433's data fields (merbanan/rtl_433): numbers as text. Empty: not sent, or,
/// to select a station, any. The id of many stations changes with their batteries.
struct StationIdentity {
  std::string model;    ///< "Acurite-5n1"
  std::string id;       ///< "115", "0a003b"
  std::string channel;  ///< "A", "1"

  bool operator==(const StationIdentity&) const = default;

  bool is_empty() const noexcept { return model.empty() && id.empty() && channel.empty(); }
  /// Returns true if `other` is one of those that this one includes.
  bool covers(const StationIdentity& other) const noexcept;
};

/// /model, /id and /channel of a message.
StationIdentity station_of(const Payload& payload);

/// "Acurite-5n1, id 115, channel A". Each of the three is shown up to 40 characters, printable.
std::string describe(const StationIdentity& station);

/// Which of several stations on one topic is read: the first that is heard, until it has been silent for a given time
/// and another is heard. So two winds are never mixed.
class StationChoice {
 public:
  /// `patience`: how long the station that is read may be silent before another takes its place.
  explicit StationChoice(Nanoseconds patience) : patience_(patience) {}

  /// Call for a message with wind of `station`. Returns true if it is the selected one.
  bool offer(const StationIdentity& station, MonoTime now);
  /// Returns true for the selected station.
  bool is_read(const StationIdentity& station) const noexcept { return read_ == station; }
  /// Call when the connection was opened again: starts again.
  void restart() noexcept;

  /// Returns a warning if another station has been received within that time; empty: none has.
  std::string warning(MonoTime now) const;

 private:
  Nanoseconds patience_;
  std::optional<StationIdentity> read_;
  MonoTime read_at_{};
  std::optional<StationIdentity> other_;  // the last one that is not read
  MonoTime other_at_{};
};

}  // namespace yuragi::drivers::mqtt
