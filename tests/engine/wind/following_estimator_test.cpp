#include "engine/wind/following_estimator.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

constexpr double kTick_s = 1.0 / 60.0;

/// Steps an estimator through time by hand and watches what it says.
class Scenario {
 public:
  explicit Scenario(std::size_t sources = 1, double default_turbulence = 0.0)
      : estimator_(sources, {.default_wind = {.mean_speed_m_s = 3.0,
                                              .mean_direction_deg = 270.0,
                                              .turbulence_intensity = default_turbulence,
                                              .seed = 1},
                             .handover_s = 3.0,
                             .stale_intervals = 5.0}) {
    state_ = estimator_.advance(at(0.0));
  }

  static MonoTime at(double time_s) { return MonoTime(from_seconds(1000.0 + time_s)); }

  bool read(double speed_m_s, std::optional<double> direction_deg, std::size_t source = 0) {
    WindReading reading;
    reading.time.mono = at(time_s_);
    reading.speed_m_s = speed_m_s;
    reading.direction_deg = direction_deg;
    return estimator_.accept(source, reading);
  }

  void tick() {
    time_s_ += kTick_s;
    const WindState next = estimator_.advance(at(time_s_));
    EXPECT_TRUE(std::isfinite(next.wind.u_m_s) && std::isfinite(next.wind.v_m_s));
    EXPECT_GE(next.live_weight, 0.0);
    EXPECT_LE(next.live_weight, 1.0);
    largest_step_m_s_ = std::max(largest_step_m_s_, speed_of(next.wind - state_.wind));
    state_ = next;
  }

  void run_for(double duration_s) {
    for (const double end_s = time_s_ + duration_s; time_s_ < end_s;) tick();
  }

  void read_for(double duration_s, double interval_s, double speed_m_s, std::optional<double> direction_deg,
                std::size_t source = 0) {
    for (const double end_s = time_s_ + duration_s; time_s_ < end_s;) {
      read(speed_m_s, direction_deg, source);
      run_for(interval_s);
    }
  }

  const WindState& state() const { return state_; }
  SourceReport report(std::size_t source = 0) const { return estimator_.report(source); }
  double largest_step_m_s() const { return largest_step_m_s_; }
  void forget_steps() { largest_step_m_s_ = 0.0; }
  FollowingEstimator& estimator() { return estimator_; }

 private:
  FollowingEstimator estimator_;
  WindState state_;
  double time_s_ = 0.0;
  double largest_step_m_s_ = 0.0;
};

TEST(FollowingEstimator, GivesTheDefaultWindWhileNoSensorSpeaks) {
  Scenario run;
  run.run_for(10.0);
  EXPECT_EQ(run.state().source, WindSource::kDefault);
  EXPECT_NEAR(run.state().wind.u_m_s, 3.0, 1e-9);
  EXPECT_NEAR(run.state().wind.v_m_s, 0.0, 1e-9);
  EXPECT_EQ(run.report().health, SourceHealth::kSilent);
}

TEST(FollowingEstimator, ComesToWhatTheSensorSays) {
  Scenario run;
  run.read_for(20.0, 1.0, 8.0, 180.0);
  EXPECT_EQ(run.state().source, WindSource::kLive);
  EXPECT_NEAR(run.state().wind.u_m_s, 0.0, 0.01);
  EXPECT_NEAR(run.state().wind.v_m_s, 8.0, 0.01);
  EXPECT_EQ(run.report().health, SourceHealth::kLive);
}

TEST(FollowingEstimator, MeasuresTheIntervalOfEachSource) {
  Scenario run(2);
  for (int second = 0; second < 60; ++second) {
    run.read(5.0, 90.0, 0);
    if (second % 14 == 0) run.read(6.0, 90.0, 1);
    run.run_for(1.0);
  }
  EXPECT_NEAR(run.report(0).interval_s, 1.0, 0.05);
  EXPECT_NEAR(run.report(1).interval_s, 14.0, 0.3);
}

TEST(FollowingEstimator, OneLateReadingDoesNotChangeTheMeasuredInterval) {
  Scenario run;
  run.read_for(10.0, 0.5, 5.0, 90.0);
  run.run_for(2.0);
  run.read(5.0, 90.0);
  EXPECT_NEAR(run.report().interval_s, 0.5, 0.05);
}

TEST(FollowingEstimator, CallsASourceStaleAfterFiveOfItsOwnIntervals) {
  Scenario run;
  run.read_for(20.0, 1.0, 8.0, 180.0);
  run.run_for(3.5);
  EXPECT_EQ(run.report().health, SourceHealth::kLive);
  run.run_for(2.0);
  EXPECT_EQ(run.report().health, SourceHealth::kStale);
  EXPECT_GT(run.report().age_s, 5.0);
  ASSERT_TRUE(run.report().last.has_value());
  EXPECT_EQ(run.report().last->speed_m_s, 8.0) << "the last value is kept, apart from the state";
}

TEST(FollowingEstimator, ASlowSensorIsNotStaleBetweenItsReadings) {
  Scenario run;
  run.read_for(48.0 * 6.0, 48.0, 8.0, 180.0);
  run.run_for(100.0);
  EXPECT_EQ(run.report().health, SourceHealth::kLive);
}

