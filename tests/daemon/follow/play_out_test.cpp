#include "daemon/follow/play_out.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace yuragi::daemon::follow {
namespace {

constexpr double kRate_hz = 50.0;
constexpr Nanoseconds kPeriod = std::chrono::milliseconds(20);
constexpr Nanoseconds kDelay = std::chrono::milliseconds(300);
constexpr std::uint64_t kFirst = 90'000'000'000;

wire::lead::WindTick tick_of(std::uint64_t number, std::uint32_t periods = 1, std::uint64_t epoch = 1) {
  return {.epoch = epoch, .number = number, .periods = periods};
}
/// When the tick of this place, from 0, arrives without a delay.
MonoTime arrival(std::uint64_t place) {
  return MonoTime(std::chrono::hours(5)) + static_cast<Nanoseconds::rep>(place) * kPeriod;
}

class PlayOutTest : public ::testing::Test {
 protected:
  PlayOutTest() { play_out_.begin(1); }
  PlayOut::Taken take(std::uint64_t place, Nanoseconds late = {}) {
    return play_out_.take(tick_of(kFirst + place), arrival(place) + late);
  }
  /// The places of what is played until then.
  std::vector<std::uint64_t> played_until(MonoTime until) {
    std::vector<std::uint64_t> places;
    while (const wire::lead::WindTick* tick = play_out_.next(until)) places.push_back(tick->number - kFirst);
    return places;
  }

