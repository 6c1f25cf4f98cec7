#include "engine/scenes/wind_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/stroke_run.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kGridTick_s = 1.0 / 60.0;

/// Places in a square of this side, with one in each corner; or in a rectangle, from north to south so many times as
/// long.
struct Places {
  explicit Places(double side_m, std::size_t count = 203, double length = 1.0) {
    const math::RandomStream random(4, math::stream_id("wind grid test"));
    for (std::size_t i = 0; i < count; ++i) {
      const auto [x, z] = random.uniform_pair(i);
      const bool is_corner = i < 4;
      const double corner_x = i % 2 == 0 ? 0.0 : 1.0;
      const double corner_z = i < 2 ? 0.0 : 1.0;
      x_m.push_back(static_cast<float>(side_m * (is_corner ? corner_x : x) - 20.0));
      z_m.push_back(static_cast<float>(length * side_m * (is_corner ? corner_z : z) + 5.0));
    }
    east_m_s.resize(count);
    south_m_s.resize(count);
  }

  std::vector<float> x_m, z_m, east_m_s, south_m_s;
};

/// The part of an octave that nodes so far apart hold: all of waves of four cells, nothing of those of two.
double held_part(std::size_t tile_octave, double cell_m) {
  const double shortest_m =
      2.0 * std::numbers::pi /
      shared_gusts()->octaves()[wind::turbulence::GustNoise::kFirstTileOctave + tile_octave].to_rad_m;
  return std::clamp(std::log2(shortest_m / (2.0 * cell_m)), 0.0, 1.0);
}

/// What nodes so far apart hold of a wind.
wind::ground::Wind held(wind::ground::Wind wind, double cell_m) {
  for (std::size_t i = 0; i < 2 * wind::turbulence::GustNoise::kTileOctaves; ++i) {
    const auto part = static_cast<float>(held_part(i, cell_m));
    wind.gusts.along_m_s[wind::turbulence::GustNoise::kFirstTileOctave + i] *= part;
    wind.gusts.across_m_s[wind::turbulence::GustNoise::kFirstTileOctave + i] *= part;
  }
  return wind;
}

TEST(WindGrid, EachPlaceFeelsTheWindOfThatPlace) {
  // Gusts that stand still: the grid has all the time to follow. Between nodes it reads a straight line, as the gusts'
  // own tiles do, so that they differ by the bend of the shortest waves alone.
  struct Case {
    double side_m, length, gustiness;
  };
  for (const auto& [side_m, length, gustiness] :
       {Case{0.0, 1.0, 0.0}, Case{3.0, 1.0, 0.3}, Case{7.0, 1.0, 0.0}, Case{7.0, 1.0, 0.3}, Case{28.0, 1.0, 0.0},
        Case{28.0, 0.1, 0.3}, Case{0.5, 50.0, 0.0}}) {
    Places places(side_m, 203, length);
    WindGrid grid(shared_gusts(), places.x_m, places.z_m, best_simd_row());
    const GustyWind gusty({6.0, -2.0}, 0.5F);
    wind::ground::Wind wind = gusty.wind();
    wind.gusts.gustiness = static_cast<float>(gustiness);
    for (int tick = 0; tick < 240; ++tick) grid.step(wind, kGridTick_s);
    const wind::ground::Wind expected = held(wind, 0.5);
    grid.sample(0, places.east_m_s, places.south_m_s);
    double squares = 0.0;
    double scatter = 0.0;
    for (std::size_t i = 0; i < places.x_m.size(); ++i) {
      const wind::Vector there =
          expected.at(*shared_gusts(), static_cast<double>(places.x_m[i]), static_cast<double>(places.z_m[i]));
      squares += std::pow(static_cast<double>(places.east_m_s[i]) - there.u_m_s, 2) +
                 std::pow(-static_cast<double>(places.south_m_s[i]) - there.v_m_s, 2);
      scatter += std::pow(there.u_m_s - 6.0, 2) + std::pow(there.v_m_s + 2.0, 2);
    }
    EXPECT_GT(scatter, 0.5 * static_cast<double>(places.x_m.size()));
    EXPECT_LT(squares, 0.01 * scatter) << side_m << " m, " << length << " times as long, " << gustiness;
  }
}

