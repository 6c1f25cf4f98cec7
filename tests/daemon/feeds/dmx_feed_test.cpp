#include "daemon/feeds/dmx_feed.hpp"

#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/multicast.hpp>
#include <boost/asio/ip/udp.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/feeds/component_id.hpp"
#include "daemon/feeds/dmx_rest.hpp"
#include "tests/daemon/feeds/receiver.hpp"

namespace yuragi::daemon::feeds {
namespace {

using settings::feeds::Dmx;
using settings::feeds::DmxChannel;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using values::Quantity;

// Octets of an E1.31 data packet.
constexpr std::size_t kSequence = 111, kOptions = 112, kUniverse = 114, kLevels = 126;
constexpr double kTick_s = 1.0 / 60.0;

values::Moment moment_at(double time_s, double speed_m_s, double openness = 1.0) {
  values::Moment moment;
  moment.time_s = time_s;
  moment.mono = MonoTime(from_seconds(1000.0 + time_s));
  moment.shaped[Quantity::kSpeed] = speed_m_s;
  moment.openness = openness;
  return moment;
}

/// Channel 1: the speed from 0 to 10 m/s; at rest 3.
Dmx feed_to(const Receiver& receiver) {
  Dmx feed{.name = "hall", .to = receiver.address()};
  feed.channels = {{.channel = 1,
                    .from = {0.0, 10.0},
                    .to = {0.0, 255.0},
                    .rest = 3.0,
                    .value = values::Reference::parse("speed").value()}};
  return feed;
}

std::vector<int> bytes_at(const std::vector<Receiver::Datagram>& packets, std::size_t at) {
  std::vector<int> bytes;
  for (const auto& packet : packets) bytes.push_back(packet.at(at));
  return bytes;
}

TEST(DmxFeedTest, SendsAtMost44TimesASecondWhileSomethingChanges) {
  Receiver receiver;
  const auto feed = make_dmx_feed(feed_to(receiver));
  std::vector<Receiver::Datagram> packets;
  for (int i = 0; i < 600; ++i) {
    feed->send(moment_at(i * kTick_s, (i % 100) * 0.1));
    for (auto& packet : receiver.datagrams()) packets.push_back(std::move(packet));
  }
  EXPECT_GE(packets.size(), 430U);
  EXPECT_LE(packets.size(), 441U);
  for (std::size_t i = 1; i < packets.size(); ++i)
    EXPECT_EQ(packets[i][kSequence], (packets[i - 1][kSequence] + 1) % 256);
  EXPECT_EQ(feed->status().messages, packets.size());
  EXPECT_EQ(feed->status().sends, "1 channel");
  EXPECT_THAT(feed->status().trouble, IsEmpty());
}

TEST(DmxFeedTest, WhatDoesNotChangeIsRepeatedEachSecond) {
  Receiver receiver;
  const auto feed = make_dmx_feed(feed_to(receiver));
  for (int i = 0; i < 600; ++i) feed->send(moment_at(i * kTick_s, 5.0));
  const auto packets = receiver.datagrams();
  EXPECT_THAT(packets, SizeIs(testing::AllOf(testing::Ge(13U), testing::Le(16U)))) << "four at first";
  EXPECT_THAT(bytes_at(packets, kLevels), Each(128));
}

TEST(DmxFeedTest, EndsAtRestAndSaysSo) {
  Receiver receiver;
  const auto feed = make_dmx_feed(feed_to(receiver));
  feed->send(moment_at(0.0, 10.0));
  feed->finish();
  const auto packets = receiver.datagrams();
  EXPECT_THAT(bytes_at(packets, kLevels), ElementsAre(255, 3, 3, 3, 3, 3, 3));
  EXPECT_THAT(bytes_at(packets, kOptions), ElementsAre(0, 0, 0, 0, 0x40, 0x40, 0x40));
}

TEST(DmxFeedTest, OutsideOfTheHoursItIsAtRestAndSilent) {
  Receiver receiver;
  Dmx config = feed_to(receiver);
  config.channels[0].slew_s = 0.2;
  const auto feed = make_dmx_feed(config);
  int tick = 0;
  const auto send_a_second = [&](double openness) {
    for (int i = 0; i < 60; ++i) feed->send(moment_at(tick++ * kTick_s, 10.0, openness));
    return receiver.datagrams();
  };
  EXPECT_EQ(send_a_second(1.0).back()[kLevels], 255);
  const auto closing = send_a_second(0.0);
  EXPECT_GT(closing.front()[kLevels], 100) << "slowly";
  ASSERT_GT(closing.size(), 6U);
  EXPECT_THAT(bytes_at({closing.end() - 6, closing.end()}, kLevels), Each(3));
  EXPECT_THAT(bytes_at({closing.end() - 6, closing.end()}, kOptions), ElementsAre(0, 0, 0, 0x40, 0x40, 0x40));
  EXPECT_THAT(send_a_second(0.0), IsEmpty());
  feed->finish();
  EXPECT_THAT(receiver.datagrams(), IsEmpty()) << "it has ended already";
  EXPECT_EQ(send_a_second(1.0).back()[kLevels], 255) << "it opens again";
}

TEST(DmxFeedTest, AGridIsSentInItsUniverses) {
  Receiver receiver;
  Dmx config = feed_to(receiver);
  config.channels.clear();
  config.universe = 7;
  config.grids = {{.grid = {.columns = 171, .rows = 1}, .from = {0.0, 10.0}}};
  const auto feed = make_dmx_feed(config);
  values::Moment moment = moment_at(0.0, 0.0);
  moment.names = std::make_shared<const values::Names>(values::Names{.grids = {config.grids[0].grid}});
  moment.grids = {std::vector<double>(171, 0.0)};
  moment.grids[0][170] = 10.0;
  feed->send(moment);
  const auto packets = receiver.datagrams();
  EXPECT_THAT(bytes_at(packets, kUniverse), ElementsAre(7, 8));
  EXPECT_THAT(bytes_at(packets, kLevels), ElementsAre(0, 255));
  EXPECT_EQ(feed->status().sends, "0 channels, 171 pixels");
}

TEST(DmxFeedTest, ArtNetIsSentToAHost) {
  Receiver receiver;
  Dmx config = feed_to(receiver);
  config.protocol = settings::feeds::DmxProtocol::kArtNet;
  config.universe = 0x0102;
  const auto feed = make_dmx_feed(config);
  feed->send(moment_at(0.0, 10.0));
  feed->finish();
  const auto packets = receiver.datagrams();
  EXPECT_THAT(bytes_at(packets, 18), ElementsAre(255, 3, 3, 3)) << "nothing says that it is the end";
  EXPECT_THAT(bytes_at(packets, 12), ElementsAre(1, 2, 3, 4)) << "sequence";
  EXPECT_THAT(bytes_at(packets, 14), Each(0x02));
  EXPECT_THAT(bytes_at(packets, 15), Each(0x01));
}

TEST(DmxTargetTest, AUniverseHasItsMulticastAddress) {
  Dmx feed{.universe = 0x0102, .to = std::string(settings::feeds::kDmxMulticast)};
  EXPECT_EQ(feed.target(0), "239.255.1.2:5568");
  EXPECT_EQ(feed.target(1), "239.255.1.3:5568");
  feed.to = "lamps";
  EXPECT_EQ(feed.target(1), "lamps:5568");
  feed.protocol = settings::feeds::DmxProtocol::kArtNet;
  EXPECT_EQ(feed.target(0), "lamps:6454");
}

TEST(DmxRestTest, SendsMoreThanAReceiverDiscardsAndThenTheEnd) {
  Receiver receiver;
  const Dmx config = feed_to(receiver);
  DmxRest rest(config);
  int steps = 0;
  for (; !rest.is_over() && steps < 10'000; ++steps) rest.step(MonoTime(std::chrono::milliseconds(23 * steps)));
  const auto packets = receiver.datagrams();
  ASSERT_THAT(packets, SizeIs(28));
  EXPECT_THAT(bytes_at(packets, kLevels), Each(3));
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i][kSequence], i + 1);
    EXPECT_EQ(packets[i][kOptions], i < 25 ? 0 : 0x40);
    const ComponentId component = component_id_of(machine_id(), "hall");
    EXPECT_TRUE(std::equal(component.begin(), component.end(), packets[i].begin() + 22));
  }
  EXPECT_THAT(rest.trouble(), IsEmpty());
}

}  // namespace
}  // namespace yuragi::daemon::feeds
