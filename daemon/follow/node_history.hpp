#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/follow/fleet.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::follow {

/// What a daemon reported of itself in up to ten minutes, which do not cross a multiple of ten minutes of UTC.
struct HistoryEntry {
  static constexpr std::int64_t kLength_s = 600;

  std::int64_t begin_utc_s = 0;   ///< its first second, since 1970
  std::uint32_t seconds = 0;      ///< with a report
  double mean_wind_m_s = 0.0;     ///< of the speed
  double max_wind_m_s = 0.0;      ///< of the speed
  double max_behind_s = 0.0;      ///< NodeReport::behind_s
  std::uint32_t attention_s = 0;  ///< seconds in which something needed attention
  std::string attention = {};     ///< the last sentence of it
  std::string software = {};      ///< the last one
  std::string part = {};          ///< the last one

  std::int64_t end_utc_s() const noexcept { return begin_utc_s + seconds; }
  /// The ten minutes of UTC that it belongs to.
  std::int64_t slot() const noexcept { return begin_utc_s / kLength_s; }
  /// Adds a later one, whose seconds are others. The beginning stays.
  void add(const HistoryEntry& later);
};

/// A message of the history: entries of one node.
struct NodeEntries {
  std::string node;
  std::vector<HistoryEntry> entries;
};

inline constexpr std::size_t kMaxEntriesInMessage = 50;
inline constexpr std::size_t kMaxHistoryMessage_bytes = 60'000;

// JSON, bounded; a failure (kBadData) has a clause without a subject. Texts are printable.
std::vector<std::uint8_t> encode(const NodeEntries& entries);
/// Refuses a message with an entry that crosses its ten minutes, has no second, or a time before 2020 or after 2100.
Result<NodeEntries, Failure> decode_node_entries(std::span<const std::uint8_t> bytes);

/// Sums the reports of this daemon into entries, and keeps these until JetStream has stored them. One message is on its
/// way at a time; without an acknowledgement the same one is sent again, later each time. Pure; belongs to one thread.
class NodeHistory {
 public:
  static constexpr std::size_t kMaxWaiting = 144;  ///< a day of entries; the oldest ones are dropped
  static constexpr std::chrono::seconds kMinPatience{10}, kMaxPatience{60};

  explicit NodeHistory(std::string node) : node_(std::move(node)) {}

  /// Adds a report; call it about once a second. A report with an absurd number or time is not counted.
  void add(const NodeReport& report, UtcTime now);

  /// There is a connection again: what waits is due at once, and so is the unfinished entry.
  void note_connection(MonoTime now);

  /// Returns the message that is to be sent now, if one is. The reply goes to take_reply().
  std::optional<std::vector<std::uint8_t>> due(MonoTime now);

  /// JetStream has replied: the message is stored, or it is not. A reply that nobody waits for is ignored.
  void take_reply(bool is_stored, MonoTime now);

  /// Returns the newest entries, the unfinished one included, for a last message before the program ends.
  std::optional<std::vector<std::uint8_t>> farewell() const;

  /// The number of finished entries that are not yet stored.
  std::size_t waiting() const noexcept { return waiting_.size(); }

 private:
  struct OnItsWay {
    std::vector<std::uint8_t> bytes;
    std::size_t finished = 0;  ///< how many of the waiting ones it holds, from the oldest on
    int tries = 0;
  };
  void finish();
  OnItsWay next_message() const;

  const std::string node_;
  HistoryEntry unfinished_;  ///< empty if it has no second
  std::int64_t last_utc_s_ = 0;
  std::deque<HistoryEntry> waiting_;
  bool hands_in_unfinished_ = false;
  std::optional<OnItsWay> on_its_way_;
  MonoTime next_{};  ///< when a message may be sent
};

/// The history of several nodes, as it was stored: an entry that was stored twice counts once. Bounded.
class FleetHistory {
 public:
  static constexpr std::size_t kMaxEntriesOfNode = 1000;

  void take(NodeEntries entries);

  /// The entries of each node, by their beginning.
  using Entries = std::map<std::int64_t, HistoryEntry>;
  const std::map<std::string, Entries>& nodes() const noexcept { return nodes_; }

 private:
  std::map<std::string, Entries> nodes_;
};

/// Returns the sums of the 24 hours of UTC that end with the hour of `now`, the oldest first. An hour without a report
/// has no second.
std::vector<HistoryEntry> hours_of(const FleetHistory::Entries& entries, UtcTime now);

}  // namespace yuragi::daemon::follow
