#include "engine/base/latest.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

TEST(Latest, HoldsTheInitialValueUntilSomethingIsPublished) {
  Latest<int> latest(7);
  EXPECT_EQ(latest.value(), 7);
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.value(), 7);
}

TEST(Latest, GivesAPublishedValueOnceAsNew) {
  Latest<int> latest;
  latest.publish(1);
  EXPECT_TRUE(latest.refresh());
  EXPECT_EQ(latest.value(), 1);
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.value(), 1);
}

TEST(Latest, TheNewestWins) {
  Latest<int> latest;
  for (int value = 1; value <= 5; ++value) latest.publish(value);
  EXPECT_TRUE(latest.refresh());
  EXPECT_EQ(latest.value(), 5);
  EXPECT_FALSE(latest.refresh());
}

TEST(Latest, WhatTheReaderHoldsStaysWhileTheWriterGoesOn) {
  Latest<int> latest;
  latest.publish(1);
  ASSERT_TRUE(latest.refresh());
  for (int value = 2; value <= 20; ++value) {
    latest.publish(value);
    EXPECT_EQ(latest.value(), 1);
  }
}

TEST(Latest, ASlotThatIsBeingFilledIsNotSeen) {
  Latest<int> latest(1);
  latest.writable() = 2;
  EXPECT_FALSE(latest.refresh());
  EXPECT_EQ(latest.value(), 1);
  latest.publish();
  EXPECT_TRUE(latest.refresh());
  EXPECT_EQ(latest.value(), 2);
}

TEST(Latest, ReusesItsThreeSlotsSoThatBuffersKeepTheirMemory) {
  Latest<int> latest;
  std::array<const int*, 3> slots{};
  for (const int*& slot : slots) {
    slot = &latest.writable();
    latest.publish();
    latest.refresh();
  }
  for (int round = 0; round < 10; ++round) {
    EXPECT_NE(std::find(slots.begin(), slots.end(), &latest.writable()), slots.end());
    latest.publish();
    latest.refresh();
  }
}

TEST(Latest, AcrossTwoThreadsValuesComeWholeInOrderAndTheLastOneArrives) {
  // A value that would show a tear: the same number many times over.
  using Value = std::array<std::uint64_t, 64>;
  constexpr std::uint64_t kLast = 20000;
  const auto latest = std::make_unique<Latest<Value>>();

  std::thread writer([&latest] {
    for (std::uint64_t number = 1; number <= kLast; ++number) {
      latest->writable().fill(number);
      latest->publish();
    }
  });

  std::uint64_t previous = 0;
  std::uint64_t torn = 0;
  std::uint64_t backward = 0;
  while (previous < kLast) {
    if (!latest->refresh()) {
      std::this_thread::yield();
      continue;
    }
    const Value& value = latest->value();
    const auto differs = [&value](std::uint64_t number) { return number != value.front(); };
    if (std::any_of(value.begin(), value.end(), differs)) ++torn;
    if (value.front() <= previous) ++backward;
    previous = value.front();
  }
  writer.join();

  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(backward, 0U);
  EXPECT_EQ(previous, kLast);
  EXPECT_FALSE(latest->refresh());
}

}  // namespace
}  // namespace yuragi
