#include "daemon/feeds/osc_feed.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/feeds/feeds.hpp"
#include "daemon/feeds/osc_addresses.hpp"
#include "drivers/bus/osc_message.hpp"
#include "tests/daemon/feeds/receiver.hpp"

namespace yuragi::daemon::feeds {
namespace {

using drivers::bus::OscMessage;
using settings::feeds::Osc;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using values::Quantity;

std::vector<OscMessage> messages_to(Receiver& receiver) {
  std::vector<OscMessage> all;
  for (const auto& datagram : receiver.datagrams()) {
    auto decoded = drivers::bus::decode_osc(datagram);
    if (!decoded) continue;
    for (OscMessage& message : *decoded) all.push_back(std::move(message));
  }
  return all;
}

std::map<std::string, int> counts_of(const std::vector<OscMessage>& messages) {
  std::map<std::string, int> counts;
  for (const OscMessage& message : messages) ++counts[message.address];
  return counts;
}

values::Moment moment_at(double time_s) {
  values::Moment moment;
  static const auto kNames = std::make_shared<const values::Names>(
      values::Names{.sensors = {"a b/\u00fc"}, .places = {"door"}, .scenes = {"meadow"}});
  moment.names = kNames;
  moment.time_s = time_s;
  moment.mono = MonoTime(from_seconds(1000.0 + time_s));
  moment.utc = UtcTime(std::chrono::seconds(1'700'000'000));
  moment.shaped[Quantity::kSpeed] = 6.0;
  moment.shaped[Quantity::kDirection] = 270.0;
  moment.real[Quantity::kSpeed] = 12.0;
  moment.sensors = {{.speed_m_s = 7.5, .age_s = 0.25, .state = wind::judging::SensorState::kLive}};
  moment.shaped_places.resize(1);
  moment.opacities = {1.0};
  return moment;
}

/// Sends a second of moments, 60 of them.
void send_a_second(Feed& feed) {
  for (int i = 0; i < 60; ++i) feed.send(moment_at(i / 60.0));
}

TEST(OscFeedTest, SendsTheWindFirstThenItsValues) {
  Receiver receiver;
  const auto feed = make_osc_feed({.name = "a", .to = receiver.address(), .send = "wind"});
  feed->send(moment_at(0.0));
  const std::vector<OscMessage> messages = messages_to(receiver);
  ASSERT_EQ(messages.size(), 1U + values::kQuantityCount + 1U);
  EXPECT_EQ(messages[0].address, "/wind");
  EXPECT_THAT(messages[0].numbers, ElementsAre(6.0, 270.0));
  EXPECT_EQ(messages[1].address, "/wind/speed");
  EXPECT_EQ(messages.back().address, "/wind/state");
  EXPECT_EQ(messages[0].meant_for, std::nullopt) << "at once";
  EXPECT_EQ(feed->status().messages, 1U);
  EXPECT_THAT(feed->status().trouble, IsEmpty());
}

TEST(OscFeedTest, EachMessageComesAtItsRate) {
  Receiver receiver;
  const auto feed = make_osc_feed(
      {.name = "a", .to = receiver.address(), .rate_hz = 30.0, .send = "wind sensors places scenes", .prefix = "/y"});
  send_a_second(*feed);
  std::map<std::string, int> counts = counts_of(messages_to(receiver));
  EXPECT_EQ(counts["/y/wind"], 30);
  EXPECT_EQ(counts["/y/place/door"], 30);
  EXPECT_EQ(counts["/y/place/door/gust_norm"], 30);
  EXPECT_EQ(counts["/y/sensor/a_b__/speed"], 10);
  EXPECT_EQ(counts["/y/sensor/a_b__/direction"], 0) << "it sends none";
  EXPECT_EQ(counts["/y/sensor/a_b__/state"], 1);
  EXPECT_EQ(counts["/y/scene/meadow/opacity"], 1) << "it does not change";
}

TEST(OscFeedTest, TheRealWindIsSentIfItIsWanted) {
  Receiver receiver;
  const auto feed = make_osc_feed({.name = "a", .to = receiver.address(), .send = "wind", .wind = values::Wind::kReal});
  feed->send(moment_at(0.0));
  EXPECT_THAT(messages_to(receiver).at(0).numbers, ElementsAre(12.0, 0.0));
}

settings::feeds::OscMap map_of(std::string value, settings::feeds::Span from, settings::feeds::Span to) {
  return {.value_text = value,
          .address = "/layer/opacity",
          .given_from = {},
          .from = from,
          .to = to,
          .value = values::Reference::parse(value).value()};
}

TEST(OscFeedTest, AMappedValueIsBroughtIntoItsRange) {
  Receiver receiver;
  Osc config{.name = "a", .to = receiver.address(), .send = "mapped"};
  config.maps = {map_of("speed", {0.0, 12.0}, {0.2, 1.0}), map_of("speed", {0.0, 3.0}, {1.0, 0.0})};
  config.maps.push_back(config.maps.front());
  config.maps.back().curve = 2.0;
  const auto feed = make_osc_feed(config);
  feed->send(moment_at(0.0));
  const std::vector<OscMessage> messages = messages_to(receiver);
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_NEAR(*messages[0].numbers.at(0), 0.6, 1e-6);
  EXPECT_NEAR(*messages[1].numbers.at(0), 0.0, 1e-6) << "limited";
  EXPECT_NEAR(*messages[2].numbers.at(0), 0.4, 1e-6);
}

TEST(OscFeedTest, ASmoothedValueApproachesAStep) {
  Receiver receiver;
  Osc config{.name = "a", .to = receiver.address(), .send = "mapped"};
  config.maps = {map_of("speed", {0.0, 10.0}, {0.0, 10.0})};
  config.maps[0].smooth_s = 0.5;
  const auto feed = make_osc_feed(config);
  for (int i = 0; i <= 31; ++i) {
    values::Moment moment = moment_at(i / 60.0);
    moment.shaped[Quantity::kSpeed] = i == 0 ? 0.0 : 10.0;
    feed->send(moment);
  }
  // From the second moment on, half a second.
  EXPECT_NEAR(*messages_to(receiver).back().numbers.at(0), 10.0 * (1.0 - std::exp(-1.0)), 0.15);
}

TEST(OscFeedTest, ACueHasNoArguments) {
  Receiver receiver;
  Osc config{.name = "a", .to = receiver.address(), .send = "mapped"};
  config.cues = {{.when = settings::feeds::OscCondition::kWindAbove, .speed_m_s = 5.0, .address = "/cue/gust/go"}};
  const auto feed = make_osc_feed(config);
  send_a_second(*feed);
  const std::vector<OscMessage> messages = messages_to(receiver);
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].address, "/cue/gust/go");
  EXPECT_THAT(messages[0].numbers, IsEmpty());
}

TEST(OscFeedTest, WithoutBundlesEachMessageIsADatagram) {
  Receiver receiver;
  const auto feed = make_osc_feed({.name = "a", .to = receiver.address(), .send = "wind", .bundles = false});
  feed->send(moment_at(0.0));
  EXPECT_EQ(receiver.datagrams().size(), 2U + values::kQuantityCount);
}

TEST(OscFeedTest, ATimeTagIsTheTimeOfTheTick) {
  Receiver receiver;
  const auto feed = make_osc_feed({.name = "a", .to = receiver.address(), .send = "wind", .time_tags = true});
  feed->send(moment_at(0.0));
  EXPECT_EQ(messages_to(receiver).at(0).meant_for, UtcTime(std::chrono::seconds(1'700'000'000)));
}

TEST(OscFeedTest, LongBundlesAreDividedBetweenDatagrams) {
  Receiver receiver;
  const auto feed = make_osc_feed({.name = "a", .to = receiver.address(), .send = "places"});
  values::Moment moment = moment_at(0.0);
  values::Names names;
  for (int i = 0; i < 64; ++i) names.places.push_back("place " + std::to_string(i));
  moment.names = std::make_shared<const values::Names>(names);
  moment.shaped_places.resize(64);
  feed->send(moment);
  const auto datagrams = receiver.datagrams();
  EXPECT_GT(datagrams.size(), 10U);
  std::size_t messages = 0;
  for (const auto& datagram : datagrams) {
    EXPECT_LE(datagram.size(), 1400U);
    messages += drivers::bus::decode_osc(datagram)->size();
  }
  EXPECT_EQ(messages, 64U * (1U + values::kQuantityCount));
}

TEST(OscFeedTest, AReceiverThatIsGoneIsATroubleUntilItIsBack) {
  std::string address;
  {
    const Receiver gone;
    address = gone.address();
  }
  const auto feed = make_osc_feed({.name = "a", .to = address, .send = "wind"});
  // The system reports the refusal with one of the next datagrams.
  for (int i = 0; i < 10'000 && feed->status().trouble.empty(); ++i) feed->send(moment_at(i / 60.0));
  EXPECT_THAT(feed->status().trouble, HasSubstr("nothing listens at " + address));
}

TEST(OscAddressesTest, KeepOnlyWhatEveryReceiverTakes) {
  EXPECT_EQ(osc_part_of("a b/\u00fc"), "a_b__");
  EXPECT_EQ(osc_part_of("Roof_2-north"), "Roof_2-north");
  EXPECT_THAT(osc_parts_of({"a b", "a_b", "a/b"}), ElementsAre("a_b", "a_b_2", "a_b_3"));
}

/// Waits for the thread, which publishes its status every half second of the moments' time.
std::vector<Status> status_of(Feeds& feeds, std::size_t count, double& time_s) {
  std::vector<Status> status;
  while (status.size() != count || (count > 0 && status[0].messages == 0)) {
    feeds.publish(std::make_shared<const values::Moment>(moment_at(time_s += 0.6)));
    std::this_thread::yield();
    status = feeds.status();
  }
  return status;
}

TEST(FeedsTest, GoOnIfTheirConfigurationStaysTheSame) {
  Receiver receiver, other;
  const Osc one{.name = "one", .to = receiver.address(), .send = "wind"};
  const Osc two{.name = "two", .to = other.address(), .send = "wind"};
  settings::feeds::Config config;
  Feeds feeds(config);
  EXPECT_TRUE(feeds.is_empty());
  config.osc = {one};
  feeds.change(config);
  double time_s = 0.0;
  const std::uint64_t before = status_of(feeds, 1, time_s)[0].messages;
  config.osc = {one, two};
  feeds.change(config);
  const std::vector<Status> both = status_of(feeds, 2, time_s);
  EXPECT_GT(both[0].messages, before) << "not begun anew";
  EXPECT_EQ(both[1].name, "two");
  config.osc = {};
  feeds.change(config);
  EXPECT_TRUE(feeds.is_empty());
  EXPECT_THAT(messages_to(receiver), Not(IsEmpty()));
}

}  // namespace
}  // namespace yuragi::daemon::feeds
