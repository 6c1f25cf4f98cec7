#include "daemon/follow/node_history.hpp"

#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/follow/history_stream.hpp"

namespace yuragi::daemon::follow {
namespace {

using std::chrono::seconds;

const MonoTime kNow{std::chrono::hours(3)};
/// 2026-11-30 12:00:00.
constexpr std::int64_t kNoon_s = 1'796'040'000;

UtcTime utc(std::int64_t time_s) {
  return UtcTime(seconds(time_s));
}

NodeReport report_of(double wind_m_s, double behind_s = 0.01, std::vector<std::string> attention = {}) {
  return {.name = "roof",
          .software = "yuragi 1",
          .part = "leads",
          .wind_m_s = wind_m_s,
          .wind_from_deg = 240.0,
          .tick = 7,
          .behind_s = behind_s,
          .attention = std::move(attention)};
}

/// One report a second.
void add_seconds(NodeHistory& history, std::int64_t from_s, std::int64_t to_s, const NodeReport& report) {
  for (std::int64_t at_s = from_s; at_s < to_s; ++at_s) history.add(report, utc(at_s));
}

NodeEntries read(const std::optional<std::vector<std::uint8_t>>& message) {
  if (!message) return {};
  auto entries = decode_node_entries(*message);
  EXPECT_TRUE(entries) << entries.error().message;
  EXPECT_LE(message->size(), 64'000U);
  return entries ? std::move(*entries) : NodeEntries{};
}

template <class Decode>
auto decoded(std::string_view text, const Decode& decode) {
  return decode(std::vector<std::uint8_t>(text.begin(), text.end()));
}

TEST(NodeHistory, SumsReportsIntoTenMinutesOfUtc) {
  NodeHistory history("roof");
  add_seconds(history, kNoon_s - 100, kNoon_s, report_of(2.0));
  add_seconds(history, kNoon_s, kNoon_s + 300, report_of(4.0, 0.5));
  add_seconds(history, kNoon_s + 300, kNoon_s + 598, report_of(1.0, 0.1, {"sensor mast is silent", "more"}));
  history.add(report_of(8.0, -0.1, {"the disk is full"}), utc(kNoon_s + 599));
  EXPECT_EQ(history.waiting(), 1U);
  history.add(report_of(1.0), utc(kNoon_s + 600));
  EXPECT_EQ(history.waiting(), 2U);
  const NodeEntries sent = read(history.due(kNow));
  EXPECT_EQ(sent.node, "roof");
  ASSERT_EQ(sent.entries.size(), 2U);
  EXPECT_EQ(sent.entries[0].begin_utc_s, kNoon_s - 100);
  EXPECT_EQ(sent.entries[0].seconds, 100U);
  EXPECT_NEAR(sent.entries[0].mean_wind_m_s, 2.0, 1e-9);
  const HistoryEntry& entry = sent.entries[1];
  EXPECT_EQ(entry.begin_utc_s, kNoon_s);
  EXPECT_EQ(entry.seconds, 600U) << "the second without a report of its own is covered";
  EXPECT_NEAR(entry.mean_wind_m_s, (300 * 4.0 + 298 * 1.0 + 2 * 8.0) / 600, 1e-9);
  EXPECT_EQ(entry.max_wind_m_s, 8.0);
  EXPECT_EQ(entry.max_behind_s, 0.5);
  EXPECT_EQ(entry.attention_s, 300U);
  EXPECT_EQ(entry.attention, "the disk is full");
  EXPECT_EQ(entry.software, "yuragi 1");
  EXPECT_EQ(entry.part, "leads");
}

TEST(NodeHistory, GapsAreNotCovered) {
  NodeHistory history("roof");
  history.add(report_of(2.0), utc(kNoon_s));
  history.add(report_of(2.0), utc(kNoon_s + 100));
  history.add(report_of(2.0), utc(kNoon_s + 100));
  const NodeEntries sent = read(history.farewell());
  ASSERT_EQ(sent.entries.size(), 1U);
  EXPECT_EQ(sent.entries[0].seconds, 2U);
}

TEST(NodeHistory, AClockThatJumpsLeavesSoundEntries) {
  NodeHistory history("roof");
  add_seconds(history, 1000, 1010, report_of(2.0));  // 1970: the clock is not set
  EXPECT_FALSE(history.farewell());
  add_seconds(history, kNoon_s + 300, kNoon_s + 590, report_of(2.0));
  add_seconds(history, kNoon_s + 10, kNoon_s + 590, report_of(2.0));  // back within its ten minutes
  add_seconds(history, kNoon_s + 86'400, kNoon_s + 86'410, report_of(2.0));
  add_seconds(history, kNoon_s - 5, kNoon_s + 5, report_of(2.0));
  history.add(report_of(2.0), UtcTime::max());
  history.add(report_of(2.0), UtcTime::min());
  const NodeEntries sent = read(history.farewell());
  ASSERT_EQ(sent.entries.size(), 4U);
  EXPECT_EQ(sent.entries[0].begin_utc_s, kNoon_s + 300);
  EXPECT_EQ(sent.entries[0].seconds, 300U);
  EXPECT_EQ(sent.entries[1].seconds, 10U);
  EXPECT_EQ(sent.entries[2].begin_utc_s, kNoon_s - 5);
  EXPECT_EQ(sent.entries[3].begin_utc_s, kNoon_s);
  EXPECT_EQ(sent.entries[3].seconds, 5U);
}

TEST(NodeHistory, AbsurdReportsAreNotCounted) {
  NodeHistory history("roof");
  for (const double wind : {-1.0, 1e9, std::numeric_limits<double>::quiet_NaN()})
    history.add(report_of(wind), utc(kNoon_s));
  history.add(report_of(1.0, std::numeric_limits<double>::infinity()), utc(kNoon_s));
  EXPECT_FALSE(history.farewell());
}

TEST(NodeHistory, KeepsADayAtMost) {
  NodeHistory history("roof");
  for (std::int64_t i = 0; i < 200; ++i) history.add(report_of(1.0), utc(kNoon_s + 600 * i));
  EXPECT_EQ(history.waiting(), NodeHistory::kMaxWaiting);
  const NodeEntries sent = read(history.due(kNow));
  EXPECT_EQ(sent.entries.size(), kMaxEntriesInMessage);
  EXPECT_EQ(sent.entries[0].begin_utc_s, kNoon_s + 600L * (199 - 144));
  // Some of those that are on their way are dropped meanwhile: no other entry is forgotten with the rest.
  for (std::int64_t i = 200; i < 210; ++i) history.add(report_of(1.0), utc(kNoon_s + 600 * i));
  history.take_reply(true, kNow + seconds(1));
  EXPECT_EQ(history.waiting(), 144U - 40U);
  EXPECT_EQ(read(history.due(kNow + seconds(1))).entries[0].begin_utc_s, sent.entries.back().begin_utc_s + 600);
}

TEST(NodeHistory, LongTextsFitIntoAMessage) {
  NodeHistory history("roof");
  NodeReport report = report_of(1.0, 0.0, {std::string(1000, '"')});
  report.software = report.part = std::string(1000, '\\');
  for (std::int64_t i = 0; i < 100; ++i) history.add(report, utc(kNoon_s + 600 * i));
  std::size_t stored = 0;
  while (history.waiting() > 0) {
    stored += read(history.due(kNow)).entries.size();
    history.take_reply(true, kNow);
  }
  EXPECT_EQ(stored, 99U);
  EXPECT_FALSE(history.due(kNow));
}

TEST(NodeHistory, WhatIsAcknowledgedIsForgotten_OneMessageAtATime) {
  NodeHistory history("roof");
  for (std::int64_t i = 0; i < 61; ++i) history.add(report_of(1.0), utc(kNoon_s + 600 * i));
  EXPECT_EQ(read(history.due(kNow)).entries.size(), 50U);
  EXPECT_FALSE(history.due(kNow + seconds(9)));
  history.take_reply(true, kNow + seconds(9));
  EXPECT_EQ(history.waiting(), 10U);
  history.take_reply(true, kNow + seconds(9));
  EXPECT_EQ(history.waiting(), 10U) << "nothing was on its way";
  EXPECT_EQ(read(history.due(kNow + seconds(9))).entries.size(), 10U);
  history.take_reply(true, kNow + seconds(10));
  EXPECT_EQ(history.waiting(), 0U);
  EXPECT_FALSE(history.due(kNow + seconds(1000)));
}

TEST(NodeHistory, WithoutAnAcknowledgementTheSameIsSentAgain_LaterEachTime) {
  NodeHistory history("roof");
  for (std::int64_t i = 0; i < 3; ++i) history.add(report_of(1.0), utc(kNoon_s + 600 * i));
  const auto first = history.due(kNow);
  ASSERT_TRUE(first);
  history.add(report_of(1.0), utc(kNoon_s + 1800));
  MonoTime at = kNow;
  for (const int wait_s : {10, 20, 40, 60, 60}) {
    history.take_reply(false, at);  // an error
    at += seconds(wait_s);
    EXPECT_FALSE(history.due(at - seconds(1))) << wait_s;
    EXPECT_EQ(history.due(at), first) << wait_s;
  }
  history.take_reply(true, at);
  EXPECT_EQ(history.waiting(), 1U);
  // A late acknowledgement of an earlier try.
  EXPECT_FALSE(history.due(at + seconds(9)));
  history.take_reply(true, at + seconds(9));
  EXPECT_EQ(history.waiting(), 1U);
  EXPECT_TRUE(history.due(at + seconds(10)));
}

TEST(NodeHistory, AConnectionHandsInWhatWaitsAndWhatIsUnfinished) {
  NodeHistory history("roof");
  history.note_connection(kNow);
  EXPECT_FALSE(history.due(kNow)) << "nothing was reported";
  add_seconds(history, kNoon_s, kNoon_s + 100, report_of(1.0));
  EXPECT_EQ(read(history.due(kNow)).entries.size(), 1U);
  history.take_reply(true, kNow);
  EXPECT_FALSE(history.due(kNow + seconds(100))) << "once";
  add_seconds(history, kNoon_s + 100, kNoon_s + 700, report_of(1.0));
  EXPECT_TRUE(history.due(kNow));
  EXPECT_TRUE(history.due(kNow + seconds(10)));
  EXPECT_FALSE(history.due(kNow + seconds(11)));
  history.note_connection(kNow + seconds(11));
  const NodeEntries again = read(history.due(kNow + seconds(11)));
  ASSERT_EQ(again.entries.size(), 1U) << "the same as before the connection was lost";
  EXPECT_EQ(again.entries[0].seconds, 600U);
  history.take_reply(true, kNow + seconds(12));
  const NodeEntries rest = read(history.due(kNow + seconds(22)));
  ASSERT_EQ(rest.entries.size(), 1U);
  EXPECT_EQ(rest.entries[0].begin_utc_s, kNoon_s + 600);
  EXPECT_EQ(rest.entries[0].seconds, 100U);
}

TEST(NodeHistory, AFarewellHasTheNewestEntries) {
  NodeHistory history("roof");
  EXPECT_FALSE(history.farewell());
  for (std::int64_t i = 0; i < 100; ++i) history.add(report_of(1.0), utc(kNoon_s + 600 * i));
  const NodeEntries last = read(history.farewell());
  EXPECT_EQ(last.entries.size(), 50U);
  EXPECT_EQ(last.entries.back().begin_utc_s, kNoon_s + 600L * 99);
}

TEST(NodeHistory, WhatIsNoHistoryIsRefused) {
  const auto with = [](const std::string& begin, const std::string& seconds_, const std::string& wind,
                       const std::string& rest = "") {
    return static_cast<bool>(decoded(
        R"({"node":"a","entries":[{"begin_utc_s":)" + begin + R"(,"seconds":)" + seconds_ + R"(,"mean_wind_m_s":)" +
            wind + R"(,"max_wind_m_s":1,"max_behind_s":0,"attention_s":0,"attention":"","software":"","part":""})" +
            rest + "]}",
        decode_node_entries));
  };
  EXPECT_TRUE(with("1796040000", "600", "1"));
  EXPECT_FALSE(with("1796040001", "600", "1")) << "crosses its ten minutes";
  EXPECT_FALSE(with("1796040000", "0", "1"));
  EXPECT_FALSE(with("1796040000", "4294967296", "1"));
  EXPECT_FALSE(with("600", "600", "1"));
  EXPECT_FALSE(with("18446744073709551600", "1", "1"));
  EXPECT_FALSE(with("-600", "1", "1"));
  EXPECT_FALSE(with("1796040000", "600", "-1"));
  EXPECT_FALSE(with("1796040000", "600", "1e300"));
  EXPECT_FALSE(with("1796040000", "600", "null"));
  EXPECT_FALSE(with("1796040000", "600", "1", ",7"));
  for (const char* const text : {"", "[1]", "{}", R"({"node":"","entries":[]})", R"({"node":"a","entries":[]})",
                                 R"({"node":"a","entries":{}})", "\xff"}) {
    EXPECT_FALSE(decoded(text, decode_node_entries)) << text;
  }
}

TEST(FleetHistory, AnEntryThatWasStoredTwiceCountsOnce) {
  FleetHistory history;
  const auto entry = [](std::int64_t begin_s, std::uint32_t length_s, double wind_m_s) {
    return HistoryEntry{
        .begin_utc_s = begin_s, .seconds = length_s, .mean_wind_m_s = wind_m_s, .max_wind_m_s = wind_m_s};
  };
  history.take({.node = "roof", .entries = {entry(kNoon_s, 100, 1.0), entry(kNoon_s - 600, 600, 4.0)}});
  history.take({.node = "roof", .entries = {entry(kNoon_s, 600, 2.0), entry(kNoon_s + 600, 200, 6.0)}});
  history.take({.node = "roof", .entries = {entry(kNoon_s, 300, 9.0)}});
  history.take({.node = "room", .entries = {entry(kNoon_s - 7L * 86'400, 600, 9.0)}});
  ASSERT_EQ(history.nodes().size(), 2U);
  const auto hours = hours_of(history.nodes().at("roof"), utc(kNoon_s + 1800));
  ASSERT_EQ(hours.size(), 24U);
  EXPECT_EQ(hours[23].begin_utc_s, kNoon_s);
  EXPECT_EQ(hours[23].seconds, 800U);
  EXPECT_NEAR(hours[23].mean_wind_m_s, 3.0, 1e-9);
  EXPECT_EQ(hours[23].max_wind_m_s, 6.0);
  EXPECT_EQ(hours[22].seconds, 600U);
  EXPECT_EQ(hours[21].seconds, 0U);
  for (const HistoryEntry& hour : hours_of(history.nodes().at("room"), utc(kNoon_s))) EXPECT_EQ(hour.seconds, 0U);
}

TEST(FleetHistory, IsBounded) {
  FleetHistory history;
  for (int node = 0; node < 1100; ++node)
    history.take({.node = std::to_string(node), .entries = {{.begin_utc_s = kNoon_s, .seconds = 1}}});
  EXPECT_EQ(history.nodes().size(), Fleet::kMaxNodes);
  for (std::int64_t i = 0; i < 1100; ++i)
    history.take({.node = "7", .entries = {{.begin_utc_s = kNoon_s + i, .seconds = 1}}});
  EXPECT_EQ(history.nodes().at("7").size(), FleetHistory::kMaxEntriesOfNode);
}

TEST(HistoryStream, RepliesOfJetStreamAreRead) {
  const auto stored = decoded(R"({"stream":"yuragi_wind", "seq":3})", decode_stream_reply);
  ASSERT_TRUE(stored);
  EXPECT_TRUE(stored->is_success());
  EXPECT_EQ(stored->kind, StreamReply::Kind::kStored);
  const auto refused =
      decoded(R"({"error":{"code":503,"description":"no space"},"stream":"a","seq":0})", decode_stream_reply);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->error, 503U);
  EXPECT_EQ(refused->trouble, "no space");
  const auto reads =
      decoded(R"({"type":"io.nats.jetstream.api.v1.consumer_create_response","name":"ScUlwcTB","num_pending":5})",
              decode_stream_reply);
  ASSERT_TRUE(reads);
  EXPECT_EQ(reads->messages, 5U);
  EXPECT_EQ(reads->reader, "ScUlwcTB");
  for (const char* const text :
       {"", "{", "[]", "{}", R"({"stream":"a","seq":0})", R"({"stream":7,"seq":1})", R"({"error":7})",
        R"({"type":"io.nats.jetstream.api.v1.consumer_create_response","name":"a.>","num_pending":5})",
        R"({"type":"io.nats.jetstream.api.v1.consumer_create_response","name":"a","num_pending":-5})",
        R"({"type":"io.nats.jetstream.api.v1.stream_info_response"})"}) {
    EXPECT_FALSE(decoded(text, decode_stream_reply)) << text;
  }
  EXPECT_EQ(history_stream_of("museum.roof-2"), "yuragi_museum_roof-2");
}

struct Sent {
  std::vector<StreamRequest> all;
  HistoryStream stream{"wind", [this](const StreamRequest& request) { all.push_back(request); }};
  std::string last() const { return all.empty() ? "" : all.back().subject; }
};

TEST(HistoryStream, IsAskedForAgain_OnceAMinuteAtLast) {
  Sent sent;
  sent.stream.advance(kNow);
  EXPECT_TRUE(sent.all.empty()) << "it does not lead";
  sent.stream.begin("_INBOX.a", kNow);
  for (int i = 0; i <= 3600; ++i) sent.stream.advance(kNow + seconds(i));
  EXPECT_EQ(sent.last(), "$JS.API.STREAM.CREATE.yuragi_wind");
  EXPECT_GE(sent.all.size(), 60U);
  EXPECT_LE(sent.all.size(), 66U);
}

TEST(HistoryStream, IsMadeWithFewerReplicasWithoutACluster_AndReadOnce) {
  Sent sent;
  sent.stream.begin("_INBOX.a", kNow);
  sent.stream.advance(kNow);
  EXPECT_NE(std::string(sent.all.back().bytes.begin(), sent.all.back().bytes.end()).find(R"("num_replicas":3)"),
            std::string::npos);
  sent.stream.take_reply({.kind = StreamReply::Kind::kMade, .error = 10074, .trouble = "no cluster"}, kNow);
  sent.stream.advance(kNow);
  EXPECT_NE(std::string(sent.all.back().bytes.begin(), sent.all.back().bytes.end()).find(R"("num_replicas":1)"),
            std::string::npos);
  sent.stream.take_reply({.kind = StreamReply::Kind::kMade}, kNow);
  sent.stream.advance(kNow);
  EXPECT_EQ(sent.last(), "$JS.API.CONSUMER.CREATE.yuragi_wind");
  sent.stream.note_message(kNow);  // before the reply
  sent.stream.take_reply({.kind = StreamReply::Kind::kReads, .reader = "abc", .messages = 2}, kNow);
  EXPECT_EQ(sent.all.size(), 3U);
  sent.stream.note_message(kNow);
  EXPECT_EQ(sent.last(), "$JS.API.CONSUMER.DELETE.yuragi_wind.abc");
  for (int i = 0; i < 100; ++i) sent.stream.advance(kNow + seconds(i));
  EXPECT_EQ(sent.all.size(), 4U);
  sent.stream.begin("_INBOX.a", kNow + seconds(100));
  sent.stream.advance(kNow + seconds(100));
  EXPECT_EQ(sent.last(), "$JS.API.STREAM.CREATE.yuragi_wind") << "it leads anew";
}

TEST(HistoryStream, ReadingThatStopsIsEnded) {
  Sent sent;
  sent.stream.begin("_INBOX.a", kNow);
  sent.stream.advance(kNow);
  sent.stream.take_reply({.kind = StreamReply::Kind::kMade, .error = 10058, .trouble = "other settings"}, kNow);
  sent.stream.advance(kNow);
  sent.stream.take_reply({.kind = StreamReply::Kind::kReads, .reader = "abc", .messages = 5}, kNow);
  sent.stream.advance(kNow + seconds(10));
  EXPECT_EQ(sent.last(), "$JS.API.CONSUMER.CREATE.yuragi_wind");
  sent.stream.advance(kNow + seconds(11));
  EXPECT_EQ(sent.last(), "$JS.API.CONSUMER.DELETE.yuragi_wind.abc");
}

}  // namespace
}  // namespace yuragi::daemon::follow
