#include "daemon/follow/node_history.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/follow/small_json.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::follow {
namespace {

constexpr std::size_t kMaxText_bytes = 300;
constexpr double kMaxSpeed_m_s = 1e3, kMaxBehind_s = 1e9;
/// The years 2020 to 2100: a clock outside of them is not set.
constexpr std::int64_t kMinTime_s = 1'577'836'800, kMaxTime_s = 4'102'444'800;
constexpr std::int64_t kMaxBetweenReports_s = 2;
constexpr std::int64_t kHour_s = 3600;
constexpr std::size_t kHours = 24;

std::int64_t whole_seconds(UtcTime time) {
  return std::chrono::floor<std::chrono::seconds>(time).time_since_epoch().count();
}

bool is_time(std::int64_t time_s) {
  return time_s >= kMinTime_s && time_s < kMaxTime_s;
}

std::string short_line(const std::string& text) {
  return shortened(text, kMaxText_bytes / 4);
}

nlohmann::ordered_json json_of(const HistoryEntry& entry) {
  return {{"begin_utc_s", entry.begin_utc_s},
          {"seconds", entry.seconds},
          {"mean_wind_m_s", entry.mean_wind_m_s},
          {"max_wind_m_s", entry.max_wind_m_s},
          {"max_behind_s", entry.max_behind_s},
          {"attention_s", entry.attention_s},
          {"attention", short_line(entry.attention)},
          {"software", short_line(entry.software)},
          {"part", short_line(entry.part)}};
}

std::optional<HistoryEntry> entry_of(const nlohmann::json& json) {
  if (!json.is_object()) return std::nullopt;
  const auto begin_s = count_at(json, "begin_utc_s"), seconds = count_at(json, "seconds"),
             attention_s = count_at(json, "attention_s");
  const auto mean_m_s = number_at(json, "mean_wind_m_s", kMaxSpeed_m_s),
             max_m_s = number_at(json, "max_wind_m_s", kMaxSpeed_m_s),
             behind_s = number_at(json, "max_behind_s", kMaxBehind_s);
  auto attention = text_at(json, "attention", kMaxText_bytes), software = text_at(json, "software", kMaxText_bytes),
       part = text_at(json, "part", kMaxText_bytes);
  if (!begin_s || !seconds || !attention_s || !mean_m_s || !max_m_s || !behind_s || !attention || !software || !part)
    return std::nullopt;
  if (*begin_s >= static_cast<std::uint64_t>(kMaxTime_s) || !is_time(static_cast<std::int64_t>(*begin_s)) ||
      *seconds == 0 || *seconds > static_cast<std::uint64_t>(HistoryEntry::kLength_s) || *attention_s > *seconds ||
      *mean_m_s < 0.0 || *max_m_s < 0.0) {
    return std::nullopt;
  }
  HistoryEntry entry{.begin_utc_s = static_cast<std::int64_t>(*begin_s),
                     .seconds = static_cast<std::uint32_t>(*seconds),
                     .mean_wind_m_s = *mean_m_s,
                     .max_wind_m_s = *max_m_s,
                     .max_behind_s = *behind_s,
                     .attention_s = static_cast<std::uint32_t>(*attention_s),
                     .attention = std::move(*attention),
                     .software = std::move(*software),
                     .part = std::move(*part)};
  if ((entry.end_utc_s() - 1) / HistoryEntry::kLength_s != entry.slot()) return std::nullopt;
  return entry;
}

}  // namespace

void HistoryEntry::add(const HistoryEntry& later) {
  if (later.seconds == 0) return;
  const double share = static_cast<double>(later.seconds) / (static_cast<double>(seconds) + later.seconds);
  mean_wind_m_s += share * (later.mean_wind_m_s - mean_wind_m_s);
  max_wind_m_s = std::max(max_wind_m_s, later.max_wind_m_s);
  max_behind_s = std::max(max_behind_s, later.max_behind_s);
  seconds += later.seconds;
  attention_s += later.attention_s;
  if (!later.attention.empty()) attention = later.attention;
  software = later.software;
  part = later.part;
}

std::vector<std::uint8_t> encode(const NodeEntries& entries) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const HistoryEntry& entry : entries.entries) all.push_back(json_of(entry));
  return bytes_of({{"node", entries.node}, {"entries", std::move(all)}});
}

Result<NodeEntries, Failure> decode_node_entries(std::span<const std::uint8_t> bytes) {
  const nlohmann::json json = small_json(bytes);
  if (!json.is_object()) return bad_data("is no history of a node");
  auto node = text_at(json, "node", kMaxText_bytes);
  const auto all = json.find("entries");
  if (!node || node->empty() || all == json.end() || !all->is_array() || all->empty() ||
      all->size() > kMaxEntriesInMessage) {
    return bad_data("is no history of a node");
  }
  NodeEntries entries{.node = std::move(*node), .entries = {}};
  entries.entries.reserve(all->size());
  for (const nlohmann::json& one : *all) {
    auto entry = entry_of(one);
    if (!entry) return bad_data("has an entry with a key that is missing or has no such value");
    entries.entries.push_back(std::move(*entry));
  }
  return entries;
}

