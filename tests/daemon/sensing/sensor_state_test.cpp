#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/sensing/sensor_diagnosis.hpp"

namespace yuragi::daemon::sensing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A sensor that is well.
SensorEvidence well() {
  SensorEvidence evidence;
  evidence.link = wind::LinkState::kConnected;
  evidence.link_detail = "answers at 10.0.0.5:502";
  wind::Reading reading;
  reading.speed_m_s = 3.42;
  evidence.report = {.health = wind::SourceHealth::kLive, .interval_s = 1.0, .age_s = 0.4, .last = reading};
  return evidence;
}

std::string reason(const SensorEvidence& evidence) {
  return reason_of(state_of(evidence), evidence);
}

TEST(SensorState, ASensorThatSpeaksIsLive) {
  EXPECT_EQ(state_of(well()), wind::judging::SensorState::kLive);
  EXPECT_EQ(reason(well()), "a reading every 1 s");
}

TEST(SensorState, BeforeItsFirstReadingItIsConnecting) {
  SensorEvidence evidence;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kConnecting);
  EXPECT_EQ(reason(evidence), "looking for the device");
  evidence.link_detail = "/dev/ttyUSB0 is not there: plug it in";
  EXPECT_EQ(reason(evidence), "/dev/ttyUSB0 is not there: plug it in");
  evidence.link = wind::LinkState::kConnected;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kConnecting);
  EXPECT_THAT(reason(evidence), HasSubstr("has sent no reading yet"));
}

TEST(SensorState, SilenceOfADeviceThatIsThereIsStaleAndOfOneThatHasGoneDisconnected) {
  SensorEvidence evidence = well();
  evidence.report.health = wind::SourceHealth::kStale;
  evidence.report.age_s = 12.34;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kStale);
  EXPECT_THAT(reason(evidence), StartsWith("no reading for 12.3 s; its usual interval is 1 s"));
  evidence.link = wind::LinkState::kConnecting;
  evidence.link_detail = "slave 1 does not answer";
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kDisconnected);
  EXPECT_EQ(reason(evidence), "slave 1 does not answer");
}

TEST(SensorState, BeforeItsSecondReadingAStationIsNotStale) {
  SensorEvidence evidence = well();
  evidence.report.health = wind::SourceHealth::kStale;
  evidence.report.interval_s = 0.0;
  evidence.report.age_s = 47.0;  // Fine Offset's consoles measure every 48 s
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kLive);
  evidence.report.age_s = 121.0;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kStale);
}

TEST(SensorState, NothingExplainsTheSilenceOfADeviceThatHasGone) {
  SensorEvidence evidence = well();
  evidence.report.is_overdue = true;
  evidence.report.age_s = 600.0;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kLive);
  EXPECT_EQ(reason(evidence), "a reading every 1 s; none for 10 min, which means that nothing has changed");
  evidence.link = wind::LinkState::kConnecting;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kDisconnected);
}

TEST(SensorState, OneMissedAnswerIsNoDisconnection) {
  SensorEvidence evidence = well();
  evidence.link = wind::LinkState::kConnecting;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kLive) << "its last reading is fresh";
}

TEST(SensorState, WhatItSaysIsJudgedInTheOrderOfHowSureThatIs) {
  SensorEvidence evidence = well();
  evidence.vote = wind::judging::Vote::kOutvoted;
  evidence.mean_m_s = 22.1;
  evidence.others_m_s = 5.2;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kImplausible);
  EXPECT_THAT(reason(evidence), StartsWith("its mean of 5 min is 22.1 m/s, that of the other sensors 5.2"));
  evidence.fault = wind::judging::ReadingFault::kImplausible;
  evidence.bad_share = 0.65;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kImplausible);
  EXPECT_THAT(reason(evidence), StartsWith("65 % of its last readings"));
  evidence.fault = wind::judging::ReadingFault::kSeized;
  evidence.still_for_s = 3.0 * 3600.0;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kSeized);
  EXPECT_THAT(reason(evidence), StartsWith("no wind for 3 h, while the other sensors measure 5.2 m/s"));
  evidence.fault = wind::judging::ReadingFault::kFrozen;
  evidence.same_count = 61;
  evidence.same_for_s = 60.0;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kFrozen);
  EXPECT_THAT(reason(evidence), StartsWith("the same reading, 3.42 m/s, 61 times in 1 min"));
}

TEST(SensorState, ASingleSpikeChangesNothing) {
  SensorEvidence evidence = well();
  evidence.fault = wind::judging::ReadingFault::kSpike;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kLive);
}

TEST(SensorState, AFaultOfTheReadingsIsForgottenWithTheDevice) {
  SensorEvidence evidence = well();
  evidence.fault = wind::judging::ReadingFault::kFrozen;
  evidence.report.health = wind::SourceHealth::kStale;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kStale);
  evidence.link = wind::LinkState::kConnecting;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kDisconnected);
}

TEST(SensorState, ADeviceThatSaysNothingButNonsenseIsImplausible) {
  SensorEvidence evidence;
  evidence.link = wind::LinkState::kConnected;
  evidence.fault = wind::judging::ReadingFault::kImplausible;
  evidence.bad_share = 1.0;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kImplausible);
  evidence.report.health = wind::SourceHealth::kStale;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kImplausible);
}

TEST(SensorState, SimulationsAndRecordingsSaySo) {
  SensorEvidence evidence = well();
  evidence.report.last->quality = wind::ReadingQuality::kSimulated;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kSimulated);
  evidence.is_replay = true;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kReplayed);
  evidence.fault = wind::judging::ReadingFault::kFrozen;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kFrozen) << "what is wrong matters more";
  evidence.report.health = wind::SourceHealth::kStale;
  evidence.link = wind::LinkState::kFinished;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kDisconnected);
}

TEST(SensorState, ADisputeIsToldButCondemnsNobody) {
  SensorEvidence evidence = well();
  evidence.vote = wind::judging::Vote::kDisputed;
  evidence.mean_m_s = 2.0;
  evidence.others_m_s = 20.0;
  EXPECT_EQ(state_of(evidence), wind::judging::SensorState::kLive);
  EXPECT_THAT(reason(evidence), HasSubstr("2.0 m/s, that of the other sensors 20.0"));
  EXPECT_THAT(reason(evidence), HasSubstr("Check each sensor"));
}

TEST(SensorState, EveryStateHasANameOfItsOwnAndAReasonForAnyEvidence) {
  for (std::size_t a = 0; a < wind::judging::kSensorStateNames.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_NE(wind::judging::kSensorStateNames[a], wind::judging::kSensorStateNames[b]);
    EXPECT_EQ(name_of(static_cast<wind::judging::SensorState>(a)), wind::judging::kSensorStateNames[a]);
    EXPECT_FALSE(reason_of(static_cast<wind::judging::SensorState>(a), SensorEvidence{}).empty()) << a;
  }
  EXPECT_EQ(name_of(static_cast<wind::judging::SensorState>(200)), "?");
}

}  // namespace
}  // namespace yuragi::daemon::sensing
