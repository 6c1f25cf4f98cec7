#include "engine/wind/ground/wind_tapes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/stroke_run.hpp"

namespace yuragi::wind::ground {
namespace {

/// A wind toward north of 7 m/s, one pen in the middle, and gusts that have been alike for long.
struct OnePen {
  explicit OnePen(double gust_m_s = 1.0, double known = 0.9) : run({{0.0, 0.0}}) {
    run.run_for(tapes, 60.0, steady_gusts(gust_m_s, known));
  }
  StrokeRun run;
  WindTapes tapes;
};

/// What the law leaves of all bands of 1 m/s each.
double bands_left(const GustCoherence& law, double distance_m) {
  double sum = 0.0;
  for (std::size_t band = 0; band < turbulence::OctaveFollower::kBands; ++band) {
    sum += std::exp(-distance_m * law.loss_per_m(turbulence::OctaveFollower::centre_hz(band)));
  }
  return sum;
}

void expect_same_reading(const WindTapes::Reading& one, const WindTapes::Reading& other, double tolerance) {
  EXPECT_NEAR(one.gusts.u_m_s, other.gusts.u_m_s, tolerance);
  EXPECT_NEAR(one.gusts.v_m_s, other.gusts.v_m_s, tolerance);
  EXPECT_NEAR(one.mean.u_m_s, other.mean.u_m_s, tolerance);
  EXPECT_NEAR(one.mean.v_m_s, other.mean.v_m_s, tolerance);
  EXPECT_NEAR(one.way.u_m_s, other.way.u_m_s, tolerance);
  EXPECT_NEAR(one.gain, other.gain, tolerance);
  for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
    EXPECT_NEAR(one.noise_along[i], other.noise_along[i], tolerance) << i;
    EXPECT_NEAR(one.noise_across[i], other.noise_across[i], tolerance) << i;
  }
}

bool is_finite(const WindTapes::Reading& reading) {
  const auto all_finite = [](const OctaveLanes& lanes) {
    return std::ranges::all_of(lanes, [](float factor) { return factor >= 0.0F && factor <= 1.0F; });
  };
  return std::isfinite(speed_of(reading.mean)) && std::isfinite(speed_of(reading.way)) &&
         std::isfinite(speed_of(reading.gusts)) && std::isfinite(reading.gain) && all_finite(reading.noise_along) &&
         all_finite(reading.noise_across);
}

TEST(WindTapes, NothingIsWrittenUntilSomethingCanBeMeasured) {
  WindTapes tapes;
  EXPECT_FALSE(tapes.is_written());
  tapes.write(WindStroke{});
  EXPECT_FALSE(tapes.is_written());
  OnePen one;
  EXPECT_TRUE(one.tapes.is_written());
}

TEST(WindTapes, AtThePenAllIsAsItIsMeasured) {
  OnePen one(1.0, 0.9);
  const WindTapes::Reading reading = one.tapes.at(0.0, 0.0);
  EXPECT_NEAR(reading.gusts.v_m_s, 13.0, 1e-5);
  EXPECT_NEAR(reading.mean.v_m_s, 7.0, 1e-12);
  for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
    EXPECT_NEAR(reading.noise_along[i], std::sqrt(0.1), 1e-5) << i;
    EXPECT_NEAR(reading.noise_across[i], std::sqrt(0.1), 1e-5) << i;
  }
  expect_same_reading(reading, WindTapes::at_pen(one.run.pen(0).now), 1e-5);
}

TEST(WindTapes, DownwindBesideAndUpwindGustsAreLostAsTheLawSays) {
  OnePen one;
  const GustCoherence& law = one.run.stroke().coherence;
  for (const double away_m : {0.1, 0.5, 2.0, 7.0, 20.0, 60.0}) {
    // Between the table's rows it is read linearly: within 1 %.
    const double downwind = bands_left(law, law.distance_m(away_m, 0.0));
    EXPECT_NEAR(one.tapes.at(0.0, -away_m).gusts.v_m_s, downwind, 0.01 * downwind) << away_m;
    const double across = bands_left(law, law.distance_m(0.0, away_m));
    EXPECT_NEAR(one.tapes.at(away_m, 0.0).gusts.v_m_s, across, 0.02 * across) << away_m;
    EXPECT_NEAR(one.tapes.at(-away_m, 0.0).gusts.v_m_s, one.tapes.at(away_m, 0.0).gusts.v_m_s, 1e-4);
    const double upwind = bands_left(law, away_m);
    EXPECT_NEAR(one.tapes.at(0.0, away_m).gusts.v_m_s, upwind, 0.02 * upwind) << away_m;
  }
}

