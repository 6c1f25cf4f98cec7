#include "engine/math/philox.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::math {
namespace {

using Words = std::array<std::uint32_t, 4>;

TEST(Philox, GivesTheKnownAnswersOfItsAuthors) {
  constexpr std::uint32_t kOnes = 0xffffffffU;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U}));
  EXPECT_EQ(philox4x32({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Words{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU}));
  EXPECT_EQ(philox4x32({0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}, {0xa4093822U, 0x299f31d0U}),
            (Words{0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U}));
}

TEST(RandomStream, AnElementDependsOnItsAddressAloneAndNotOnTheOrder) {
  const RandomStream random(42, stream_id("order"));
  std::vector<double> forward;
  for (std::uint64_t i = 0; i < 100; ++i) forward.push_back(random.normal(i));
  for (std::uint64_t i = 100; i-- > 0;) EXPECT_EQ(RandomStream(42, stream_id("order")).normal(i), forward[i]);
}

TEST(RandomStream, ElementsAreTheHalvesOfTheirPair) {
  const RandomStream random(7, 9);
  for (std::uint64_t pair : {std::uint64_t{0}, std::uint64_t{5}, std::uint64_t{1} << 40U}) {
    EXPECT_EQ(random.uniform(2 * pair), random.uniform_pair(pair)[0]);
    EXPECT_EQ(random.uniform(2 * pair + 1), random.uniform_pair(pair)[1]);
    EXPECT_EQ(random.normal(2 * pair), random.normal_pair(pair)[0]);
    EXPECT_EQ(random.normal(2 * pair + 1), random.normal_pair(pair)[1]);
  }
}

TEST(RandomStream, EveryBitOfSeedStreamAndIndexMatters) {
  std::set<double> seen{RandomStream(0, 0).uniform(0)};
  for (unsigned bit = 0; bit < 64; ++bit) {
    const std::uint64_t word = std::uint64_t{1} << bit;
    seen.insert(RandomStream(word, 0).uniform(0));
    seen.insert(RandomStream(0, word).uniform(0));
    seen.insert(RandomStream(0, 0).uniform(word));
  }
  EXPECT_EQ(seen.size(), 1U + 3U * 64U);
}

TEST(RandomStream, UniformsFillTheUnitIntervalEvenly) {
  constexpr std::uint64_t kCount = 100000;
  const RandomStream random(1, 2);
  std::array<int, 10> bins{};
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double value = random.uniform(i);
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    ++bins[static_cast<std::size_t>(value * 10.0)];
  }
  // A bin holds 10000 with a standard deviation of 95.
  for (const int bin : bins) EXPECT_NEAR(bin, 10000, 5 * 95);
}

TEST(RandomStream, NormalsHaveTheMomentsAndTailsOfANormal) {
  constexpr std::uint64_t kCount = 200000;
  const RandomStream random(3, 4);
  double sum = 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  double neighbours = 0.0;
  int beyond_two = 0;
  double previous = 0.0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double value = random.normal(i);
    ASSERT_LT(std::abs(value), 8.6);
    sum += value;
    squares += value * value;
    fourths += value * value * value * value;
    neighbours += value * previous;
    beyond_two += std::abs(value) > 2.0 ? 1 : 0;
    previous = value;
  }
  // Bounds of five standard errors: 1, sqrt(2), sqrt(96), 1 and sqrt(p (1 - p)) over sqrt(200000) = 447.
  constexpr double kRoot = 447.2;
  EXPECT_NEAR(sum / kCount, 0.0, 5.0 / kRoot);
  EXPECT_NEAR(squares / kCount, 1.0, 5.0 * 1.42 / kRoot);
  EXPECT_NEAR(fourths / kCount, 3.0, 5.0 * 9.8 / kRoot);
  EXPECT_NEAR(neighbours / kCount, 0.0, 5.0 / kRoot);
  EXPECT_NEAR(beyond_two / static_cast<double>(kCount), 0.0455, 5.0 * 0.209 / kRoot);
}

TEST(StreamId, IsThePublishedFnv1aAndTellsNamesApart) {
  EXPECT_EQ(stream_id(""), 0xcbf29ce484222325U);
  EXPECT_EQ(stream_id("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(stream_id("foobar"), 0x85944171f73967e8U);
  EXPECT_NE(stream_id("grass"), stream_id("fur"));
}

}  // namespace
}  // namespace yuragi::math
