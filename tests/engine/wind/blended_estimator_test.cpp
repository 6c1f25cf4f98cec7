#include "engine/wind/blended_estimator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

constexpr double kBlendTick_s = 1.0 / 60.0;

/// An estimator, and a wind that is read every now and then.
class Blend {
 public:
  explicit Blend(std::uint64_t seed = 1, std::size_t sources = 1)
      : estimator_(sources,
                   {.climate = {.mean_speed_m_s = 4.0,
                                .mean_direction_deg = 180.0,
                                .turbulence_intensity = 0.2,
                                .seed = seed}},
                   noise()) {}

  MonoTime now() const { return now_; }
  WindState state() const { return state_; }
  BlendedEstimator& estimator() { return estimator_; }

  bool read(double speed_m_s, std::optional<double> direction_deg, std::size_t source = 0) {
    WindReading reading;
    reading.time.mono = now_;
    reading.speed_m_s = speed_m_s;
    reading.direction_deg = direction_deg;
    return estimator_.accept(source, reading);
  }

  /// Goes on for so long; `each` is called at each tick.
  void run_for(double duration_s, const std::function<void(const WindState&)>& each = {}) {
    const auto ticks = static_cast<int>(std::lround(duration_s / kBlendTick_s));
    for (int tick = 0; tick < ticks; ++tick) {
      now_ += from_seconds(kBlendTick_s);
      const WindVector before = state_.wind;
      state_ = estimator_.advance(now_);
      largest_step_m_s_ = std::max(largest_step_m_s_, speed_of(state_.wind - before));
      if (each) each(state_);
    }
  }
  double take_largest_step_m_s() { return std::exchange(largest_step_m_s_, 0.0); }

 private:
  static std::shared_ptr<const GustNoise> noise() {
    static const auto shared = std::make_shared<const GustNoise>(GustNoiseSettings{});
    return shared;
  }

  BlendedEstimator estimator_;
  MonoTime now_{std::chrono::hours(1)};
  WindState state_;
  double largest_step_m_s_ = 0.0;
};

/// Mean, and variance about it, of the states of a while.
struct Moments {
  WindVector sum{};
  double squares = 0.0;
  int count = 0;
  void add(const WindState& state) {
    sum = sum + state.wind;
    squares += state.wind.u_m_s * state.wind.u_m_s + state.wind.v_m_s * state.wind.v_m_s;
    ++count;
  }
  WindVector mean() const { return (1.0 / count) * sum; }
  double variance() const { return squares / count - std::pow(speed_of(mean()), 2); }
};

TEST(BlendedEstimator, WithoutASensorIsTheClimate) {
  double mean = 0.0;
  double variance = 0.0;
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Blend blend(seed);
    Moments moments;
    blend.run_for(600.0, [&](const WindState& state) { moments.add(state); });
    EXPECT_EQ(blend.state().source, WindSource::kDefault);
    EXPECT_EQ(blend.state().live_weight, 0.0);
    mean += moments.mean().v_m_s / kSeeds;
    variance += moments.variance() / kSeeds;
  }
  EXPECT_NEAR(mean, 4.0, 0.2);  // from south: toward north
  EXPECT_NEAR(variance, 0.64 + 0.64 * 0.64, 0.25);
}

TEST(BlendedEstimator, FollowsASteadySensorAndMovesAboutIt) {
  Blend blend;
  Moments moments;
  for (int i = 0; i < 120; ++i) {
    blend.read(8.0, 270.0);
    blend.run_for(1.0, [&](const WindState& state) {
      if (i > 20) moments.add(state);
    });
  }
  EXPECT_NEAR(moments.mean().u_m_s, 8.0, 0.2);
  EXPECT_NEAR(moments.mean().v_m_s, 0.0, 0.2);
  EXPECT_EQ(blend.state().source, WindSource::kLive);
  EXPECT_GT(blend.state().live_weight, 0.99);
}

TEST(BlendedEstimator, PassesThroughNorthAndNotThroughSouth) {
  Blend blend;
  for (int i = 0; i < 60; ++i) {
    blend.read(6.0, 350.0);
    blend.run_for(1.0);
  }
  double furthest_from_north_deg = 0.0;
  for (int i = 0; i < 60; ++i) {
    blend.read(6.0, 10.0);
    blend.run_for(1.0, [&](const WindState& state) {
      const double from_deg = direction_from_deg(state.wind);
      furthest_from_north_deg = std::max(furthest_from_north_deg, std::min(from_deg, 360.0 - from_deg));
    });
  }
  EXPECT_LT(furthest_from_north_deg, 75.0) << "10 degrees and the gusts' own swing";
}