void NodeHistory::add(const NodeReport& report, UtcTime now) {
  const std::int64_t now_s = whole_seconds(now);
  if (!is_time(now_s) || !(report.wind_m_s >= 0.0 && report.wind_m_s <= kMaxSpeed_m_s) ||
      !(std::abs(report.behind_s) <= kMaxBehind_s)) {
    return;
  }
  const std::int64_t since_last_s = now_s - std::exchange(last_utc_s_, now_s);
  if (since_last_s == 0) return;
  // A second that fell between two reports is covered. After a longer gap or a clock that was set, only this one is.
  std::int64_t covered_s = since_last_s > 0 && since_last_s <= kMaxBetweenReports_s ? since_last_s : 1;
  const std::int64_t slot = now_s / HistoryEntry::kLength_s;
  if (unfinished_.seconds > 0 && slot != unfinished_.slot()) finish();
  if (unfinished_.seconds == 0) {
    covered_s = std::min(covered_s, now_s - slot * HistoryEntry::kLength_s + 1);
    unfinished_.begin_utc_s = now_s - covered_s + 1;
  }
  // Less is left if the clock was set back within these ten minutes.
  covered_s = std::min(covered_s, (slot + 1) * HistoryEntry::kLength_s - unfinished_.end_utc_s());
  if (covered_s <= 0) return;
  const auto seconds = static_cast<std::uint32_t>(covered_s);
  unfinished_.add({.begin_utc_s = now_s,
                   .seconds = seconds,
                   .mean_wind_m_s = report.wind_m_s,
                   .max_wind_m_s = report.wind_m_s,
                   .max_behind_s = report.behind_s,
                   .attention_s = report.attention.empty() ? 0U : seconds,
                   .attention = report.attention.empty() ? "" : short_line(report.attention.front()),
                   .software = short_line(report.software),
                   .part = short_line(report.part)});
}

void NodeHistory::finish() {
  waiting_.push_back(std::exchange(unfinished_, {}));
  if (waiting_.size() <= kMaxWaiting) return;
  waiting_.pop_front();
  if (on_its_way_ && on_its_way_->finished > 0) --on_its_way_->finished;
}

void NodeHistory::note_connection(MonoTime now) {
  hands_in_unfinished_ = true;
  next_ = now;
  if (on_its_way_) on_its_way_->tries = 0;
}

NodeHistory::OnItsWay NodeHistory::next_message() const {
  for (std::size_t count = std::min(waiting_.size(), kMaxEntriesInMessage);; count /= 2) {
    NodeEntries message{.node = node_, .entries = {}};
    message.entries.assign(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
    const bool is_all = count == waiting_.size() && count < kMaxEntriesInMessage;
    if (is_all && hands_in_unfinished_ && unfinished_.seconds > 0) message.entries.push_back(unfinished_);
    std::vector<std::uint8_t> bytes = encode(message);
    if (bytes.size() <= kMaxHistoryMessage_bytes || count <= 1)
      return {.bytes = std::move(bytes), .finished = count, .tries = 0};
  }
}

std::optional<std::vector<std::uint8_t>> NodeHistory::due(MonoTime now) {
  if (now < next_) return std::nullopt;
  if (!on_its_way_) {
    const bool has_unfinished = hands_in_unfinished_ && unfinished_.seconds > 0;
    if (waiting_.empty() && !has_unfinished) return std::nullopt;
    on_its_way_ = next_message();
    if (on_its_way_->finished == waiting_.size()) hands_in_unfinished_ = false;
  }
  const auto patience = kMinPatience * (1 << std::min(on_its_way_->tries, 3));
  ++on_its_way_->tries;
  next_ = now + std::min<std::chrono::seconds>(patience, kMaxPatience);
  return on_its_way_->bytes;
}

void NodeHistory::take_reply(bool is_stored, MonoTime now) {
  if (!on_its_way_ || !is_stored) return;
  // After several tries further acknowledgements may come: none of them is taken for one of the next message.
  next_ = on_its_way_->tries > 1 ? now + kMinPatience : now;
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(on_its_way_->finished));
  on_its_way_.reset();
}

std::optional<std::vector<std::uint8_t>> NodeHistory::farewell() const {
  NodeEntries message{.node = node_, .entries = {}};
  const std::size_t count = std::min(waiting_.size(), kMaxEntriesInMessage - 1);
  message.entries.assign(waiting_.end() - static_cast<std::ptrdiff_t>(count), waiting_.end());
  if (unfinished_.seconds > 0) message.entries.push_back(unfinished_);
  while (!message.entries.empty()) {
    std::vector<std::uint8_t> bytes = encode(message);
    if (bytes.size() <= kMaxHistoryMessage_bytes) return bytes;
    message.entries.erase(message.entries.begin());
  }
  return std::nullopt;
}

void FleetHistory::take(NodeEntries entries) {
  if (nodes_.size() >= Fleet::kMaxNodes && !nodes_.contains(entries.node)) return;
  Entries& held = nodes_[entries.node];
  for (HistoryEntry& entry : entries.entries) {
    HistoryEntry& at = held[entry.begin_utc_s];
    if (entry.seconds > at.seconds) at = std::move(entry);
    if (held.size() > kMaxEntriesOfNode) held.erase(held.begin());
  }
}

std::vector<HistoryEntry> hours_of(const FleetHistory::Entries& entries, UtcTime now) {
  const std::int64_t last_hour = whole_seconds(now) / kHour_s;
  std::vector<HistoryEntry> hours(kHours);
  for (std::size_t i = 0; i < kHours; ++i)
    hours[i].begin_utc_s = (last_hour + 1 - static_cast<std::int64_t>(kHours - i)) * kHour_s;
  const std::int64_t first_hour = hours.front().begin_utc_s / kHour_s;
  for (const auto& [begin_s, entry] : entries) {
    const std::int64_t place = begin_s / kHour_s - first_hour;
    if (place >= 0 && place < static_cast<std::int64_t>(kHours)) hours[static_cast<std::size_t>(place)].add(entry);
  }
  return hours;
}

}  // namespace yuragi::daemon::follow
