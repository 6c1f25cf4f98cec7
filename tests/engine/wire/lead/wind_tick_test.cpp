// Ticks of wind as bytes: the poses that follow from decoded ones are those of the leader, bit for bit, and bytes that
// are not a tick are refused.

#include "engine/wire/lead/wind_tick.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/snapshot.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/measured_wind.hpp"
#include "tests/support/station_wind.hpp"

namespace yuragi::wire::lead {
namespace {

/// As the daemon's shaping leaves it, with each number that is not always the same.
WindTick next_tick(MeasuredWind& measured, std::uint64_t number) {
  WindTick tick{
      .epoch = 7, .number = number, .utc = UtcTime(std::chrono::seconds(1'700'000'000)), .wind = measured.step()};
  tick.wind.ground.gain = 0.8;
  tick.wind.ground.gust_gain = 1.3;
  tick.wind.ground.breeze = {0.3, -0.2};
  return tick;
}

std::vector<wind::blend::SourceSettings> two_places() {
  std::vector<wind::blend::SourceSettings> sources(2);
  for (wind::blend::SourceSettings& source : sources) source.has_place = true;
  sources[0].east_m = -20.0;
  sources[1].east_m = 15.0;
  return sources;
}

WindTick sample_tick() {
  MeasuredWind measured(station_gusts(), {5.0, 2.0}, two_places());
  for (int i = 0; i < 100; ++i) measured.step();
  return next_tick(measured, 101);
}

/// A scene on tapes of its own.
class Reader {
 public:
  explicit Reader(const scenes::Description& kind)
      : scene_(
            kind.make(ParameterValues::resolve(kind.parameters, {}).value(), {.seed = 1, .gusts = station_gusts()})) {}

  std::uint64_t hash_after(const WindTick& tick) {
    wind::ground::Wind ground = written_to(tapes_, tick.wind);
    ground.tick = tick.number;
    scene_->tick(ground, 1.0 / 60.0);
    return pose::pose_hash(0, scene_->pose());
  }

 private:
  wind::ground::WindTapes tapes_;
  std::unique_ptr<scenes::Scene> scene_;
};

TEST(WindTick, GivesTheSamePosesInEachSceneAsTheWindItWasMadeOf) {
  for (const scenes::Description* kind : scenes::scene_table()) {
    SCOPED_TRACE(kind->name);
    MeasuredWind measured(station_gusts(), {5.0, 2.0}, two_places());
    Reader leader(*kind), follower(*kind);
    std::vector<std::uint64_t> led, followed;
    for (std::uint64_t number = 1; number <= 90; ++number) {
      const WindTick tick = next_tick(measured, number);
      const auto decoded = decode_wind_tick(encode(tick), tick.wind.state.time);
      ASSERT_TRUE(decoded) << decoded.error().message;
      led.push_back(leader.hash_after(tick));
      followed.push_back(follower.hash_after(*decoded));
    }
    EXPECT_EQ(followed, led);
    EXPECT_NE(led.front(), led.back());
  }
}

TEST(WindTick, CarriesItsNumbersAndCues) {
  WindTick tick = sample_tick();
  tick.periods = 3;
  tick.cue_count = 2;
  tick.cues[0] = {.scene = 4, .shown = false, .hide_others = false, .over_s = 2.5};
  tick.cues[1] = {.scene = 1, .shown = true, .hide_others = true, .over_s = 0.0};
  const MonoTime here{std::chrono::hours(3)};

  const auto decoded = decode_wind_tick(encode(tick), here);

  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->epoch, 7U);
  EXPECT_EQ(decoded->number, 101U);
  EXPECT_EQ(decoded->periods, 3U);
  EXPECT_EQ(decoded->utc, tick.utc);
  EXPECT_EQ(decoded->wind.state.time, here);
  EXPECT_EQ(decoded->wind.stroke.pen_count, 2U);
  ASSERT_EQ(decoded->cue_count, 2U);
  EXPECT_EQ(decoded->cues[0].scene, 4U);
  EXPECT_FALSE(decoded->cues[0].shown);
  EXPECT_EQ(decoded->cues[0].over_s, 2.5);
  EXPECT_TRUE(decoded->cues[1].hide_others);
}

TEST(WindTick, TakesThreeKilobytesWithTwoPlacesAndOneWithout) {
  EXPECT_LT(encode(WindTick()).size(), 1500U);
  EXPECT_LT(encode(sample_tick()).size(), 4000U);
}

// Whoever adds a member to one of these lists it in WindTick::list_state(), or argues that no pose depends on it.
TEST(WindTick, ListsEachMemberOfTheWind) {
  EXPECT_EQ(sizeof(wind::State), 72U);
  EXPECT_EQ(sizeof(wind::ground::Wind), 1312U);
  EXPECT_EQ(sizeof(wind::ground::WindStroke), 4608U);
}

TEST(WindTick, AnyDamagedByteAndAnyOtherLengthIsRefused) {
  const std::vector<std::uint8_t> good = encode(sample_tick());
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::vector<std::uint8_t> bad = good;
    bad[i] ^= 0x10U;
    EXPECT_FALSE(decode_wind_tick(bad, {})) << i;
    EXPECT_FALSE(decode_wind_tick(std::span(good).first(i), {})) << i;
  }
  EXPECT_FALSE(decode_wind_tick(std::vector<std::uint8_t>(kMaxWindTick_bytes + 1), {}));
}

TEST(WindTick, NumbersThatNoWindHasAreRefused) {
  const auto refused = [](const auto& damage) {
    WindTick tick = sample_tick();
    damage(tick);
    return !decode_wind_tick(encode(tick), {});
  };
  EXPECT_FALSE(refused([](WindTick&) {}));
  EXPECT_TRUE(refused([](WindTick& tick) { tick.wind.ground.breeze.u_m_s = 300.0; }));
  EXPECT_TRUE(refused([](WindTick& tick) { tick.wind.state.wind.v_m_s = 300.0; }));
  EXPECT_TRUE(refused([](WindTick& tick) { tick.wind.ground.gusts.gustiness = 30.0F; }));
  EXPECT_TRUE(refused([](WindTick& tick) { tick.wind.ground.slope.east_m = -1e5; }));
  EXPECT_TRUE(refused([](WindTick& tick) { tick.wind.ground.gain = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](WindTick& tick) { tick.periods = kMaxTickPeriods + 1; }));
  EXPECT_TRUE(refused([](WindTick& tick) { tick.wind.stroke.ahead = {1.0, 1.0}; }));
  EXPECT_TRUE(refused([](WindTick& tick) {
    tick.cue_count = 1;
    tick.cues[0].over_s = -1.0;
  }));
}

// A snapshot of something else, whose checksum is right.
TEST(WindTick, AnotherSnapshotIsRefused) {
  const auto refused = decode_wind_tick(closed_snapshot(std::vector<std::uint8_t>(1000), 12), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "is of another configuration");
}

}  // namespace
}  // namespace yuragi::wire::lead
