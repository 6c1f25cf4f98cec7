#include "daemon/follow/fleet.hpp"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace yuragi::daemon::follow {
namespace {

const MonoTime kNow{std::chrono::hours(3)};

NodeReport report_of(const std::string& name, std::vector<std::string> attention = {}) {
  return {.name = name,
          .software = "yuragi 1",
          .part = "leads",
          .wind_m_s = 4.5,
          .wind_from_deg = 240.0,
          .tick = 107'000'000'000,
          .behind_s = 0.01,
          .clock_offset_s = -0.002,
          .attention = std::move(attention)};
}

Result<NodeReport, Failure> decoded(std::string_view text) {
  return decode_node_report(std::vector<std::uint8_t>(text.begin(), text.end()));
}

TEST(Fleet, ListsEachNodeByItsName_WithItsLastWord) {
  Fleet fleet;
  fleet.take(report_of("room 3"), kNow);
  fleet.take(report_of("roof"), kNow + std::chrono::seconds(1));
  NodeReport again = report_of("room 3");
  again.tick += 60;
  fleet.take(again, kNow + std::chrono::seconds(2));
  const std::vector<Node> nodes = fleet.nodes(kNow + std::chrono::seconds(7));
  ASSERT_EQ(nodes.size(), 2U);
  EXPECT_EQ(nodes[0].report.name, "roof");
  EXPECT_TRUE(nodes[0].is_silent);
  EXPECT_EQ(nodes[1].report.tick, again.tick);
  EXPECT_EQ(nodes[1].last_word_s, 5.0);
  EXPECT_FALSE(nodes[1].is_silent);
}

TEST(Fleet, SilenceAndWhatNeedsAttentionElsewhereAreNews) {
  Fleet fleet;
  fleet.take(report_of("roof", {"what others have"}), kNow + std::chrono::minutes(2));
  fleet.take(report_of("room 1"), kNow + std::chrono::minutes(2));
  fleet.take(report_of("room 2"), kNow);
  fleet.take(report_of("room 3", {"sensor mast is silent", "more"}), kNow + std::chrono::minutes(2));
  EXPECT_EQ(fleet.attention("roof", kNow + std::chrono::minutes(2)),
            (std::vector<std::string>{"node room 2: no word for 2 min: is the machine on, and its network?",
                                      "node room 3: sensor mast is silent"}));
}

TEST(Fleet, ManySentencesAreCountedAndAGoneNodeIsForgotten) {
  Fleet fleet;
  for (int i = 0; i < 1'200; ++i) fleet.take(report_of("node " + std::to_string(i)), kNow);
  EXPECT_EQ(fleet.nodes(kNow).size(), Fleet::kMaxNodes);
  const auto sentences = fleet.attention("", kNow + std::chrono::hours(1), 3);
  ASSERT_EQ(sentences.size(), 4U);
  EXPECT_EQ(sentences.back(), "and 997 more nodes: see `yuragi fleet`");
  fleet.take(report_of("roof"), kNow + std::chrono::hours(24 * 8));
  EXPECT_EQ(fleet.nodes(kNow + std::chrono::hours(24 * 8)).size(), 1U);
}

TEST(Fleet, LearnsOfANodeByAnAge_ButWhatWasHeardIsNewer) {
  Fleet fleet;
  fleet.take(report_of("roof"), kNow);
  fleet.learn(report_of("roof", {"old"}), std::chrono::minutes(10), kNow);
  fleet.learn(report_of("room 1"), std::chrono::hours(5), kNow);
  fleet.learn(report_of("room 1"), std::chrono::hours(8), kNow);
  fleet.learn(report_of("room 2"), std::chrono::hours(24 * 8), kNow);
  fleet.learn(report_of("room 2"), std::chrono::hours(-1), kNow);
  const std::vector<Node> nodes = fleet.nodes(kNow);
  ASSERT_EQ(nodes.size(), 2U);
  EXPECT_FALSE(nodes[0].is_silent);
  EXPECT_TRUE(nodes[0].report.attention.empty());
  EXPECT_TRUE(nodes[1].is_silent);
  EXPECT_EQ(nodes[1].last_word_s, 5.0 * 3600.0);
}

TEST(Fleet, AReportIsReadAsItWasWritten_AndPrintable) {
  const auto read = decode_node_report(encode(report_of("room\n3", {"a", "b\x1b"})));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->name, "room?3");
  EXPECT_EQ(read->tick, 107'000'000'000U);
  EXPECT_EQ(read->wind_m_s, 4.5);
  EXPECT_EQ(read->clock_offset_s, -0.002);
  EXPECT_EQ(read->attention, (std::vector<std::string>{"a", "b?"}));
}

TEST(Fleet, WhatIsNoReportIsRefused) {
  const auto with = [](std::string_view node, std::string_view wind, std::string_view tick) {
    return decoded(R"({"node":)" + std::string(node) + R"(,"software":"y","part":"p","wind_m_s":)" + std::string(wind) +
                   R"(,"wind_from_deg":1,"tick":)" + std::string(tick) + R"(,"behind_s":0,"attention":[]})");
  };
  EXPECT_TRUE(with("\"a\"", "1", "5"));
  EXPECT_FALSE(with("\"\"", "1", "5"));
  EXPECT_FALSE(with("7", "1", "5"));
  EXPECT_FALSE(with("\"" + std::string(301, 'a') + "\"", "1", "5"));
  EXPECT_FALSE(with("\"a\"", "1e300", "5"));
  EXPECT_FALSE(with("\"a\"", "1", "-5"));
  EXPECT_FALSE(decoded("[1]"));
  EXPECT_FALSE(decoded(""));
}

TEST(Fleet, ALongListIsSentInParts) {
  std::vector<Node> nodes(120);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].report = report_of("node " + std::to_string(i));
  nodes[119].is_silent = true;
  nodes[119].last_word_s = 60.0;
  std::size_t count = 0;
  for (const NodeList& part : parts_of(nodes)) {
    const auto read = decode_node_list(list_bytes(part));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->all, 120U);
    EXPECT_EQ(read->first, count);
    count += read->nodes.size();
    if (count == 120U) {
      EXPECT_TRUE(read->nodes.back().is_silent);
      EXPECT_EQ(read->nodes.back().last_word_s, 60.0);
    }
  }
  EXPECT_EQ(count, 120U);
  EXPECT_EQ(parts_of({}).size(), 1U) << "an empty list is a reply, too";
}

}  // namespace
}  // namespace yuragi::daemon::follow