TEST(WindTapes, TheNoiseGrowsWithTheDistanceInEachOctaveInEveryDirection) {
  OnePen one(1.0, 0.95);
  for (const Vector toward :
       {Vector{0.0, -1.0}, Vector{1.0, 0.0}, Vector{0.0, 1.0}, Vector{0.6, -0.8}, Vector{-0.6, 0.8}}) {
    WindTapes::Reading before = one.tapes.at(0.0, 0.0);
    for (int step = 0; step < 157; ++step) {
      const double away_m = 0.01 * std::pow(1.07, step);  // to 400 m
      const WindTapes::Reading now = one.tapes.at(away_m * toward.u_m_s, away_m * toward.v_m_s);
      for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
        ASSERT_GE(now.noise_along[i], before.noise_along[i] - 1e-6F) << i << ' ' << away_m;
        ASSERT_LE(now.noise_along[i], 1.0F);
      }
      before = now;
    }
    EXPECT_NEAR(before.noise_along[turbulence::GustNoise::kTileOctaves - 1], 1.0F, 1e-3F)
        << "the shortest waves are lost";
  }
}

TEST(WindTapes, WhatIsLostTheNoiseHasInPower) {
  // Of a sensor that has a single band, an octave has lost what that band has lost.
  constexpr std::size_t kBand = 6;
  StrokeRun run({{0.0, 0.0}});
  WindTapes tapes;
  run.pen(0).weights.fill(0.0);
  run.pen(0).weights[1 + kBand] = 1.0;
  run.run_for(tapes, 60.0, [](std::size_t, WindSample& now) {
    now.north_m_s[kBand] = 1.0F;
    now.known_along.fill(1.0F);
  });
  for (const double away_m : {0.0, 1.0, 7.0, 30.0, 100.0}) {
    const WindTapes::Reading reading = tapes.at(0.2 * away_m, -away_m);
    for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
      const double noise = static_cast<double>(reading.noise_along[i]);
      EXPECT_NEAR(reading.gusts.v_m_s * reading.gusts.v_m_s + noise * noise, 1.0, 0.01) << i << ' ' << away_m;
    }
    EXPECT_NEAR(reading.noise_across[0], 1.0F, 1e-6F) << "across, nothing was known";
  }
}

TEST(WindTapes, AGustArrivesAsLateAsItsWayTakesAndCutAsItWas) {
  StrokeRun run({{0.0, 20.0}});
  run.stroke().coherence.decay_along = 0.5;
  WindTapes tapes;
  run.take_only(2);
  constexpr double kGust_at_s = 50.0;
  double arrived_s = 0.0;
  double cut_s = 0.0;
  for (int tick = 0; tick < 60 * 70; ++tick) {
    const double time_s = tick * StrokeRun::kTick_s;
    run.tick(tapes, [time_s](std::size_t, WindSample& now) {
      now.north_m_s[2] = time_s >= kGust_at_s ? 1.0F : 0.0F;
      now.gain = time_s >= kGust_at_s ? 0.5 : 1.0;
    });
    const WindTapes::Reading reading = tapes.at(0.0, -15.0);
    if (arrived_s == 0.0 && reading.gusts.v_m_s > 0.4) arrived_s = time_s;
    if (cut_s == 0.0 && reading.gain < 0.75) cut_s = time_s;
  }
  EXPECT_NEAR(arrived_s - kGust_at_s, 35.0 / 7.0, 0.04);
  EXPECT_NEAR(cut_s - kGust_at_s, 35.0 / 7.0, 0.04);
}

