#include "drivers/sensor/held_wind.hpp"

#include <gtest/gtest.h>

namespace yuragi::drivers::sensor {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kHold = 10s;

Instant at(Nanoseconds time) {
  return {.mono = MonoTime(1h + time), .utc = UtcTime(time)};
}

TEST(HeldWind, GivesEachSpeedTheLastDirectionAndGust) {
  HeldWind held(kHold);
  EXPECT_FALSE(held.reading_of(4.0, at(0s))->direction_deg);
  EXPECT_TRUE(held.hold_direction(370.0, at(0s).mono));
  EXPECT_TRUE(held.hold_gust(6.0, at(5s).mono));
  const auto both = held.reading_of(4.0, at(10s));
  ASSERT_TRUE(both);
  EXPECT_EQ(both->speed_m_s, 4.0);
  EXPECT_EQ(both->direction_deg, 10.0);
  EXPECT_EQ(both->gust_m_s, 6.0);
  EXPECT_EQ(both->quality, wind::ReadingQuality::kGood);
  EXPECT_EQ(both->time.mono, at(10s).mono);
  EXPECT_FALSE(held.reading_of(7.0, at(10s))->gust_m_s) << "a gust below the speed is none";
  EXPECT_FALSE(held.reading_of(4.0, at(10s + 1ns))->direction_deg) << "it is too old";
  EXPECT_EQ(held.reading_of(4.0, at(15s))->gust_m_s, 6.0);
  EXPECT_FALSE(held.reading_of(4.0, at(16s))->gust_m_s);
}

TEST(HeldWind, ForgetsWhatTheDeviceHasNoValueForAndWhenItIsCleared) {
  HeldWind held(kHold);
  held.hold_direction(90.0, at(0s).mono);
  held.hold_gust(6.0, at(0s).mono);
  EXPECT_TRUE(held.hold_direction(std::nullopt, at(1s).mono));
  EXPECT_TRUE(held.hold_gust(std::nullopt, at(1s).mono));
  EXPECT_FALSE(held.reading_of(4.0, at(1s))->direction_deg);
  EXPECT_FALSE(held.reading_of(4.0, at(1s))->gust_m_s);
  held.hold_direction(90.0, at(2s).mono);
  held.clear();
  EXPECT_FALSE(held.reading_of(4.0, at(2s))->direction_deg);
}

TEST(HeldWind, IsUncertainBesideADirectionThatCannotBeReadOrIsImpossible) {
  HeldWind held(kHold);
  held.hold_direction(90.0, at(0s).mono);
  EXPECT_FALSE(held.hold_direction(-1.0, at(1s).mono));
  EXPECT_FALSE(held.reading_of(4.0, at(2s))->direction_deg);
  EXPECT_EQ(held.reading_of(4.0, at(2s))->quality, wind::ReadingQuality::kUncertain);
  EXPECT_EQ(held.reading_of(4.0, at(12s))->quality, wind::ReadingQuality::kGood);
  held.hold_direction(90.0, at(13s).mono);
  held.lose_direction(at(14s).mono);
  EXPECT_FALSE(held.reading_of(4.0, at(14s))->direction_deg);
  EXPECT_EQ(held.reading_of(4.0, at(14s))->quality, wind::ReadingQuality::kUncertain);
  held.hold_direction(90.0, at(15s).mono);
  EXPECT_EQ(held.reading_of(4.0, at(15s))->quality, wind::ReadingQuality::kGood);
}

TEST(HeldWind, RefusesWhatNoWindIs) {
  HeldWind held(kHold);
  EXPECT_FALSE(held.hold_gust(1000.0, at(0s).mono));
  EXPECT_FALSE(held.hold_gust(-1.0, at(0s).mono));
  EXPECT_FALSE(held.reading_of(4.0, at(0s))->gust_m_s);
  EXPECT_EQ(held.reading_of(1000.0, at(0s)).error(), decode::Refusal::kImplausible);
  EXPECT_EQ(held.reading_of(-1.0, at(0s)).error(), decode::Refusal::kImplausible);
}

}  // namespace
}  // namespace yuragi::drivers::sensor
