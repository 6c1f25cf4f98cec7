#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "tests/engine/wind/blend/blend_run.hpp"

namespace yuragi::wind::blend {
namespace {

using Blend = BlendRun;
using Moments = BlendMoments;

Blend usual_blend(std::uint64_t seed = 1, std::size_t sources = 1) {
  return Blend(sources, Blend::usual(seed));
}

/// A climate of 3 m/s from west without turbulence, so that only what is heard moves the wind.
Blend calm_blend(std::size_t sources = 1) {
  return Blend(
      sources,
      {.climate = {.mean_speed_m_s = 3.0, .mean_direction_deg = 270.0, .turbulence_intensity = 0.0, .seed = 1}});
}

TEST(BlendedEstimator, ASourceThatIsNotThereIsSilentAndNotHeard) {
  Blend blend = usual_blend();
  EXPECT_FALSE(blend.read(5.0, 90.0, 7));
  EXPECT_EQ(blend.estimator().report(7).health, SourceHealth::kSilent);
}

TEST(BlendedEstimator, WithoutASensorIsTheClimate) {
  double mean = 0.0;
  double variance = 0.0;
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Blend blend = usual_blend(seed);
    Moments moments;
    blend.run_for(600.0, [&](const State& state) { moments.add(state); });
    EXPECT_EQ(blend.state().source, Source::kDefault);
    EXPECT_EQ(blend.state().live_weight, 0.0);
    mean += moments.mean().v_m_s / kSeeds;
    variance += moments.variance() / kSeeds;
  }
  EXPECT_NEAR(mean, 4.0, 0.2);  // from south: toward north
  EXPECT_NEAR(variance, 0.64 + 0.64 * 0.64, 0.25);
}

TEST(BlendedEstimator, FollowsASteadySensorAndMovesAboutIt) {
  Blend blend = usual_blend();
  Moments moments;
  for (int i = 0; i < 120; ++i) {
    blend.read(8.0, 270.0);
    blend.run_for(1.0, [&](const State& state) {
      if (i > 20) moments.add(state);
    });
  }
  EXPECT_NEAR(moments.mean().u_m_s, 8.0, 0.2);
  EXPECT_NEAR(moments.mean().v_m_s, 0.0, 0.2);
  EXPECT_EQ(blend.state().source, Source::kLive);
  EXPECT_GT(blend.state().live_weight, 0.99);
}

/// How strong the noise of gusts is along the wind where the sensor stands: the root of all octaves' power.
double gusts_along_m_s(Blend& blend) {
  double power = 0.0;
  for (const float strength_m_s : blend.estimator().gusts_at(0).along_m_s) {
    power += static_cast<double>(strength_m_s) * static_cast<double>(strength_m_s);
  }
  return std::sqrt(power);
}

TEST(BlendedEstimator, GustsDoNotBurstWhenWindRisesOutOfACalm) {
  for (const double interval_s : {1.0, 14.0}) {
    Blend blend = usual_blend();
    TestGusts gusts(3);
    const auto read_gusts = [&](double duration_s, const std::function<void(const State&)>& each) {
      for (double time_s = 0.0; time_s < duration_s; time_s += interval_s) {
        blend.read(5.0 * std::max(0.1, 1.0 + 0.2 * gusts.next()), 180.0);
        blend.run_for(interval_s, each);
      }
    };
    blend.read_for(182.0, interval_s, 0.1, 180.0);

    // Of 5 m/s and a fifth of it: 1 m/s; what the fit makes of the front itself is not much more than the front.
    double strongest_m_s = 0.0;
    double fastest_m_s = 0.0;
    read_gusts(420.0, [&](const State& state) {
      strongest_m_s = std::max(strongest_m_s, gusts_along_m_s(blend));
      fastest_m_s = std::max(fastest_m_s, speed_of(state.wind));
    });
    EXPECT_LT(strongest_m_s, 2.0) << interval_s << " s";
    EXPECT_LT(fastest_m_s, 12.0) << interval_s << " s";
  }
}

TEST(BlendedEstimator, BeginsWithTheSpeedOfTheFirstReading) {
  // The default wind is shown until somebody speaks, and then handed over from within the 3 s of a hand-over.
  for (const double interval_s : {1.0, 14.0}) {
    Blend blend = calm_blend();
    blend.run_for(2.0);
    blend.take_largest_step_m_s();
    blend.read(9.0, 270.0);
    blend.run_for(std::min(interval_s, 3.0));
    if (interval_s < 3.0) blend.read_for(2.0, 1.0, 9.0, 270.0);
    EXPECT_NEAR(blend.state().wind.u_m_s, 9.0, 0.1 * (9.0 - 3.0)) << interval_s;
    blend.run_for(1.0);
    EXPECT_NEAR(blend.state().wind.u_m_s, 9.0, 0.04 * (9.0 - 3.0)) << interval_s;
    // Nor is it doubted again until a slow one speaks for the second time.
    double least_trust = 1.0;
    blend.run_for(4.0);
    if (interval_s > 3.0) {
      blend.run_for(6.0, [&](const State& state) { least_trust = std::min(least_trust, state.live_weight); });
      blend.read(9.0, 270.0);
      blend.run_for(14.0, [&](const State& state) { least_trust = std::min(least_trust, state.live_weight); });
      EXPECT_GT(least_trust, 0.98);
    }
    // A critically damped way of 6 m/s: 0.37 * 6 * 4 / 3 s, in a tick.
    EXPECT_LT(blend.take_largest_step_m_s(), 0.37 * 6.0 * 4.0 / 3.0 * kBlendTick_s * 1.02);
  }
}

TEST(BlendedEstimator, ASourceHasTheGustsOfItsOwnLength) {
  // In a steady wind nothing is learnt of the gusts: they are what they are taken for.
  for (const double length_m : {0.0, 25.0, 85.0}) {
    Settings settings = Blend::usual();
    settings.length_m = 40.0;
    settings.sources = {{.length_m = length_m}};
    Blend blend(1, settings);
    blend.read_for(30.0, 1.0, 5.0, 180.0);
    const double expected_s = (length_m > 0.0 ? length_m : 40.0) / 5.0;
    EXPECT_NEAR(blend.estimator().turbulence().time_scale_s, expected_s, 0.08 * expected_s) << length_m;
  }
}

TEST(BlendedEstimator, WhatWasSaidBeforeItWasAskedIsTheWindAtOnce) {
  BlendedEstimator estimator(1, Blend::usual(1, 0.0), shared_gust_noise());
  Reading reading;
  reading.time.mono = MonoTime(std::chrono::hours(1));
  reading.speed_m_s = 9.0;
  reading.direction_deg = 270.0;
  ASSERT_TRUE(estimator.accept(0, reading));
  const State state = estimator.advance(reading.time.mono);
  EXPECT_EQ(state.source, Source::kLive);
  EXPECT_EQ(state.live_weight, 1.0);
  EXPECT_NEAR(state.wind.u_m_s, 9.0, 0.01);
  EXPECT_NEAR(state.wind.v_m_s, 0.0, 0.01);
}

TEST(BlendedEstimator, PassesThroughNorthAndNotThroughSouth) {
  Blend blend = usual_blend();
  for (int i = 0; i < 60; ++i) {
    blend.read(6.0, 350.0);
    blend.run_for(1.0);
  }
  double furthest_from_north_deg = 0.0;
  for (int i = 0; i < 60; ++i) {
    blend.read(6.0, 10.0);
    blend.run_for(1.0, [&](const State& state) {
      const double from_deg = direction_from_deg(state.wind);
      furthest_from_north_deg = std::max(furthest_from_north_deg, std::min(from_deg, 360.0 - from_deg));
    });
  }
  EXPECT_LT(furthest_from_north_deg, 75.0) << "10 degrees and the gusts' own swing";
}

TEST(BlendedEstimator, ALossAndAReturnMoveItNoMoreThanItMovesAnyway) {
  double usual_m_s = 0.0;
  double unusual_m_s = 0.0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Blend blend = usual_blend(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    double gust_m_s = 0.0;  // that lasts for about 8 s
    const auto send_for = [&](int readings) {
      for (int i = 0; i < readings; ++i) {
        gust_m_s = 0.88 * gust_m_s + 0.47 * 1.5 * normal(random);
        blend.read(std::max(0.0, 9.0 + gust_m_s), 200.0);
        blend.run_for(1.0);
      }
    };
    send_for(10);
    blend.take_largest_step_m_s();
    send_for(200);
    usual_m_s += blend.take_largest_step_m_s() / kSeeds;
    blend.run_for(100.0);  // silence
    EXPECT_EQ(blend.estimator().report(0).health, SourceHealth::kStale);
    EXPECT_LT(blend.state().live_weight, 0.9);
    send_for(100);
    unusual_m_s += blend.take_largest_step_m_s() / kSeeds;
  }
  EXPECT_LE(unusual_m_s, usual_m_s);
}

TEST(BlendedEstimator, GoesOnMovingWhileTheSensorIsSilent) {
  double variance = 0.0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Blend blend = usual_blend(seed);
    for (int i = 0; i < 60; ++i) {
      blend.read(8.0, 180.0);
      blend.run_for(1.0);
    }
    blend.run_for(30.0);
    Moments silent;
    blend.run_for(100.0, [&](const State& state) { silent.add(state); });
    variance += silent.variance() / kSeeds;
  }
  // A steady sensor has told of little turbulence; the climate's returns.
  EXPECT_GT(variance, 0.05);
}

