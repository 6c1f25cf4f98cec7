#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/sensing/sensor_diagnosis.hpp"

namespace yuragi {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A sensor that is well.
SensorEvidence well() {
  SensorEvidence evidence;
  evidence.link = LinkState::kConnected;
  evidence.link_detail = "answers at 10.0.0.5:502";
  WindReading reading;
  reading.speed_m_s = 3.42;
  evidence.report = {.health = SourceHealth::kLive, .interval_s = 1.0, .age_s = 0.4, .last = reading};
  return evidence;
}

std::string reason(const SensorEvidence& evidence) {
  return reason_of(state_of(evidence), evidence);
}

TEST(SensorState, ASensorThatSpeaksIsLive) {
  EXPECT_EQ(state_of(well()), SensorState::kLive);
  EXPECT_EQ(reason(well()), "a reading every 1 s");
}

TEST(SensorState, BeforeItsFirstReadingItIsConnecting) {
  SensorEvidence evidence;
  EXPECT_EQ(state_of(evidence), SensorState::kConnecting);
  EXPECT_EQ(reason(evidence), "looking for the device");
  evidence.link_detail = "/dev/ttyUSB0 is not there: plug it in";
  EXPECT_EQ(reason(evidence), "/dev/ttyUSB0 is not there: plug it in");
  evidence.link = LinkState::kConnected;
  EXPECT_EQ(state_of(evidence), SensorState::kConnecting);
  EXPECT_THAT(reason(evidence), HasSubstr("has sent no reading yet"));
}

TEST(SensorState, SilenceOfADeviceThatIsThereIsStaleAndOfOneThatHasGoneDisconnected) {
  SensorEvidence evidence = well();
  evidence.report.health = SourceHealth::kStale;
  evidence.report.age_s = 12.34;
  EXPECT_EQ(state_of(evidence), SensorState::kStale);
  EXPECT_THAT(reason(evidence), StartsWith("no reading for 12.3 s; its usual interval is 1 s"));
  evidence.link = LinkState::kConnecting;
  evidence.link_detail = "slave 1 does not answer";
  EXPECT_EQ(state_of(evidence), SensorState::kDisconnected);
  EXPECT_EQ(reason(evidence), "slave 1 does not answer");
}

TEST(SensorState, OneMissedAnswerIsNoDisconnection) {
  SensorEvidence evidence = well();
  evidence.link = LinkState::kConnecting;
  EXPECT_EQ(state_of(evidence), SensorState::kLive) << "its last reading is fresh";
}

TEST(SensorState, WhatItSaysIsJudgedInTheOrderOfHowSureThatIs) {
  SensorEvidence evidence = well();
  evidence.vote = Vote::kOutvoted;
  evidence.mean_m_s = 22.1;
  evidence.others_m_s = 5.2;
  EXPECT_EQ(state_of(evidence), SensorState::kImplausible);
  EXPECT_THAT(reason(evidence), StartsWith("its mean of 5 min is 22.1 m/s, that of the other sensors 5.2"));
  evidence.fault = ReadingFault::kImplausible;
  evidence.bad_share = 0.65;
  EXPECT_EQ(state_of(evidence), SensorState::kImplausible);
  EXPECT_THAT(reason(evidence), StartsWith("65 % of its last readings"));
  evidence.fault = ReadingFault::kSeized;
  evidence.still_for_s = 3.0 * 3600.0;
  EXPECT_EQ(state_of(evidence), SensorState::kSeized);
  EXPECT_THAT(reason(evidence), StartsWith("no wind for 3 h, while the other sensors measure 5.2 m/s"));
  evidence.fault = ReadingFault::kFrozen;
  evidence.same_count = 61;
  evidence.same_for_s = 60.0;
  EXPECT_EQ(state_of(evidence), SensorState::kFrozen);
  EXPECT_THAT(reason(evidence), StartsWith("the same reading, 3.42 m/s, 61 times in 1 min"));
}

TEST(SensorState, ASingleSpikeChangesNothing) {
  SensorEvidence evidence = well();
  evidence.fault = ReadingFault::kSpike;
  EXPECT_EQ(state_of(evidence), SensorState::kLive);
}

TEST(SensorState, AFaultOfTheReadingsIsForgottenWithTheDevice) {
  SensorEvidence evidence = well();
  evidence.fault = ReadingFault::kFrozen;
  evidence.report.health = SourceHealth::kStale;
  EXPECT_EQ(state_of(evidence), SensorState::kStale);
  evidence.link = LinkState::kConnecting;
  EXPECT_EQ(state_of(evidence), SensorState::kDisconnected);
}

TEST(SensorState, ADeviceThatSaysNothingButNonsenseIsImplausible) {
  SensorEvidence evidence;
  evidence.link = LinkState::kConnected;
  evidence.fault = ReadingFault::kImplausible;
  evidence.bad_share = 1.0;
  EXPECT_EQ(state_of(evidence), SensorState::kImplausible);
  evidence.report.health = SourceHealth::kStale;
  EXPECT_EQ(state_of(evidence), SensorState::kImplausible);
}

TEST(SensorState, SimulationsAndRecordingsSaySo) {
  SensorEvidence evidence = well();
  evidence.report.last->quality = ReadingQuality::kSimulated;
  EXPECT_EQ(state_of(evidence), SensorState::kSimulated);
  evidence.is_replay = true;
  EXPECT_EQ(state_of(evidence), SensorState::kReplayed);
  evidence.fault = ReadingFault::kFrozen;
  EXPECT_EQ(state_of(evidence), SensorState::kFrozen) << "what is wrong matters more";
  evidence.report.health = SourceHealth::kStale;
  evidence.link = LinkState::kFinished;
  EXPECT_EQ(state_of(evidence), SensorState::kDisconnected);
}

TEST(SensorState, ADisputeIsToldButCondemnsNobody) {
  SensorEvidence evidence = well();
  evidence.vote = Vote::kDisputed;
  evidence.mean_m_s = 2.0;
  evidence.others_m_s = 20.0;
  EXPECT_EQ(state_of(evidence), SensorState::kLive);
  EXPECT_THAT(reason(evidence), HasSubstr("2.0 m/s, that of the other sensors 20.0"));
  EXPECT_THAT(reason(evidence), HasSubstr("Check each sensor"));
}

TEST(SensorState, EveryStateHasANameOfItsOwnAndAReasonForAnyEvidence) {
  for (std::size_t a = 0; a < kSensorStateNames.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) EXPECT_NE(kSensorStateNames[a], kSensorStateNames[b]);
    EXPECT_EQ(name_of(static_cast<SensorState>(a)), kSensorStateNames[a]);
    EXPECT_FALSE(reason_of(static_cast<SensorState>(a), SensorEvidence{}).empty()) << a;
  }
  EXPECT_EQ(name_of(static_cast<SensorState>(200)), "?");
}

}  // namespace
}  // namespace yuragi