TEST(WindTapes, WhereTheWindHasTurnedWhatWasMeasuredBeforeIsElsewhere) {
  OnePen one;
  const double straight_m_s = one.tapes.at(20.0, 0.0).gusts.v_m_s;
  // Toward east from now on: a place 20 m east reads what is 20 m old, which the old wind has taken north.
  one.run.blow({7.0, 0.0});
  one.run.tick(one.tapes, steady_gusts(1.0, 0.9));
  const GustCoherence& law = one.run.stroke().coherence;
  const double elsewhere = bands_left(law, law.distance_m(20.0, std::sqrt(2.0) * 20.0));
  EXPECT_NEAR(one.tapes.at(20.0, 0.0).gusts.v_m_s, elsewhere, 0.03 * elsewhere + 0.1);
  EXPECT_LT(one.tapes.at(20.0, 0.0).gusts.v_m_s, straight_m_s);
  // When the new wind has blown so far, all is as in a steady wind.
  one.run.run_for(one.tapes, 3.0, steady_gusts(1.0, 0.9));
  const double again = bands_left(law, law.distance_m(20.0, 0.0));
  EXPECT_NEAR(one.tapes.at(20.0, 0.0).gusts.v_m_s, again, 0.01 * again);
}

TEST(WindTapes, TowardTheEndOfTheTapeAllBecomesNoiseWithoutAnEdge) {
  OnePen one(1.0, 0.9);
  EXPECT_GT(one.tapes.at(0.0, -238.0).gusts.v_m_s, 1.0) << "weather";
  double before = one.tapes.at(0.0, -238.0).gusts.v_m_s;
  for (int step = 0; step < 248; ++step) {
    const double away_m = 238.0 + 0.25 * step;
    const double now = one.tapes.at(0.0, -away_m).gusts.v_m_s;
    ASSERT_LT(std::abs(now - before), 0.1);
    before = now;
  }
  const WindTapes::Reading beyond = one.tapes.at(0.0, -300.0);
  EXPECT_EQ(beyond.gusts.v_m_s, 0.0);
  EXPECT_NEAR(beyond.mean.v_m_s, 7.0, 1e-12);
  for (std::size_t i = 0; i < kTileOctaveCount; ++i) EXPECT_EQ(beyond.noise_along[i], 1.0F);
}

TEST(WindTapes, IsContinuousOverTheGround) {
  OnePen one;
  for (const Vector toward : {Vector{0.0, -1.0}, Vector{1.0, 0.0}, Vector{-0.6, 0.8}}) {
    double before = one.tapes.at(-5.0 * toward.u_m_s, -5.0 * toward.v_m_s).gusts.v_m_s;
    for (int step = -5000; step < 5000; ++step) {
      const double away_m = 0.001 * step;
      const double now = one.tapes.at(away_m * toward.u_m_s, away_m * toward.v_m_s).gusts.v_m_s;
      ASSERT_LT(std::abs(now - before), 0.05) << away_m;
      before = now;
    }
  }
}

/// Bands that swing, each in its own time, differently at each pen.
std::function<void(std::size_t, WindSample&)> swinging_gusts(double time_s, double known = 0.9) {
  return [time_s, known](std::size_t pen, WindSample& now) {
    for (std::size_t band = 0; band < 8; ++band) {
      const double phase = 6.28 * turbulence::OctaveFollower::centre_hz(band) * time_s + 1.7 * static_cast<double>(pen);
      now.east_m_s[band] = static_cast<float>(0.3 * std::sin(phase));
      now.north_m_s[band] = static_cast<float>(0.5 * std::cos(phase));
    }
    now.known_along.fill(static_cast<float>(known));
    now.known_across.fill(static_cast<float>(0.5 * known));
  };
}

TEST(WindTapes, WhatIsDroppedNowAndThenIsReadAsAStraightLine) {
  for (const int every : {2, 10}) {
    StrokeRun run({{0.0, 10.0}});
    run.take_only(3);
    WindTapes all;
    WindTapes some;
    double largest_m_s = 0.0;
    double swing_m_s = 0.0;
    for (int tick = 0; tick < 3600; ++tick) {
      run.tick(all, [&](std::size_t, WindSample& now) {
        now.north_m_s[3] = static_cast<float>(std::sin(6.28 * 0.25 * tick * StrokeRun::kTick_s));
      });
      if (tick % every != 0) continue;
      some.write(run.stroke());
      for (const double away_m : {0.3, 3.0, 20.0}) {
        const double gust_m_s = all.at(0.0, 10.0 - away_m).gusts.v_m_s;
        swing_m_s = std::max(swing_m_s, std::abs(gust_m_s));
        largest_m_s = std::max(largest_m_s, std::abs(gust_m_s - some.at(0.0, 10.0 - away_m).gusts.v_m_s));
      }
    }
    EXPECT_GT(swing_m_s, 0.8);
    // A sine of w under a straight line of t: at most (w t)^2 / 8 off; samples of the tape have such lines, too.
    const double turn_rad = 6.28 * 0.25 * std::max(every * StrokeRun::kTick_s, WindTape::kStep_m / 7.0);
    EXPECT_LT(largest_m_s, 2.5 * turn_rad * turn_rad / 8.0) << every;
  }
}