TEST(BlendedEstimator, FadesIntoTheClimateOverTheMeansMemory) {
  Blend blend = usual_blend();
  for (int i = 0; i < 200; ++i) {
    blend.read(12.0, 90.0);
    blend.run_for(1.0);
  }
  blend.run_for(3600.0);
  EXPECT_LT(blend.state().live_weight, 0.01);
  Moments moments;
  blend.run_for(600.0, [&](const State& state) { moments.add(state); });
  EXPECT_NEAR(moments.mean().v_m_s, 4.0, 0.6);
  EXPECT_NEAR(moments.mean().u_m_s, 0.0, 0.6);
}

TEST(BlendedEstimator, HandsOverToTheNextSourceAndBackWithoutAJump) {
  Blend blend = usual_blend(2, 2);
  const auto both_for = [&](int readings, bool first_sends) {
    for (int i = 0; i < readings; ++i) {
      if (first_sends) blend.read(8.0, 180.0, 0);
      blend.read(7.0, 180.0, 1);
      blend.run_for(1.0);
    }
  };
  both_for(60, true);
  blend.take_largest_step_m_s();
  both_for(120, true);
  const double usual_m_s = blend.take_largest_step_m_s();
  both_for(60, false);
  both_for(60, true);
  EXPECT_LE(blend.take_largest_step_m_s(), 1.5 * usual_m_s + 0.37 * 4.0 / 3.0 * kBlendTick_s * 1.1);
}