  PlayOut play_out_{kRate_hz, kDelay};
};

TEST_F(PlayOutTest, ATickIsDueTheDelayAfterItsQuickestArrival) {
  take(0, std::chrono::milliseconds(40));
  take(1, std::chrono::milliseconds(5));
  take(2, std::chrono::milliseconds(90));
  EXPECT_EQ(play_out_.due(kFirst), arrival(0) + std::chrono::milliseconds(5) + kDelay);
  EXPECT_EQ(play_out_.due(kFirst + 2), arrival(2) + std::chrono::milliseconds(5) + kDelay);
  EXPECT_EQ(played_until(arrival(0)), (std::vector<std::uint64_t>{0, 1, 2})) << "the animation waits for their times";
}

// As its network's way becomes longer, and for another clock's drift.
TEST_F(PlayOutTest, TheQuickestArrivalIsOfTheLastSeconds) {
  const Nanoseconds later = std::chrono::milliseconds(80);
  for (std::uint64_t place = 0; place < 100; ++place) take(place);
  for (std::uint64_t place = 100; place < 900; ++place) take(place, later);
  EXPECT_EQ(play_out_.due(kFirst + 900), arrival(900) + later + kDelay);
}

TEST_F(PlayOutTest, TicksInAnyOrderAndTwiceArePlayedOnceAndInOrder) {
  for (const std::uint64_t place : {2U, 0U, 3U, 2U, 1U}) take(place, std::chrono::milliseconds(100));
  // The first one that came is the first: what is older was before it began.
  EXPECT_EQ(played_until(arrival(100)), (std::vector<std::uint64_t>{2, 3}));
  EXPECT_EQ(take(3), PlayOut::Taken::kKnown);
  for (const std::uint64_t place : {5U, 4U}) take(place);
  EXPECT_EQ(played_until(arrival(100)), (std::vector<std::uint64_t>{4, 5}));
}

TEST_F(PlayOutTest, AGapIsReportedUntilItIsFilledAndPassedOverWhenItIsTooLate) {
  for (const std::uint64_t place : {0U, 1U, 4U, 5U, 8U}) take(place);
  EXPECT_EQ(play_out_.gaps(arrival(0))[0].from, kFirst + 2);
  EXPECT_EQ(play_out_.gaps(arrival(0))[0].to, kFirst + 3);
  EXPECT_EQ(play_out_.gaps(arrival(0))[1].from, kFirst + 6);
  EXPECT_EQ(play_out_.gaps(arrival(0))[1].to, kFirst + 7);
  EXPECT_EQ(play_out_.gaps(arrival(0))[2].to, 0U);
  take(2, std::chrono::milliseconds(200));
  EXPECT_EQ(play_out_.gaps(arrival(0))[0].from, kFirst + 3);
  take(3, std::chrono::milliseconds(200));
  EXPECT_EQ(play_out_.gaps(arrival(0))[0].from, kFirst + 6);
  EXPECT_EQ(played_until(arrival(7) + kDelay), (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(play_out_.gaps(arrival(7) + kDelay)[0].to, 0U) << "its time is over: nobody needs it";
  EXPECT_EQ(played_until(arrival(8) + kDelay), std::vector<std::uint64_t>{8});
  EXPECT_EQ(play_out_.gaps(arrival(0))[0].to, 0U);
}

// A leader that was halted for a moment makes one tick of several periods.
TEST_F(PlayOutTest, ATickOfSeveralPeriodsLeavesNoGap) {
  take(0);
  play_out_.take(tick_of(kFirst + 4, 4), arrival(4));
  EXPECT_EQ(play_out_.gaps(arrival(0))[0].to, 0U);
  EXPECT_EQ(played_until(arrival(100)), (std::vector<std::uint64_t>{0, 4}));
  EXPECT_TRUE(play_out_.go_back_to(kFirst));
  EXPECT_FALSE(play_out_.go_back_to(kFirst + 2)) << "no tick ends there";
  EXPECT_EQ(played_until(arrival(100)), std::vector<std::uint64_t>{4});
}

TEST_F(PlayOutTest, ItGoesBackOnlyOverTicksThatAreAllKnown) {
  for (const std::uint64_t place : {0U, 1U, 2U, 4U, 5U, 6U}) take(place);
  EXPECT_EQ(played_until(arrival(100)).size(), 6U);
  EXPECT_FALSE(play_out_.go_back_to(kFirst + 2));
  EXPECT_EQ(played_until(arrival(100)), std::vector<std::uint64_t>{});
  EXPECT_TRUE(play_out_.go_back_to(kFirst + 4));
  EXPECT_EQ(played_until(arrival(100)), (std::vector<std::uint64_t>{5, 6}));
  EXPECT_FALSE(play_out_.go_back_to(kFirst + 9));
  EXPECT_TRUE(play_out_.go_back_to(kFirst + 6));
}

TEST_F(PlayOutTest, AnotherEpochAndAFarNumberAreNotOfIt) {
  take(0);
  EXPECT_EQ(play_out_.take(tick_of(kFirst + 1, 1, 2), arrival(1)), PlayOut::Taken::kNotOfIt);
  EXPECT_EQ(play_out_.take(tick_of(kFirst + 2'000), arrival(1)), PlayOut::Taken::kNotOfIt);
  EXPECT_EQ(play_out_.take(tick_of(1), arrival(1)), PlayOut::Taken::kNotOfIt) << "a number before which there is none";
  EXPECT_EQ(play_out_.newest(), kFirst);
  play_out_.begin(2);
  EXPECT_EQ(play_out_.take(tick_of(7, 1, 2), arrival(1)), PlayOut::Taken::kNew);
  EXPECT_EQ(play_out_.newest(), 7U);
}

TEST_F(PlayOutTest, ItKeepsTheLastTicksAndNoMore) {
  for (std::uint64_t place = 0; place < 3 * PlayOut::kKept; ++place) EXPECT_EQ(take(place), PlayOut::Taken::kNew);
  EXPECT_EQ(take(PlayOut::kKept), PlayOut::Taken::kKnown) << "its time is over";
  const std::vector<std::uint64_t> played = played_until(arrival(4 * PlayOut::kKept));
  EXPECT_EQ(played.size(), PlayOut::kKept);
  EXPECT_EQ(played.back(), 3 * PlayOut::kKept - 1);
}

}  // namespace
}  // namespace yuragi::daemon::follow