TEST(WindTapes, TwoThatHearTheSameHaveTheSameBits) {
  StrokeRun run({{0.0, 10.0}, {7.0, -3.0}});
  WindTapes one;
  WindTapes other;
  for (int tick = 0; tick < 600; ++tick) {
    run.tick(one, swinging_gusts(tick * StrokeRun::kTick_s));
    other.write(run.stroke());
    const WindTapes::Reading first = one.at(3.0, -4.0);
    const WindTapes::Reading second = other.at(3.0, -4.0);
    ASSERT_EQ(first.gusts.u_m_s, second.gusts.u_m_s);
    ASSERT_EQ(first.gusts.v_m_s, second.gusts.v_m_s);
    ASSERT_EQ(first.noise_along, second.noise_along);
    ASSERT_EQ(first.noise_across, second.noise_across);
  }
}

/// The wind where each of these stands is what it measures, but for what is weather to the law.
void expect_each_has_its_own(const std::vector<Vector>& places) {
  StrokeRun run(places);
  WindTapes tapes;
  for (int tick = 0; tick < 3600; ++tick) {
    const auto swinging = swinging_gusts(tick * StrokeRun::kTick_s);
    run.tick(tapes, [&swinging](std::size_t pen, WindSample& now) {
      swinging(pen, now);
      now.east_m_s[0] = now.east_m_s[1] = now.north_m_s[0] = now.north_m_s[1] = 0.0F;
    });
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const WindTapes::Reading there = tapes.at(run.pen(i).east_m, run.pen(i).south_m);
    const WindTapes::Reading measured = WindTapes::at_pen(run.pen(i).now);
    EXPECT_NEAR(there.gusts.u_m_s, measured.gusts.u_m_s, 0.05) << i;
    EXPECT_NEAR(there.gusts.v_m_s, measured.gusts.v_m_s, 0.05) << i;
    for (std::size_t octave = 3; octave < turbulence::GustNoise::kTileOctaves; ++octave) {
      EXPECT_NEAR(there.noise_along[octave], measured.noise_along[octave], 0.03F) << i << ' ' << octave;
    }
  }
}

TEST(WindTapesOfSeveral, SideBySideEachHasTheWindThatItMeasures) {
  expect_each_has_its_own({{-12.0, 4.0}, {0.0, 4.0}, {30.0, 4.0}});
}

TEST(WindTapesOfSeveral, BehindEachOtherEachHasTheWindThatItMeasures) {
  expect_each_has_its_own({{0.0, 15.0}, {0.0, -15.0}});
  expect_each_has_its_own({{-12.0, 4.0}, {9.0, -6.0}, {0.0, 15.0}});
}

TEST(WindTapesOfSeveral, OneThatFadesLeavesWhatTheOtherAloneSays) {
  StrokeRun two({{0.0, 10.0}, {6.0, 2.0}});
  StrokeRun one({{0.0, 10.0}});
  WindTapes of_two;
  WindTapes of_one;
  for (int tick = 0; tick < 1800; ++tick) {
    two.tick(of_two, swinging_gusts(tick * StrokeRun::kTick_s));
    one.tick(of_one, swinging_gusts(tick * StrokeRun::kTick_s));
  }
  two.pen(1).presence = 0.0;
  of_two.write(two.stroke());
  of_one.write(one.stroke());
  for (const double south_m : {10.0, 4.0, -3.0, -40.0, 30.0}) {
    for (const double east_m : {0.0, 6.0, -8.0}) {
      expect_same_reading(of_two.at(east_m, south_m), of_one.at(east_m, south_m), 0.01);
    }
  }
}

