#include "daemon/service/watchdog_feed.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::service {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kTimeout = 8s;  // fed every 2 s
constexpr MonoTime kBegin{100s};

TEST(WatchdogFeed, IsFedOnceBothHaveGoneRound) {
  WatchdogFeed feed(kTimeout, true);
  EXPECT_FALSE(feed.take(kBegin));
  feed.io_went_round();
  EXPECT_FALSE(feed.take(kBegin));
  feed.animation_has_made(1);
  EXPECT_TRUE(feed.take(kBegin));
}

TEST(WatchdogFeed, IsFedEveryQuarterOfTheTimeout) {
  WatchdogFeed feed(kTimeout, true);
  int feeds = 0;
  std::uint64_t ticks = 0;
  for (MonoTime now = kBegin; now < kBegin + 80s; now += 10ms) {
    feed.io_went_round();
    feed.animation_has_made(++ticks);
    feeds += feed.take(now) ? 1 : 0;
  }
  EXPECT_EQ(feeds, 40);
}

TEST(WatchdogFeed, AnAnimationThatHangsIsNotFedFor) {
  WatchdogFeed feed(kTimeout, true);
  feed.io_went_round();
  feed.animation_has_made(7);
  ASSERT_TRUE(feed.take(kBegin));
  for (MonoTime now = kBegin; now < kBegin + 60s; now += 100ms) {
    feed.io_went_round();
    feed.animation_has_made(7);
    EXPECT_FALSE(feed.take(now));
  }
  feed.animation_has_made(8);
  EXPECT_TRUE(feed.take(kBegin + 60s)) << "it went on";
}

TEST(WatchdogFeed, AnIoThreadThatHangsIsNotFedFor) {
  WatchdogFeed feed(kTimeout, true);
  feed.io_went_round();
  feed.animation_has_made(1);
  ASSERT_TRUE(feed.take(kBegin));
  feed.animation_has_made(1000);
  EXPECT_FALSE(feed.take(kBegin + 60s));
}

TEST(WatchdogFeed, ATickOnceSeenCountsUntilItIsFed) {
  WatchdogFeed feed(kTimeout, true);
  feed.io_went_round();
  feed.animation_has_made(1);
  ASSERT_TRUE(feed.take(kBegin));
  feed.io_went_round();
  feed.animation_has_made(2);
  EXPECT_FALSE(feed.take(kBegin + 1s)) << "it is too early";
  feed.animation_has_made(2);
  EXPECT_TRUE(feed.take(kBegin + 2s));
}

TEST(WatchdogFeed, WithoutAnAnimationTheIoThreadAloneHasToGoRound) {
  WatchdogFeed feed(kTimeout, false);
  EXPECT_FALSE(feed.take(kBegin));
  feed.io_went_round();
  EXPECT_TRUE(feed.take(kBegin));
}

}  // namespace
}  // namespace yuragi::daemon::service