TEST(BlendedEstimator, IsFiniteAndBoundedWhateverComesIn) {
  std::mt19937_64 random(11);
  const std::array<double, 10> speeds = {0.0, 3.0, 8.0, 119.0, 121.0, -1.0, 1e300, std::nan(""), 4.0, 55.0};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Blend blend = usual_blend(seed, 2);
    for (int i = 0; i < 600; ++i) {
      Reading reading;
      const auto jump_s = static_cast<double>(random() % 7) - 2.0;
      reading.time.mono = blend.now() + from_seconds(jump_s);
      reading.time.utc = UtcTime(std::chrono::hours(24 * static_cast<int>(random() % 8000)));
      reading.speed_m_s = speeds[random() % speeds.size()];
      if (random() % 3 != 0) reading.direction_deg = static_cast<double>(random() % 360);
      if (random() % 50 == 0) reading.direction_deg = std::nan("");
      blend.estimator().accept(random() % 3, reading);
      blend.run_for(kBlendTick_s * static_cast<double>(1 + random() % 60), [](const State& state) {
        ASSERT_TRUE(std::isfinite(state.wind.u_m_s) && std::isfinite(state.wind.v_m_s));
        ASSERT_LE(speed_of(state.wind), kMaxPlausibleSpeed_m_s * (1.0 + 1e-9));
        ASSERT_GE(state.live_weight, 0.0);
        ASSERT_LE(state.live_weight, 1.0);
      });
    }
  }
}

