#include "engine/base/spsc_ring.hpp"

#include <cstdint>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

TEST(SpscRing, GivesValuesInTheOrderTheyCame) {
  SpscRing<int> ring(4);
  EXPECT_TRUE(ring.push(1));
  EXPECT_TRUE(ring.push(2));
  int value = 0;
  EXPECT_TRUE(ring.pop(value));
  EXPECT_EQ(value, 1);
  EXPECT_TRUE(ring.pop(value));
  EXPECT_EQ(value, 2);
}

TEST(SpscRing, SaysWhenItIsEmptyAndLeavesTheValueAlone) {
  SpscRing<int> ring(4);
  int value = 9;
  EXPECT_FALSE(ring.pop(value));
  EXPECT_EQ(value, 9);
}

TEST(SpscRing, HoldsItsCapacityAndRefusesOneMore) {
  SpscRing<int> ring(3);
  for (int value = 0; value < 3; ++value) EXPECT_TRUE(ring.push(value));
  EXPECT_FALSE(ring.push(3));
  int value = 0;
  ASSERT_TRUE(ring.pop(value));
  EXPECT_TRUE(ring.push(4));
}

TEST(SpscRing, DrainsAllThatWaitsOldestFirst) {
  SpscRing<int> ring(8);
  for (int value = 0; value < 5; ++value) ASSERT_TRUE(ring.push(value));
  std::vector<int> seen;
  EXPECT_EQ(ring.drain([&seen](int value) { seen.push_back(value); }), 5U);
  EXPECT_EQ(seen, (std::vector{0, 1, 2, 3, 4}));
  EXPECT_EQ(ring.drain([](int) { FAIL(); }), 0U);
}

TEST(SpscRing, AcrossTwoThreadsNoValueIsLostOrDoubled) {
  constexpr std::uint64_t kLast = 50000;
  SpscRing<std::uint64_t> ring(64);
  std::thread producer([&ring] {
    for (std::uint64_t number = 1; number <= kLast; ++number) {
      while (!ring.push(number)) std::this_thread::yield();
    }
  });

  std::uint64_t previous = 0;
  std::uint64_t out_of_order = 0;
  while (previous < kLast) {
    const std::size_t taken = ring.drain([&](std::uint64_t number) {
      if (number != previous + 1) ++out_of_order;
      previous = number;
    });
    if (taken == 0) std::this_thread::yield();
  }
  producer.join();
  EXPECT_EQ(out_of_order, 0U);
}

}  // namespace
}  // namespace yuragi