TEST(WindGrid, AGridOfPlacesIsReadToTheSameBitsAsEachOfThem) {
  constexpr std::size_t kColumns = 50;
  for (const float side_m : {1.0F, 7.0F, 60.0F}) {
    std::vector<float> x_m;
    std::vector<float> z_m;
    for (std::size_t i = 0; i < 30 * kColumns; ++i) {
      x_m.push_back(side_m * static_cast<float>(i % kColumns) / 49.0F + 3.0F);
      const std::size_t line = i / kColumns;
      z_m.push_back(side_m * static_cast<float>(line) / 29.0F - 4.0F);
    }
    WindGrid as_grid(shared_gusts(), x_m, z_m, best_simd_row(), 0.5, kColumns);
    WindGrid as_places(shared_gusts(), x_m, z_m, best_simd_row());
    GustyWind gusty({6.0, -2.0}, 0.5F);
    for (int tick = 0; tick < 30; ++tick) {
      const wind::ground::Wind wind = gusty.step(kGridTick_s);
      as_grid.step(wind, kGridTick_s);
      as_places.step(wind, kGridTick_s);
    }
    std::vector<float> east_of_grid(x_m.size()), south_of_grid(x_m.size());
    std::vector<float> east_of_places(x_m.size()), south_of_places(x_m.size());
    const auto expect_the_same = [&] {
      EXPECT_EQ(bits_of(east_of_grid), bits_of(east_of_places)) << side_m;
      EXPECT_EQ(bits_of(south_of_grid), bits_of(south_of_places)) << side_m;
    };
    as_grid.sample(0, east_of_grid, south_of_grid);
    as_places.sample(0, east_of_places, south_of_places);
    expect_the_same();
    EXPECT_NE(east_of_grid.front(), east_of_grid.back());
    // A part of them is read place by place.
    as_grid.sample(70, std::span(east_of_grid).subspan(70, 100), std::span(south_of_grid).subspan(70, 100));
    expect_the_same();
  }
}

TEST(WindGrid, PlacesOfALargeSceneHaveTheVarianceOfTheGusts) {
  Places places(200.0, 2000);
  GustyWind gusty({6.0, 0.0}, 0.5F);
  double variance = 0.0;
  constexpr int kMoments = 320;
  for (int moment = 0; moment < kMoments; ++moment) {
    WindGrid grid(shared_gusts(), places.x_m, places.z_m, best_simd_row());
    grid.step(gusty.step(37.0), 10.0);
    grid.sample(0, places.east_m_s, places.south_m_s);
    for (const float east_m_s : places.east_m_s) {
      variance += std::pow(static_cast<double>(east_m_s) - 6.0, 2) / 2000.0 / kMoments;
    }
  }
  // Nodes are 3.2 m apart: of the waves shorter than four of them, a part is left, and none of those of two.
  double of_gusts = 0.0;
  for (std::size_t i = 0; i < 2 * wind::turbulence::GustNoise::kTileOctaves; ++i) {
    of_gusts += 0.25 * std::pow(held_part(i, 200.0 / 62.0), 2);
  }
  EXPECT_GT(variance, 0.7 * of_gusts);
  EXPECT_LT(variance, 1.05 * of_gusts);
}

TEST(WindGrid, CalmIsCalmBitForBitAndComesAgain) {
  Places places(7.0);
  WindGrid grid(shared_gusts(), places.x_m, places.z_m, best_simd_row());
  const auto is_calm = [&] {
    grid.sample(0, places.east_m_s, places.south_m_s);
    const auto is_zero = [](float value) { return value == 0.0F; };
    return std::ranges::all_of(places.east_m_s, is_zero) && std::ranges::all_of(places.south_m_s, is_zero);
  };
  grid.step(wind::Vector{}, kGridTick_s);
  EXPECT_TRUE(is_calm());
  for (int tick = 0; tick < 60; ++tick) grid.step(wind::Vector{3.0, 4.0}, kGridTick_s);
  EXPECT_FALSE(is_calm());
  for (int tick = 0; tick < 600; ++tick) grid.step(wind::Vector{}, kGridTick_s);
  EXPECT_TRUE(is_calm());
}

/// With a tick's number (some are skipped) and without.
class HostileWind : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WindGrid, HostileWind, testing::Bool());

TEST_P(HostileWind, IsNeverTooStrongAndNeverTooQuick) {
  Places places(7.0);
  WindGrid grid(shared_gusts(), places.x_m, places.z_m, best_simd_row());
  const math::RandomStream random(8, math::stream_id("hostile gusts"));
  const double bound_m_s = Wind::largest_step_m_s(kGridTick_s);
  std::vector<float> east_before(places.x_m.size()), south_before(places.x_m.size());
  double largest_m_s = 0.0;
  for (std::uint64_t tick = 0; tick < 300; ++tick) {
    wind::ground::Wind wind(
        wind::Vector{200.0 * (random.uniform(4 * tick) - 0.5), 200.0 * (random.uniform(4 * tick + 1) - 0.5)});
    wind.gusts.along_m_s.fill(static_cast<float>(50.0 * random.uniform(4 * tick + 2)));
    wind.gusts.across_m_s.fill(static_cast<float>(50.0 * random.uniform(4 * tick + 3)));
    wind.gusts.carried = shared_gusts()->begin(tick);
    wind.advection = 100.0 * wind::Vector{random.uniform(4 * tick), random.uniform(4 * tick + 1)};
    if (GetParam()) wind.tick = tick + tick / 40 * (tick % 7);
    grid.step(wind, kGridTick_s);
    grid.sample(0, places.east_m_s, places.south_m_s);
    for (std::size_t i = 0; i < places.x_m.size(); ++i) {
      const double speed_m_s = static_cast<double>(std::hypot(places.east_m_s[i], places.south_m_s[i]));
      ASSERT_LE(speed_m_s, kStrongestSceneWind_m_s * (1.0 + 1e-5));
      const double step_m_s =
          static_cast<double>(std::hypot(places.east_m_s[i] - east_before[i], places.south_m_s[i] - south_before[i]));
      ASSERT_LE(step_m_s, bound_m_s * (1.0 + 1e-5));
      largest_m_s = std::max(largest_m_s, step_m_s);
    }
    east_before = places.east_m_s;
    south_before = places.south_m_s;
  }
  EXPECT_GT(largest_m_s, 0.05 * bound_m_s);
}

