#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/logs/key_reader.hpp"
#include "daemon/tools/logs/log_message.hpp"
#include "drivers/decode/marine/bus_line.hpp"
#include "drivers/decode/network/tempest.hpp"

namespace yuragi::daemon::tools::logs {

/// What finds messages, for people.
inline constexpr const char* kMessagesThatAreFound =
    "NMEA 0183, NMEA 2000, Gill, FT, UMB, Vaisala WXT, Tempest, WeatherLink Live, Signal K, and keys in text, JSON or "
    "what stations push (\"speed=4.2 direction=270\", wind_avg_m_s, windspeedmph)";

/// Finds and decodes the messages in the lines of a log, in their order. Thread-safe: no.
class MessageFinder {
 public:
  /// Uses what KeyReader uses.
  explicit MessageFinder(const csv::ImportOptions& options) : keys_(options), bus_({}) {}

  /// The message in a line, or, of one key a line, the one that it ends; nullopt if there is none.
  std::optional<Message> find(std::string_view line);
  /// The last one of one key a line.
  std::optional<Message> finish();
  /// Returns true if the last line is a part of a message that goes on.
  bool has_absorbed() const { return keys_.has_absorbed(); }
  /// Returns true if the last line in which nothing was found has several keys.
  bool has_keys() const { return keys_.has_keys(); }

  /// How the messages of a source were understood, a line each; can be empty.
  std::vector<std::string> describe(std::string_view source) const { return keys_.describe(source); }

 private:
  std::optional<Message> json_message(std::string_view text);
  std::optional<Message> tempest_message(std::string_view text);
  std::optional<Message> bus_message(std::string_view line);

  KeyReader keys_;
  drivers::decode::marine::BusLineDecoder bus_;
  std::map<std::string, drivers::decode::network::TempestWinds> tempests_;
};

}  // namespace yuragi::daemon::tools::logs
