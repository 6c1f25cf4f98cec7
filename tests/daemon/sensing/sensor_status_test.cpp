#include "daemon/sensing/sensor_status.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::sensing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

SensorFacts roof_that_speaks() {
  SensorFacts facts{.name = "roof", .driver = "modbus", .evidence = {}};
  facts.evidence.link = wind::LinkState::kConnected;
  facts.evidence.link_detail = "answers at 10.0.0.5:502";
  wind::Reading reading;
  reading.speed_m_s = 4.5;
  reading.direction_deg = 192.0;
  reading.gust_m_s = 6.0;
  facts.evidence.report = {.health = wind::SourceHealth::kLive, .interval_s = 1.0, .age_s = 0.4, .last = reading};
  reading.speed_m_s = 3.0;
  reading.direction_deg = 180.0;
  facts.last_raw = reading;
  facts.counts = {.readings = 12, .frames = 15, .reconnects = 2};
  return facts;
}

TEST(SensorStatus, TellsTheLastReadingAsItIsAndAsItWasSaid) {
  const wire::SensorStatus status = sensor_status(roof_that_speaks());
  EXPECT_EQ(status.name, "roof");
  EXPECT_EQ(status.driver, "modbus");
  EXPECT_EQ(status.link, wind::LinkState::kConnected);
  EXPECT_EQ(status.health, wind::SourceHealth::kLive);
  EXPECT_EQ(status.detail, "answers at 10.0.0.5:502");
  EXPECT_EQ(status.speed_m_s, 4.5);
  EXPECT_EQ(status.direction_deg, 192.0);
  EXPECT_EQ(status.gust_m_s, 6.0);
  EXPECT_FALSE(status.simulated);
  EXPECT_EQ(status.raw_speed_m_s, 3.0);
  EXPECT_EQ(status.raw_direction_deg, 180.0);
  EXPECT_EQ(status.age_s, 0.4);
  EXPECT_EQ(status.interval_s, 1.0);
  EXPECT_EQ(status.readings, 12U);
  EXPECT_EQ(status.frames, 15U);
  EXPECT_EQ(status.reconnects, 2U);
  EXPECT_FALSE(status.replayed);
  EXPECT_EQ(status.state, wind::judging::SensorState::kLive);
  EXPECT_EQ(status.state_reason, "a reading every 1 s");
  EXPECT_THAT(status.refused, IsEmpty());
}

TEST(SensorStatus, OfASensorThatHasSaidNothingThereIsNoReading) {
  const wire::SensorStatus status = sensor_status({.name = "roof", .driver = "nmea", .evidence = {}});
  EXPECT_FALSE(status.speed_m_s || status.direction_deg || status.gust_m_s);
  EXPECT_FALSE(status.raw_speed_m_s || status.raw_direction_deg);
  EXPECT_EQ(status.health, wind::SourceHealth::kSilent);
  EXPECT_EQ(status.state, wind::judging::SensorState::kConnecting);
  EXPECT_EQ(status.state_reason, "looking for the device");
}

TEST(SensorStatus, TellsWhatWasRefusedByItsReasonAndNothingOfTheRest) {
  SensorFacts facts = roof_that_speaks();
  facts.counts.refused[static_cast<std::size_t>(drivers::decode::Refusal::kImplausible)] = 3;
  facts.counts.not_believed = 4;
  facts.counts.lost = 5;
  EXPECT_THAT(sensor_status(facts).refused,
              ElementsAre(Pair(std::string(name_of(drivers::decode::Refusal::kImplausible)), 3), Pair("rejected", 4),
                          Pair("lost", 5)));
}

TEST(SensorStatus, WhatIsMadeUpOrPlayedIsMarked) {
  SensorFacts facts = roof_that_speaks();
  facts.evidence.report.last->quality = wind::ReadingQuality::kSimulated;
  EXPECT_TRUE(sensor_status(facts).simulated);
  EXPECT_EQ(sensor_status(facts).state, wind::judging::SensorState::kSimulated);
  facts.evidence.report.last->quality = wind::ReadingQuality::kGood;
  facts.evidence.is_replay = true;
  EXPECT_TRUE(sensor_status(facts).replayed);
  EXPECT_EQ(sensor_status(facts).state, wind::judging::SensorState::kReplayed);
}

TEST(SensorStatus, TheFallbackIsReplayedOnceItSpeaksAndSaysWhyItPlays) {
  const LinkReport link{.state = wind::LinkState::kConnected, .detail = "plays calm.windlog"};
  const wind::SourceReport report = roof_that_speaks().evidence.report;
  const wire::SensorStatus begins = fallback_status("fall-back", "windlog", link, {}, 0);
  EXPECT_EQ(begins.state, wind::judging::SensorState::kConnecting);
  EXPECT_TRUE(begins.replayed);
  EXPECT_FALSE(begins.speed_m_s);

  const wire::SensorStatus plays = fallback_status("fall-back", "windlog", link, report, 7);
  EXPECT_EQ(plays.name, "fall-back");
  EXPECT_EQ(plays.driver, "windlog");
  EXPECT_EQ(plays.state, wind::judging::SensorState::kReplayed);
  EXPECT_EQ(plays.speed_m_s, 4.5);
  EXPECT_EQ(plays.readings, 7U);
  EXPECT_EQ(plays.detail, "all sensors are silent: plays calm.windlog");
  EXPECT_EQ(plays.state_reason, plays.detail);
}

}  // namespace
}  // namespace yuragi::daemon::sensing