TEST(BlendedEstimator, ALossAndAReturnMoveItNoMoreThanItMovesAnyway) {
  double usual_m_s = 0.0;
  double unusual_m_s = 0.0;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Blend blend(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    double gust_m_s = 0.0;  // that lasts for about 8 s
    const auto speak_for = [&](int readings) {
      for (int i = 0; i < readings; ++i) {
        gust_m_s = 0.88 * gust_m_s + 0.47 * 1.5 * normal(random);
        blend.read(std::max(0.0, 9.0 + gust_m_s), 200.0);
        blend.run_for(1.0);
      }
    };
    speak_for(10);
    blend.take_largest_step_m_s();
    speak_for(200);
    usual_m_s += blend.take_largest_step_m_s() / kSeeds;
    blend.run_for(100.0);  // silence
    EXPECT_EQ(blend.estimator().report(0).health, SourceHealth::kStale);
    EXPECT_LT(blend.state().live_weight, 0.9);
    speak_for(100);
    unusual_m_s += blend.take_largest_step_m_s() / kSeeds;
  }
  EXPECT_LE(unusual_m_s, usual_m_s);
}

TEST(BlendedEstimator, GoesOnMovingWhileTheSensorIsSilent) {
  double variance = 0.0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Blend blend(seed);
    for (int i = 0; i < 60; ++i) {
      blend.read(8.0, 180.0);
      blend.run_for(1.0);
    }
    blend.run_for(30.0);
    Moments silent;
    blend.run_for(100.0, [&](const WindState& state) { silent.add(state); });
    variance += silent.variance() / kSeeds;
  }
  // A steady sensor has told of little turbulence; the climate's returns.
  EXPECT_GT(variance, 0.05);
}

TEST(BlendedEstimator, FadesIntoTheClimateOverTheMeansMemory) {
  Blend blend;
  for (int i = 0; i < 200; ++i) {
    blend.read(12.0, 90.0);
    blend.run_for(1.0);
  }
  blend.run_for(3600.0);
  EXPECT_LT(blend.state().live_weight, 0.01);
  Moments moments;
  blend.run_for(600.0, [&](const WindState& state) { moments.add(state); });
  EXPECT_NEAR(moments.mean().v_m_s, 4.0, 0.6);
  EXPECT_NEAR(moments.mean().u_m_s, 0.0, 0.6);
}

TEST(BlendedEstimator, HandsOverToTheNextSourceAndBackWithoutAJump) {
  Blend blend(2, 2);
  const auto both_for = [&](int readings, bool first_speaks) {
    for (int i = 0; i < readings; ++i) {
      if (first_speaks) blend.read(8.0, 180.0, 0);
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
    Blend blend(seed, 2);
    for (int i = 0; i < 600; ++i) {
      WindReading reading;
      const auto jump_s = static_cast<double>(random() % 7) - 2.0;
      reading.time.mono = blend.now() + from_seconds(jump_s);
      reading.time.utc = UtcTime(std::chrono::hours(24 * static_cast<int>(random() % 8000)));
      reading.speed_m_s = speeds[random() % speeds.size()];
      if (random() % 3 != 0) reading.direction_deg = static_cast<double>(random() % 360);
      if (random() % 50 == 0) reading.direction_deg = std::nan("");
      blend.estimator().accept(random() % 3, reading);
      blend.run_for(kBlendTick_s * static_cast<double>(1 + random() % 60), [](const WindState& state) {
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
    Blend blend;
    for (int i = 0; i < 600; ++i) {
      blend.read(6.0 + 2.0 * std::sin(0.7 * i) + std::sin(2.3 * i), 90.0);
      blend.run_for(1.0);
    }
    const double learnt = blend.estimator().turbulence().intensity;
    for (int i = 0; i < 600; ++i) {
      WindReading reading;
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
  Blend blend;
  blend.read(5.0, 90.0);
  blend.run_for(5.0);
  const WindState before = blend.state();
  const WindState after = blend.estimator().advance(blend.now() - std::chrono::hours(87600));
  EXPECT_EQ(after.wind.u_m_s, before.wind.u_m_s);
  EXPECT_EQ(after.time, before.time);
}

TEST(BlendedEstimator, TheSameReadingsGiveTheSameWind) {
  const auto run = [](std::uint64_t seed) {
    Blend blend(seed);
    for (int i = 0; i < 30; ++i) {
      blend.read(5.0 + 0.1 * i, 90.0);
      blend.run_for(1.0);
    }
    return blend.state().wind;
  };
  EXPECT_EQ(run(1).u_m_s, run(1).u_m_s);
  EXPECT_NE(run(1).u_m_s, run(2).u_m_s);
}

}  // namespace
}  // namespace yuragi