/// The wind at places as the same gusts pass, read at each tick or part by part.
struct PassingGusts {
  explicit PassingGusts(double side_m, bool has_number)
      : places(side_m), grid(shared_gusts(), places.x_m, places.z_m, best_simd_row()) {
    constexpr int kWarmUpTicks = 60;
    constexpr int kTicks = 600;
    GustyWind gusty({6.0, 3.0}, 0.5F);
    for (int tick = 0; tick < kWarmUpTicks + kTicks; ++tick) {
      wind::ground::Wind wind = gusty.step(kGridTick_s);
      if (!has_number) wind.tick.reset();
      grid.step(wind, kGridTick_s);
      grid.sample(0, places.east_m_s, places.south_m_s);
      if (tick >= kWarmUpTicks) series.push_back(places.east_m_s);
    }
  }
  double largest_change_m_s() const {
    float largest = 0.0F;
    for (std::size_t tick = 1; tick < series.size(); ++tick) {
      for (std::size_t i = 0; i < series[tick].size(); ++i) {
        largest = std::max(largest, std::abs(series[tick][i] - series[tick - 1][i]));
      }
    }
    return static_cast<double>(largest);
  }

  Places places;
  WindGrid grid;
  std::vector<std::vector<float>> series;  ///< of each tick, the wind to the east at each place
};

TEST(WindGrid, GustsThatAreReadPartByPartComeNeitherLaterNorWeakerNorInSteps) {
  for (const double side_m : {7.0, 126.0}) {
    const PassingGusts at_once(side_m, false);
    const PassingGusts in_parts(side_m, true);
    double scatter = 0.0, scatter_in_parts = 0.0, squares = 0.0, slope_squares = 0.0, difference_by_slope = 0.0;
    for (std::size_t tick = 1; tick + 1 < at_once.series.size(); ++tick) {
      for (std::size_t i = 0; i < at_once.series[tick].size(); ++i) {
        const auto value = [&](const PassingGusts& run, std::size_t at) {
          return static_cast<double>(run.series[at][i]) - 6.0;
        };
        const double slope_m_s2 = (value(at_once, tick + 1) - value(at_once, tick - 1)) / (2.0 * kGridTick_s);
        const double difference = value(in_parts, tick) - value(at_once, tick);
        scatter += value(at_once, tick) * value(at_once, tick);
        scatter_in_parts += value(in_parts, tick) * value(in_parts, tick);
        squares += difference * difference;
        slope_squares += slope_m_s2 * slope_m_s2;
        difference_by_slope += difference * slope_m_s2;
      }
    }
    EXPECT_GT(scatter, 0.0);
    EXPECT_NE(at_once.series.back(), in_parts.series.back());
    // They differ by a delay, and by little else.
    EXPECT_LT(std::sqrt(squares / slope_squares), 0.014) << "s, " << side_m;
    EXPECT_NEAR(scatter_in_parts / scatter, 1.0, 0.01) << side_m;
    // The quicker filter behind the straight lines is some 10 ms less late.
    EXPECT_NEAR(-difference_by_slope / slope_squares, -0.010, 0.004) << "s of delay, " << side_m;
    EXPECT_LT(in_parts.largest_change_m_s(), 1.1 * at_once.largest_change_m_s()) << side_m;
  }
}