TEST(BlendedEstimator, WhatIsHeldIsNeitherSilenceNorSomethingToLearn) {
  // Ten minutes of a gusty wind, and then as many in which its last reading is held: by a sensor that says so, and by
  // one that seems to measure the same again and again.
  std::array<double, 2> intensity{};
  for (const bool says_so : {true, false}) {
    Blend blend = usual_blend();
    for (int i = 0; i < 600; ++i) {
      blend.read(6.0 + 2.0 * std::sin(0.7 * i) + std::sin(2.3 * i), 90.0);
      blend.run_for(1.0);
    }
    const double learnt = blend.estimator().turbulence().intensity;
    for (int i = 0; i < 600; ++i) {
      Reading reading;
      reading.time.mono = blend.now();
      reading.speed_m_s = 6.0;
      reading.direction_deg = 90.0;
      reading.is_held = says_so;
      blend.estimator().accept(0, reading);
      blend.run_for(1.0);
    }
    EXPECT_EQ(blend.estimator().report(0).health, SourceHealth::kLive);
    intensity[says_so ? 0 : 1] = blend.estimator().turbulence().intensity / learnt;
  }
  EXPECT_DOUBLE_EQ(intensity[0], 1.0);
  EXPECT_LT(intensity[1], 0.8);
}

TEST(BlendedEstimator, TimeThatGoesBackChangesNothing) {
  Blend blend = usual_blend();
  blend.read(5.0, 90.0);
  blend.run_for(5.0);
  const State before = blend.state();
  const State after = blend.estimator().advance(blend.now() - std::chrono::hours(87600));
  EXPECT_EQ(after.wind.u_m_s, before.wind.u_m_s);
  EXPECT_EQ(after.time, before.time);
}

TEST(BlendedEstimator, TheSameReadingsGiveTheSameWind) {
  const auto run = [](std::uint64_t seed) {
    Blend blend = usual_blend(seed);
    for (int i = 0; i < 30; ++i) {
      blend.read(5.0 + 0.1 * i, 90.0);
      blend.run_for(1.0);
    }
    return blend.state().wind;
  };
  EXPECT_EQ(run(1).u_m_s, run(1).u_m_s);
  EXPECT_NE(run(1).u_m_s, run(2).u_m_s);
}

// What the wind owes to every sensor, whatever the gusts: shown where there are none.

TEST(BlendedEstimator, IsTheDefaultWindWhileNoSensorSpeaks) {
  Blend blend = calm_blend();
  blend.run_for(10.0);
  EXPECT_EQ(blend.state().source, Source::kDefault);
  EXPECT_NEAR(blend.state().wind.u_m_s, 3.0, 0.01);
  EXPECT_NEAR(blend.state().wind.v_m_s, 0.0, 0.01);
  EXPECT_EQ(blend.report().health, SourceHealth::kSilent);
}

TEST(BlendedEstimator, ComesToWhatTheSensorSays) {
  Blend blend = calm_blend();
  blend.read_for(20.0, 1.0, 8.0, 180.0);
  EXPECT_EQ(blend.state().source, Source::kLive);
  EXPECT_NEAR(blend.state().wind.u_m_s, 0.0, 0.05);
  EXPECT_NEAR(blend.state().wind.v_m_s, 8.0, 0.05);
  EXPECT_EQ(blend.report().health, SourceHealth::kLive);
}

