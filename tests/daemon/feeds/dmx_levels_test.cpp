#include "daemon/feeds/dmx_levels.hpp"

#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::feeds {
namespace {

using settings::feeds::DmxChannel;
using settings::feeds::DmxGrid;
using testing::ElementsAre;

/// Speeds from 0 to 10 m/s become all levels.
DmxChannel channel_of(int bits = 8) {
  DmxChannel channel{.channel = 3, .bits = bits, .from = {0.0, 10.0}, .to = {0.0, 0.0}};
  channel.to = {0.0, channel.max_level()};
  return channel;
}

int level_of(const DmxChannelLevel& channel) {
  DmxLevels levels{};
  channel.write_to(levels);
  const std::size_t first = channel.config().channel - 1;
  return channel.config().bits == 16 ? levels[first] * 256 + levels[first + 1] : levels[first];
}

std::vector<int> levels_during(const DmxChannel& config, const std::vector<double>& values, double dt_s = 0.1) {
  DmxChannelLevel channel(config);
  std::vector<int> levels;
  for (const double value : values) {
    channel.step(value, dt_s);
    levels.push_back(level_of(channel));
  }
  return levels;
}

TEST(DmxChannelLevelTest, TheRangeIsBroughtIntoLevels) {
  EXPECT_THAT(levels_during(channel_of(), {0.0, 5.0, 10.0, 20.0, -1.0}), ElementsAre(0, 128, 255, 255, 0));
  DmxChannel down = channel_of();
  down.to = {200.0, 100.0};
  EXPECT_THAT(levels_during(down, {0.0, 5.0, 10.0}), ElementsAre(200, 150, 100));
  DmxChannel curved = channel_of();
  curved.curve = 2.0;
  EXPECT_THAT(levels_during(curved, {5.0}), ElementsAre(64));
}

TEST(DmxChannelLevelTest, SixteenBitsTakeTwoChannels) {
  EXPECT_THAT(levels_during(channel_of(16), {0.0, 5.0, 10.0}), ElementsAre(0, 32768, 65535));
  DmxChannelLevel channel(channel_of(16));
  channel.step(2.5, 0.1);
  DmxLevels levels{};
  channel.write_to(levels);
  EXPECT_THAT(std::vector<int>(levels.begin(), levels.begin() + 5), ElementsAre(0, 0, 0x40, 0x00, 0));
}

TEST(DmxChannelLevelTest, AFanTurnsFromItsLeastLevelAndDoesNotFlutter) {
  DmxChannel fan = channel_of();
  fan.least = 102.0;  // at 4 m/s; off below 3 m/s
  EXPECT_THAT(levels_during(fan, {3.9, 4.0, 3.9, 3.1, 4.5, 3.1, 2.9, 3.5, 3.9, 4.1}),
              ElementsAre(0, 102, 102, 102, 115, 102, 0, 0, 0, 105));
}

TEST(DmxChannelLevelTest, SlewIsTheTimeToFull) {
  DmxChannel slow = channel_of();
  slow.slew_s = 2.0;
  DmxChannelLevel channel(slow);
  for (int i = 0; i < 10; ++i) channel.step(10.0, 0.1);
  EXPECT_EQ(level_of(channel), 128) << "half way in 1 s";
  for (int i = 0; i < 11; ++i) channel.step(10.0, 0.1);
  EXPECT_EQ(level_of(channel), 255);
  channel.step(0.0, 0.2);
  EXPECT_EQ(level_of(channel), 230) << "and back";
}

TEST(DmxChannelLevelTest, GoesToRestWithoutAValue) {
  DmxChannel channel = channel_of();
  channel.rest = 20.0;
  channel.slew_s = 1.0;
  DmxChannelLevel level(channel);
  EXPECT_EQ(level_of(level), 20) << "at first, too";
  level.step(10.0, 1.0);
  EXPECT_EQ(level_of(level), 255);
  level.step(std::nullopt, 0.1);
  EXPECT_FALSE(level.is_at_rest());
  level.step(std::nullopt, 1.0);
  EXPECT_TRUE(level.is_at_rest());
  EXPECT_EQ(level_of(level), 20);
}

TEST(DmxGridTest, PixelsGoOnInTheNextUniverse) {
  DmxGrid grid{.channel = 508, .from = {0.0, 10.0}, .to = {{0, 0, 100}, {200, 100, 0}}, .rest = {7, 8, 9}};
  grid.grid = {.columns = 172, .rows = 1};
  // One whole pixel from channel 508 on, then 170, then one.
  EXPECT_EQ(grid.where(0).channel, 508U);
  EXPECT_EQ(grid.where(1).universe, 1U);
  EXPECT_EQ(grid.where(1).channel, 1U);
  EXPECT_EQ(grid.where(170).channel, 508U);
  EXPECT_EQ(grid.where(171).universe, 2U);
  const settings::feeds::Dmx feed{.grids = {grid}};
  ASSERT_EQ(feed.universe_count(), 3U);

  std::vector<DmxLevels> universes(3);
  std::vector<double> values(172, 0.0);
  values[0] = 10.0;
  values[171] = 5.0;
  write_grid(grid, values, universes);
  const auto pixel = [&universes](std::size_t universe, std::size_t channel) {
    const auto first = universes[universe].begin() + static_cast<std::ptrdiff_t>(channel) - 1;
    return std::vector<int>(first, first + 3);
  };
  EXPECT_THAT(pixel(0, 508), ElementsAre(200, 100, 0));
  EXPECT_THAT(pixel(0, 505), ElementsAre(0, 0, 0)) << "not of the grid";
  EXPECT_THAT(pixel(1, 1), ElementsAre(0, 0, 100));
  EXPECT_THAT(pixel(1, 508), ElementsAre(0, 0, 100));
  EXPECT_THAT(pixel(2, 1), ElementsAre(100, 50, 50));
  write_grid(grid, {}, universes);
  EXPECT_THAT(pixel(2, 1), ElementsAre(7, 8, 9));
}

}  // namespace
}  // namespace yuragi::daemon::feeds