TEST(WindGrid, SkippedTicksLeaveNoLineBehind) {
  // A steady wind that turned while ticks were skipped: all nodes have it once each part has been read.
  Places places(7.0);
  WindGrid grid(shared_gusts(), places.x_m, places.z_m, best_simd_row());
  wind::ground::Wind wind(wind::Vector{5.0, 0.0});
  std::uint64_t tick = 0;
  const auto step = [&](std::uint64_t ticks) {
    tick += ticks;
    wind.tick = tick;
    grid.step(wind, static_cast<double>(ticks) * kGridTick_s);
  };
  for (int i = 0; i < 120; ++i) step(1);
  wind.everywhere = {0.0, -4.0};
  for (int i = 0; i < 60; ++i) step(2);  // odd parts fall on skipped ticks
  grid.sample(0, places.east_m_s, places.south_m_s);
  for (std::size_t i = 0; i < places.x_m.size(); ++i) {
    EXPECT_NEAR(places.east_m_s[i], 0.0F, 1e-4F);
    EXPECT_NEAR(places.south_m_s[i], 4.0F, 1e-4F);
  }
}

/// A wind toward north of 6 m/s that has been measured for half a minute south of the places, and stands still now.
struct MeasuredGround {
  explicit MeasuredGround(std::vector<wind::Vector> pens, float noise_m_s) : run(std::move(pens)) {
    run.blow({0.0, 6.0});
    for (int tick = 0; tick < 1860; ++tick) {  // which ends in a gust
      run.tick(tapes, [tick](std::size_t pen, wind::ground::WindSample& now) {
        for (std::size_t band = 2; band < 8; ++band) {
          const double phase =
              2.0 * std::numbers::pi * wind::turbulence::OctaveFollower::centre_hz(band) * tick * StrokeRun::kTick_s +
              static_cast<double>(pen);
          now.north_m_s[band] = static_cast<float>(0.5 * std::sin(phase));
          now.east_m_s[band] = static_cast<float>(0.3 * std::cos(phase));
        }
        now.known_along.fill(0.7F);
        now.known_across.fill(0.5F);
      });
    }
    ground.gusts.ahead = {0.0, 1.0};
    ground.gusts.carried = shared_gusts()->begin(5);
    ground.gusts.along_m_s.fill(noise_m_s);
    ground.gusts.across_m_s.fill(noise_m_s);
    ground.tapes = &tapes;
  }
  StrokeRun run;
  wind::ground::WindTapes tapes;
  wind::ground::Wind ground;
};

TEST(WindGrid, EachPlaceHasWhatWasMeasuredForIt) {
  const std::vector<std::vector<wind::Vector>> pens = {{{-17.0, 30.0}}, {{-25.0, 25.0}, {-10.0, 8.0}}};
  for (const auto& of_pens : pens) {
    for (const float noise_m_s : {0.0F, 0.3F}) {
      MeasuredGround measured(of_pens, noise_m_s);
      Places places(7.0);
      WindGrid grid(shared_gusts(), places.x_m, places.z_m, best_simd_row());
      for (int tick = 0; tick < 240; ++tick) grid.step(measured.ground, kGridTick_s);
      grid.sample(0, places.east_m_s, places.south_m_s);
      const wind::ground::Wind expected = held(measured.ground, 0.5);
      double squares = 0.0;
      double scatter = 0.0;
      for (std::size_t i = 0; i < places.x_m.size(); ++i) {
        const wind::Vector there =
            expected.at(*shared_gusts(), static_cast<double>(places.x_m[i]), static_cast<double>(places.z_m[i]));
        squares += std::pow(static_cast<double>(places.east_m_s[i]) - there.u_m_s, 2) +
                   std::pow(-static_cast<double>(places.south_m_s[i]) - there.v_m_s, 2);
        scatter += std::pow(there.u_m_s, 2) + std::pow(there.v_m_s - 6.0, 2);
      }
      EXPECT_GT(scatter, 0.02 * static_cast<double>(places.x_m.size()));
      EXPECT_LT(squares, 0.02 * scatter) << of_pens.size() << " pens, noise of " << noise_m_s << " m/s";
    }
  }
}

TEST(SceneWind, WithoutNoiseASceneFeelsWhatWasMeasuredAndOfTheMeanAloneNothingElse) {
  MeasuredGround measured({{0.0, 30.0}}, 0.4F);
  const Placement placement{};
  Wind all(placement);
  Wind mean(placement, nullptr, WindPart::kMean);
  for (int tick = 0; tick < 240; ++tick) {
    all.step(measured.ground, kGridTick_s);
    mean.step(measured.ground, kGridTick_s);
  }
  const wind::Vector expected = measured.ground.measured_at(0.0, 0.0);
  EXPECT_NEAR(all.east_m_s(), expected.u_m_s, 1e-3);
  EXPECT_NEAR(-all.south_m_s(), expected.v_m_s, 1e-3);
  EXPECT_GT(speed_of(expected - wind::Vector{0.0, 6.0}), 0.03);
  EXPECT_NEAR(mean.east_m_s(), 0.0, 1e-3);
  EXPECT_NEAR(-mean.south_m_s(), 6.0, 1e-3);
}

}  // namespace
}  // namespace yuragi::scenes