TEST(BlendedEstimator, MeasuresTheIntervalOfEachSource) {
  Blend blend = calm_blend(2);
  for (int second = 0; second < 60; ++second) {
    blend.read(5.0, 90.0, 0);
    if (second % 14 == 0) blend.read(6.0, 90.0, 1);
    blend.run_for(1.0);
  }
  EXPECT_NEAR(blend.report(0).interval_s, 1.0, 0.05);
  EXPECT_NEAR(blend.report(1).interval_s, 14.0, 0.3);
}

TEST(BlendedEstimator, OneLateReadingDoesNotChangeTheMeasuredInterval) {
  Blend blend = calm_blend();
  blend.read_for(10.0, 0.5, 5.0, 90.0);
  blend.run_for(2.0);
  blend.read(5.0, 90.0);
  EXPECT_NEAR(blend.report().interval_s, 0.5, 0.05);
}

TEST(BlendedEstimator, CallsASourceStaleAfterFiveOfItsOwnIntervals) {
  Blend blend = calm_blend();
  blend.read_for(20.0, 1.0, 8.0, 180.0);
  blend.run_for(3.5);
  EXPECT_EQ(blend.report().health, SourceHealth::kLive);
  blend.run_for(2.0);
  EXPECT_EQ(blend.report().health, SourceHealth::kStale);
  EXPECT_GT(blend.report().age_s, 5.0);
  ASSERT_TRUE(blend.report().last.has_value());
  EXPECT_EQ(blend.report().last->speed_m_s, 8.0) << "the last value is kept, apart from the state";
}

TEST(BlendedEstimator, ASlowSensorIsNotStaleBetweenItsReadings) {
  Blend blend = calm_blend();
  blend.read_for(48.0 * 6.0, 48.0, 8.0, 180.0);
  blend.run_for(100.0);
  EXPECT_EQ(blend.report().health, SourceHealth::kLive);
}

TEST(BlendedEstimator, ANewReadingBendsTheWindAndNeverSteps) {
  Blend blend = calm_blend();
  blend.read_for(20.0, 0.1, 2.0, 90.0);
  blend.take_largest_step_m_s();
  blend.read_for(10.0, 0.1, 12.0, 90.0);
  EXPECT_LT(blend.take_largest_step_m_s(), 5.0) << "readings every 0.1 s are believed up to about 5 Hz";
  EXPECT_NEAR(speed_of(blend.state().wind), 12.0, 0.3);
}

TEST(BlendedEstimator, AloneATurnFrom350To10DegreesPassesThroughNorth) {
  Blend blend = calm_blend();
  blend.read_for(60.0, 1.0, 6.0, 350.0);
  double furthest_from_north_deg = 0.0;
  double least_m_s = 6.0;
  blend.read_for(60.0, 1.0, 6.0, 10.0, 0, [&](const State& state) {
    const double from_deg = std::remainder(direction_from_deg(state.wind), 360.0);
    furthest_from_north_deg = std::max(furthest_from_north_deg, std::abs(from_deg));
    least_m_s = std::min(least_m_s, speed_of(state.wind));
  });
  EXPECT_LT(furthest_from_north_deg, 20.0) << "the turn itself is turbulence, as far as anyone can tell";
  EXPECT_GT(least_m_s, 5.0);
}