// A critically damped step of e moves at most 0.37 e w a second (w = 4 / hand-over): here 11 m/s in 3 s.
TEST(FollowingEstimator, LossAndReturnHandOverWithoutAJump) {
  constexpr double kLargestStep_m_s = 0.37 * (4.0 / 3.0) * 11.0 * kTick_s * 1.01;
  Scenario run;
  run.read_for(20.0, 0.5, 8.0, 90.0);
  run.forget_steps();

  run.run_for(30.0);
  EXPECT_EQ(run.state().source, WindSource::kDefault);
  EXPECT_NEAR(run.state().wind.u_m_s, 3.0, 0.01);
  EXPECT_LT(run.largest_step_m_s(), kLargestStep_m_s);

  run.read_for(20.0, 0.5, 8.0, 90.0);
  EXPECT_EQ(run.state().source, WindSource::kLive);
  EXPECT_NEAR(run.state().wind.u_m_s, -8.0, 0.01);
  EXPECT_LT(run.largest_step_m_s(), kLargestStep_m_s);
}

TEST(FollowingEstimator, ANewReadingBendsTheWindAndNeverSteps) {
  Scenario run;
  run.read_for(20.0, 0.1, 2.0, 90.0);
  run.forget_steps();
  run.read_for(5.0, 0.1, 12.0, 90.0);
  EXPECT_LT(run.largest_step_m_s(), 0.37 * 25.0 * 10.0 * kTick_s * 1.01);
  EXPECT_NEAR(speed_of(run.state().wind), 12.0, 0.1);
}

TEST(FollowingEstimator, ATurnFrom350To10DegreesPassesThroughNorth) {
  Scenario run;
  run.read_for(20.0, 1.0, 6.0, 350.0);
  run.read(6.0, 10.0);
  for (int tick = 0; tick < 120; ++tick) {
    run.tick();
    EXPECT_LE(std::abs(std::remainder(direction_from_deg(run.state().wind), 360.0)), 10.01);
    EXPECT_GT(speed_of(run.state().wind), 5.8);
  }
}

TEST(FollowingEstimator, FallsBackToTheNextLiveSourceAndReturnsToTheFirst) {
  Scenario run(2);
  const auto both_for = [&run](double duration_s, bool first_speaks) {
    for (int half = 0; half < static_cast<int>(2.0 * duration_s); ++half) {
      if (first_speaks) run.read(8.0, 90.0, 0);
      run.read(4.0, 0.0, 1);
      run.run_for(0.5);
    }
  };
  both_for(20.0, true);
  EXPECT_NEAR(speed_of(run.state().wind), 8.0, 0.05);
  run.forget_steps();
  both_for(20.0, false);
  EXPECT_NEAR(run.state().wind.v_m_s, -4.0, 0.05);
  both_for(20.0, true);
  EXPECT_NEAR(run.state().wind.u_m_s, -8.0, 0.05);
  EXPECT_LT(run.largest_step_m_s(), 0.37 * (4.0 / 3.0) * 9.0 * kTick_s * 1.1);
}

TEST(FollowingEstimator, WithoutADirectionItKeepsTheLastOneOrTheDefaultOne) {
  Scenario run;
  run.read_for(20.0, 1.0, 5.0, std::nullopt);
  EXPECT_NEAR(direction_from_deg(run.state().wind), 270.0, 0.1);
  run.read_for(20.0, 1.0, 5.0, 30.0);
  run.read_for(20.0, 1.0, 5.0, std::nullopt);
  EXPECT_NEAR(direction_from_deg(run.state().wind), 30.0, 0.1);
}

TEST(FollowingEstimator, RefusesWhatNoWindCanBe) {
  Scenario run;
  EXPECT_FALSE(run.read(std::numeric_limits<double>::quiet_NaN(), 90.0));
  EXPECT_FALSE(run.read(-1.0, 90.0));
  EXPECT_FALSE(run.read(500.0, 90.0));
  EXPECT_FALSE(run.read(5.0, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(run.estimator().accept(1, WindReading{})) << "there is no source 1";
  EXPECT_EQ(run.report().health, SourceHealth::kSilent);
}

TEST(FollowingEstimator, TimeThatGoesBackChangesNothing) {
  Scenario run;
  run.read_for(20.0, 1.0, 8.0, 180.0);
  const WindState before = run.state();
  const WindState again = run.estimator().advance(Scenario::at(3.0));
  EXPECT_EQ(again.wind.v_m_s, before.wind.v_m_s);
  EXPECT_EQ(again.time, before.time);
}

TEST(FollowingEstimator, ALongHaltOfTheMachineLeavesItFinite) {
  Scenario run;
  run.read_for(5.0, 0.1, 8.0, 180.0);
  const WindState after = run.estimator().advance(Scenario::at(86'400.0));
  EXPECT_NEAR(after.wind.u_m_s, 3.0, 1e-6);
  EXPECT_EQ(after.source, WindSource::kDefault);
}

// Random speech and silence of three sources, garbage included: finite, bounded, and never faster than the followers
// allow.
TEST(FollowingEstimator, StaysFiniteBoundedAndContinuousUnderRandomFaults) {
  constexpr double kStrongest_m_s = 30.0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Scenario run(3, 0.3);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int step = 0; step < 600; ++step) {
      const auto source = static_cast<std::size_t>(unit(random) * 3.0);
      const double kind = unit(random);
      if (kind < 0.05) {
        run.read(std::numeric_limits<double>::quiet_NaN(), 10.0, source);
      } else if (kind < 0.1) {
        run.read(1e300, 10.0, source);
      } else if (kind < 0.7) {
        run.read(kStrongest_m_s * unit(random), 360.0 * unit(random) * 0.999, source);
      }
      run.run_for(kind > 0.98 ? 20.0 : 0.3 * unit(random));
      EXPECT_LT(speed_of(run.state().wind), 1.4 * kStrongest_m_s);
    }
    // Follower: 0.37 w e with e = 60 m/s and w = 25 rad/s; hand-over and default wind add less than a tenth of that.
    EXPECT_LT(run.largest_step_m_s(), 1.1 * 0.37 * 25.0 * 60.0 * kTick_s) << "seed " << seed;
  }
}

}  // namespace
}  // namespace yuragi