TEST(WindTapesOfSeveral, SensorsAtOnePlaceAreAsOne) {
  StrokeRun three({{0.0, 10.0}, {0.0, 10.0}, {0.0, 10.0}});
  StrokeRun one({{0.0, 10.0}});
  WindTapes of_three;
  WindTapes of_one;
  for (int tick = 0; tick < 1800; ++tick) {
    const auto same = swinging_gusts(tick * StrokeRun::kTick_s);
    three.tick(of_three, [&same](std::size_t, WindSample& now) { same(0, now); });
    one.tick(of_one, same);
  }
  for (const double south_m : {10.0, 9.9, 0.0, -40.0, 30.0}) {
    expect_same_reading(of_three.at(2.0, south_m), of_one.at(2.0, south_m), 0.01);
  }
}

TEST(WindTapesOfSeveral, AMirroredGroundHasAMirroredWind) {
  StrokeRun left({{-8.0, 3.0}, {5.0, 9.0}, {11.0, -2.0}});
  StrokeRun right({{8.0, 3.0}, {-5.0, 9.0}, {-11.0, -2.0}});
  WindTapes of_left;
  WindTapes of_right;
  for (int tick = 0; tick < 1800; ++tick) {
    const auto same = swinging_gusts(tick * StrokeRun::kTick_s);
    left.tick(of_left, same);
    right.tick(of_right, same);
  }
  for (const double east_m : {-30.0, -8.0, 0.0, 3.0, 11.0}) {
    expect_same_reading(of_left.at(east_m, -5.0), of_right.at(-east_m, -5.0), 1e-3);
  }
}

TEST(WindTapes, WhateverIsWrittenIsReadAsFiniteNumbers) {
  std::mt19937 random(9);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
  };
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Vector> places;
    for (int i = 0; i <= trial % 4; ++i) {
      places.push_back(trial % 3 == 0 ? Vector{1.0, 2.0} : Vector{uniform(-50.0, 50.0), uniform(-50.0, 50.0)});
    }
    StrokeRun run(places);
    WindTapes tapes;
    for (int tick = 0; tick < 120; ++tick) {
      const double speed_m_s = random() % 4 == 0 ? 0.0 : uniform(0.0, 75.0);
      const double angle_rad = uniform(0.0, 6.28);
      run.blow({speed_m_s * std::sin(angle_rad), speed_m_s * std::cos(angle_rad)});
      run.stroke().coherence.decay_along = uniform(0.5, 10.0);
      if (random() % 20 == 0) run.stroke().way_m += uniform(0.0, 1e6);
      if (random() % 30 == 0) run.stroke().way_m *= 0.5;
      for (std::size_t i = 0; i < places.size(); ++i) {
        run.pen(i).presence = random() % 3 == 0 ? 0.0 : uniform(0.0, 1.0);
        run.pen(i).weights.fill(random() % 3 == 0 ? 0.0 : uniform(0.0, 1.0));
      }
      run.tick(tapes, [&](std::size_t, WindSample& now) {
        for (float& gust_m_s : now.east_m_s) gust_m_s = static_cast<float>(uniform(-40.0, 40.0));
        now.known_along.fill(static_cast<float>(uniform(0.0, 1.0)));
        now.known_across.fill(static_cast<float>(uniform(0.0, 1.0)));
        now.gain = uniform(0.0, 1.0);
      });
      ASSERT_TRUE(is_finite(tapes.at(uniform(-500.0, 500.0), uniform(-500.0, 500.0)))) << trial << ' ' << tick;
      ASSERT_TRUE(is_finite(tapes.at(places[0].u_m_s, places[0].v_m_s))) << trial << ' ' << tick;
      ASSERT_TRUE(is_finite(tapes.at(1e9, -1e9))) << trial << ' ' << tick;
    }
  }
}

// A pen whose sensors have said nothing yet loses nothing of what they say next.
TEST(WindTapes, AtThePenAllIsKnownAtOnceWhenASensorBeginsToSpeak) {
  StrokeRun run({{0.0, 0.0}});
  WindTapes tapes;
  run.pen(0).weights.fill(0.0);
  run.run_for(tapes, 10.0, steady_gusts(0.0, 0.0));
  run.pen(0).weights.fill(1.0);
  run.tick(tapes, steady_gusts(1.0, 0.9));
  expect_same_reading(tapes.at(0.0, 0.0), WindTapes::at_pen(run.pen(0).now), 1e-5);
}

}  // namespace
}  // namespace yuragi::wind::ground