// A critically damped step of e moves at most 0.37 e w a second: here 11 m/s, w = 4 / 3 s.
TEST(BlendedEstimator, LossAndReturnHandOverWithoutAJump) {
  constexpr double kMaxStep_m_s = 0.37 * (4.0 / 3.0) * 11.0 * kBlendTick_s * 1.1;
  Settings settings = Blend::usual(1, 0.0);
  settings.mean_memory_s = 60.0;
  Blend blend(1, settings);
  blend.read_for(100.0, 0.5, 8.0, 90.0);
  blend.take_largest_step_m_s();
  blend.run_for(600.0);
  EXPECT_EQ(blend.state().source, Source::kDefault);
  EXPECT_NEAR(blend.state().wind.v_m_s, 4.0, 0.05);
  EXPECT_LT(blend.take_largest_step_m_s(), kMaxStep_m_s);

  blend.read_for(100.0, 0.5, 8.0, 90.0);
  EXPECT_EQ(blend.state().source, Source::kLive);
  EXPECT_NEAR(blend.state().wind.u_m_s, -8.0, 0.1);
  EXPECT_LT(blend.take_largest_step_m_s(), kMaxStep_m_s);
}

TEST(BlendedEstimator, FallsBackToTheNextLiveSourceAndReturnsToTheFirst) {
  Blend blend = calm_blend(2);
  const auto both_for = [&blend](double duration_s, bool first_sends) {
    for (int half = 0; half < static_cast<int>(2.0 * duration_s); ++half) {
      if (first_sends) blend.read(8.0, 90.0, 0);
      blend.read(4.0, 0.0, 1);
      blend.run_for(0.5);
    }
  };
  both_for(30.0, true);
  EXPECT_NEAR(blend.state().wind.u_m_s, -8.0, 0.1);
  blend.take_largest_step_m_s();
  both_for(30.0, false);
  EXPECT_NEAR(blend.state().wind.u_m_s, 0.0, 0.1);
  EXPECT_NEAR(blend.state().wind.v_m_s, -4.0, 0.1);
  both_for(40.0, true);
  EXPECT_NEAR(blend.state().wind.u_m_s, -8.0, 0.1);
  EXPECT_LT(blend.take_largest_step_m_s(), 0.37 * (4.0 / 3.0) * 9.0 * kBlendTick_s * 1.1);
}

TEST(BlendedEstimator, WithoutADirectionItKeepsTheLastOneOrTheDefaultOne) {
  Blend blend = calm_blend();
  blend.read_for(20.0, 1.0, 5.0, std::nullopt);
  EXPECT_NEAR(direction_from_deg(blend.state().wind), 270.0, 0.5);
  Blend lost = calm_blend();
  lost.read_for(60.0, 1.0, 5.0, 30.0);
  lost.read_for(60.0, 1.0, 5.0, std::nullopt);
  EXPECT_NEAR(direction_from_deg(lost.state().wind), 30.0, 0.5);
}

TEST(BlendedEstimator, RefusesWhatNoWindCanBe) {
  Blend blend = calm_blend();
  EXPECT_FALSE(blend.read(std::nan(""), 90.0));
  EXPECT_FALSE(blend.read(-1.0, 90.0));
  EXPECT_FALSE(blend.read(500.0, 90.0));
  EXPECT_FALSE(blend.read(5.0, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(blend.read(5.0, 360.0));
  EXPECT_FALSE(blend.estimator().accept(1, Reading{})) << "there is no source 1";
  EXPECT_EQ(blend.report().health, SourceHealth::kSilent);
}

TEST(BlendedEstimator, ALongHaltOfTheMachineLeavesItFinite) {
  Blend blend = calm_blend();
  blend.read_for(5.0, 0.1, 8.0, 180.0);
  const Vector before = blend.state().wind;
  blend.halt_for(std::chrono::hours(87600));
  blend.run_for(kBlendTick_s);
  EXPECT_LT(speed_of(blend.state().wind - before), 0.1) << "it goes on from where it was";
  EXPECT_EQ(blend.report().health, SourceHealth::kStale);
  blend.run_for(30.0);
  EXPECT_NEAR(blend.state().wind.u_m_s, 3.0, 0.01);
  EXPECT_NEAR(blend.state().wind.v_m_s, 0.0, 0.01);
  EXPECT_EQ(blend.state().source, Source::kDefault);
}

}  // namespace
}  // namespace yuragi::wind::blend
