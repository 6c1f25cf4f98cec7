#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "tests/engine/wind/blend/blend_run.hpp"

namespace yuragi::wind::blend {
namespace {

/// No noise worth speaking of, and these sources.
Settings without_noise(std::vector<SourceSettings> sources) {
  Settings settings = BlendRun::usual(1, 0.0);
  settings.sources = std::move(sources);
  return settings;
}

TEST(BlendedSources, EqualOnesShareTheWindByWeightAsVectors) {
  BlendRun run(2, without_noise({{.priority = 1, .weight = 3.0}, {.priority = 1, .weight = 1.0}}));
  for (int i = 0; i < 100; ++i) {
    run.read(8.0, 270.0, 0);
    run.read(4.0, 180.0, 1);
    run.run_for(1.0);
  }
  EXPECT_NEAR(run.state().wind.u_m_s, 6.0, 0.1);
  EXPECT_NEAR(run.state().wind.v_m_s, 1.0, 0.1);
}

TEST(BlendedSources, OneThatKnowsABandIsNotDilutedByOneThatDoesNot) {
  // A gust of 20 s that only the fast one can hear: the slow one's mean is 0 in it.
  BlendRun run(2, without_noise({{.priority = 1}, {.priority = 1, .averaging_s = 60.0}}));
  double largest_m_s = 0.0;
  for (int second = 0; second < 900; ++second) {
    const double gust_m_s = 2.0 * std::sin(2.0 * std::numbers::pi * second / 20.0);
    run.read(8.0 + gust_m_s, 180.0, 0);
    if (second % 60 == 0) run.read(8.0, 180.0, 1);
    run.run_for(1.0, [&](const State& state) {
      if (second > 600) largest_m_s = std::max(largest_m_s, state.wind.v_m_s);
    });
  }
  EXPECT_GT(largest_m_s, 9.6);
}

/// A slow absolute source of mean 8, and a microphone that says 0.4 times as much, each second; both of one true wind
/// whose gusts have a deviation of 1.5 m/s.
class WithMicrophone {
 public:
  explicit WithMicrophone(std::uint64_t seed, double slow_s = 60.0)
      : run(2, settings(seed)), gusts_(seed), slow_s_(slow_s) {}

  void run_for(int seconds, bool slow_sends = true, bool microphone_sends = true) {
    for (int i = 0; i < seconds; ++i, ++second_) {
      const double true_m_s = std::max(0.0, 8.0 + 1.5 * gusts_.next());
      sum_m_s_ += true_m_s;
      if (second_ % static_cast<int>(slow_s_) == 0) {
        if (slow_sends) run.read(sum_m_s_ / std::max(1, second_ - since_), 180.0, 0);
        sum_m_s_ = 0.0;
        since_ = second_;
      }
      if (microphone_sends) run.read(0.4 * true_m_s, std::nullopt, 1);
      run.run_for(1.0, [&](const State& state) {
        moments.add(state);
        together_ += (state.wind.v_m_s - 8.0) * (true_m_s - 8.0);
        truth_ += (true_m_s - 8.0) * (true_m_s - 8.0);
      });
    }
  }
  void forget() {
    moments = {};
    together_ = truth_ = 0.0;
  }
  /// Covariance with the true wind of the same second over the variance of that.
  double likeness() const { return together_ / truth_; }

  BlendRun run;
  BlendMoments moments;

 private:
  static Settings settings(std::uint64_t seed) {
    Settings settings = BlendRun::usual(seed);
    settings.sources = {{}, {.is_relative = true}};
    return settings;
  }

  TestGusts gusts_;
  double slow_s_;
  int second_ = 0;
  int since_ = -1;
  double sum_m_s_ = 0.0;
  double together_ = 0.0, truth_ = 0.0;
};

TEST(BlendedSources, ASlowAbsoluteOneSetsTheMeanAndAMicrophoneTheGusts) {
  double mean_m_s = 0.0;
  double along = 0.0;
  double likeness = 0.0;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    WithMicrophone wind(seed);
    wind.run_for(900);
    wind.forget();
    wind.run_for(900);
    mean_m_s += wind.moments.mean().v_m_s / kSeeds;
    along += wind.moments.variance_v() / kSeeds;
    likeness += wind.likeness() / kSeeds;
  }
  EXPECT_NEAR(mean_m_s, 8.0, 0.25) << "the microphone says 3.2";
  EXPECT_NEAR(along / 2.25, 1.0, 0.3) << "as strong as the true gusts";
  EXPECT_GT(likeness, 0.5) << "and the same ones";
}

TEST(BlendedSources, WithoutTheMicrophoneTheGustsAreNoiseAgain) {
  WithMicrophone wind(3);
  wind.run_for(900);
  wind.run_for(60, true, false);
  wind.forget();
  wind.run_for(600, true, false);
  EXPECT_LT(wind.likeness(), 0.3);
  EXPECT_GT(wind.moments.variance_v(), 1.0);
}

TEST(BlendedSources, AMicrophoneAloneIsTakenAsItIs) {
  Settings settings = BlendRun::usual(1, 0.0);
  settings.sources = {{.is_relative = true}};
  BlendRun run(1, settings);
  run.read_for(60.0, 1.0, 5.0, 90.0);
  EXPECT_NEAR(run.state().wind.u_m_s, -5.0, 0.1);
  EXPECT_EQ(run.state().source, Source::kLive);
}

TEST(BlendedSources, AFlappingSensorDoesNotMakeTheWindFlap) {
  // The first speaks for 8 s and is silent for 8 s; both say what the other does not.
  BlendRun run(2, without_noise({{}, {}}));
  const auto send_for = [&run](int seconds, bool first) {
    for (int i = 0; i < seconds; ++i) {
      if (first) run.read(9.0, 180.0, 0);
      run.read(5.0, 180.0, 1);
      run.run_for(1.0);
    }
  };
  send_for(60, true);
  send_for(8, false);
  send_for(8, true);
  send_for(60, false);
  double lowest = 1e9;
  double highest = 0.0;
  for (int flap = 0; flap < 20; ++flap) {
    for (int second = 0; second < 16; ++second) {
      if (second < 8) run.read(9.0, 180.0, 0);
      run.read(5.0, 180.0, 1);
      run.run_for(1.0, [&](const State& state) {
        lowest = std::min(lowest, state.wind.v_m_s);
        highest = std::max(highest, state.wind.v_m_s);
      });
    }
  }
  EXPECT_GT(lowest, 4.7);
  EXPECT_LT(highest, 5.3);
}

TEST(BlendedSources, AlongAWallTheWindIsInterpolated) {
  BlendRun run(2, without_noise({{.priority = 1, .east_m = -10.0}, {.priority = 1, .east_m = 10.0}}));
  for (int i = 0; i < 300; ++i) {
    run.read(4.0, 180.0, 0);
    run.read(8.0, 270.0, 1);
    run.run_for(1.0);
  }
  const ground::Wind& ground = run.estimator().ground();
  const Vector west = ground.smooth_at(-10.0, 0.0);
  const Vector middle = ground.smooth_at(0.0, 0.0);
  const Vector east = ground.smooth_at(10.0, 3.0);
  EXPECT_NEAR(west.v_m_s, 4.0, 0.3);
  EXPECT_NEAR(west.u_m_s, 0.0, 0.3);
  EXPECT_NEAR(middle.v_m_s, 2.0, 0.2);
  EXPECT_NEAR(middle.u_m_s, 4.0, 0.2);
  EXPECT_NEAR(east.v_m_s, 0.0, 0.3);
  EXPECT_NEAR(east.u_m_s, 8.0, 0.3);
  EXPECT_NEAR(ground.smooth_at(1000.0, 0.0).u_m_s, east.u_m_s, 1e-9) << "level beyond the ends";
}

TEST(BlendedSources, AlongAWallASensorFailsAndReturnsWithoutAJump) {
  BlendRun run(2, without_noise({{.priority = 1, .east_m = -10.0}, {.priority = 1, .east_m = 10.0}}));
  double largest_step_m_s = 0.0;
  const auto send_for = [&](int seconds, bool second_sends) {
    for (int i = 0; i < seconds; ++i) {
      run.read(4.0, 180.0, 0);
      if (second_sends) run.read(8.0, 180.0, 1);
      Vector before = run.estimator().ground().smooth_at(10.0, 0.0);
      run.run_for(1.0, [&](const State&) {
        const Vector now = run.estimator().ground().smooth_at(10.0, 0.0);
        largest_step_m_s = std::max(largest_step_m_s, speed_of(now - before));
        before = now;
      });
    }
  };
  send_for(120, true);
  EXPECT_NEAR(run.estimator().ground().smooth_at(10.0, 0.0).v_m_s, 8.0, 0.3);
  largest_step_m_s = 0.0;
  send_for(120, false);
  EXPECT_NEAR(run.estimator().ground().smooth_at(10.0, 0.0).v_m_s, 4.0, 0.3);
  send_for(120, true);
  EXPECT_NEAR(run.estimator().ground().smooth_at(10.0, 0.0).v_m_s, 8.0, 0.3);
  EXPECT_LT(largest_step_m_s, 0.1) << "4 m/s within some seconds";
}

/// Gusts of two sensors `distance_m` apart that have nothing in common, each told where it stands: the variance over
/// the true one, in the middle between them and where one stands.
std::pair<double, double> variances_between(double distance_m, std::uint64_t seed) {
  Settings settings = BlendRun::usual(seed);
  settings.sources = {{.priority = 1, .has_place = true, .east_m = -0.5 * distance_m},
                      {.priority = 1, .has_place = true, .east_m = 0.5 * distance_m}};
  BlendRun run(2, settings);
  ground::WindTapes tapes;
  TestGusts first(seed);
  TestGusts second(seed + 100);
  BlendMoments middle;
  BlendMoments end;
  for (int i = 0; i < 1500; ++i) {
    run.read(8.0 + 1.5 * first.next(), 180.0, 0);
    run.read(8.0 + 1.5 * second.next(), 180.0, 1);
    run.run_for(1.0, [&](const State& state) {
      const ground::Wind ground = written_to(tapes, {state, run.estimator().ground(), run.estimator().stroke()});
      if (i < 600) return;
      middle.add({.wind = ground.at(*shared_gust_noise(), 0.0, 0.0)});
      end.add({.wind = ground.at(*shared_gust_noise(), 0.5 * distance_m, 0.0)});
    });
  }
  return {middle.variance_v() / 2.25, end.variance_v() / 2.25};
}

TEST(BlendedSources, WhatTwoSensorsDoNotHaveAlikeTheNoiseFills) {
  double middle = 0.0;
  double end = 0.0;
  constexpr int kSeeds = 3;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto [at_middle, at_end] = variances_between(200.0, seed);
    middle += at_middle / kSeeds;
    end += at_end / kSeeds;
  }
  EXPECT_NEAR(middle, 1.0, 0.25);
  EXPECT_NEAR(end, 1.0, 0.3);
}

TEST(BlendedSources, AVaneOfEightPointsMakesNoLeapsAndTheDirectionSwingsAsTheTurbulenceDoes) {
  BlendRun coarse(1, BlendRun::usual(4));
  TestGusts speed(1);
  TestGusts swing(2);
  double largest_turn_deg = 0.0;
  double squares = 0.0;
  double sum = 0.0;
  int count = 0;
  double before_deg = 200.0;
  for (int i = 0; i < 1800; ++i) {
    const double true_deg = 200.0 + 9.0 * swing.next();
    coarse.read(std::max(0.0, 8.0 + 1.6 * speed.next()), std::fmod(45.0 * std::round(true_deg / 45.0), 360.0));
    coarse.run_for(1.0, [&](const State& state) {
      const double deg = direction_from_deg(state.wind);
      if (i > 600) {
        largest_turn_deg = std::max(largest_turn_deg, std::abs(std::remainder(deg - before_deg, 360.0)));
        squares += deg * deg;
        sum += deg;
        ++count;
      }
      before_deg = deg;
    });
  }
  const double mean_deg = sum / count;
  const double deviation_deg = std::sqrt(squares / count - mean_deg * mean_deg);
  EXPECT_NEAR(mean_deg, 200.0, 12.0) << "a vane that mostly says 180 and sometimes 225 tells no more";
  EXPECT_GT(deviation_deg, 5.0);
  EXPECT_LT(deviation_deg, 16.0);
  EXPECT_LT(largest_turn_deg, 15.0)
      << "in a sixtieth of a second: gusts of some tens of centimetres, and no leap of 45";
}

TEST(BlendedSources, ASensorWithoutAVaneLeavesTheWindItsSwing) {
  BlendRun cup(1, BlendRun::usual(2));
  TestGusts speed(1);
  BlendMoments moments;
  for (int i = 0; i < 1500; ++i) {
    cup.read(std::max(0.0, 8.0 + 1.6 * speed.next()), std::nullopt);
    cup.run_for(1.0, [&](const State& state) {
      if (i > 600) moments.add(state);
    });
  }
  // From south, as the climate says: v along the wind, u across it.
  EXPECT_NEAR(moments.mean().v_m_s, 8.0, 0.5);
  EXPECT_GT(moments.variance_u(), 0.3 * moments.variance_v());
}

TEST(BlendedSources, ARunningMeanSentOftenIsNotTakenForAQuickSensor) {
  // A mean over 120 s, sent every 3 s: its readings hardly differ, and yet the wind outside is gusty.
  Settings settings = BlendRun::usual(1, 0.25);
  settings.sources = {{.averaging_s = 120.0}};
  BlendRun run(1, settings);
  TestGusts gusts(1);
  BlendMoments moments;
  double mean_m_s = 8.0;
  for (int i = 0; i < 1500; ++i) {
    mean_m_s += (8.0 + 2.0 * gusts.next() - mean_m_s) / 120.0;
    if (i % 3 == 0) run.read(mean_m_s, 180.0);
    run.run_for(1.0, [&](const State& state) {
      if (i > 300) moments.add(state);
    });
  }
  EXPECT_GT(moments.variance_v(), 1.0) << "not the 0.1 of a calm flow";
}

TEST(BlendedSources, TheDelayIsThatOfAveragingHoldAndBands) {
  for (const double interval_s : {1.0, 14.0}) {
    // Of block means: half the mean, half the hold, and what the bands add.
    EXPECT_NEAR(blend_group_delay_s(0.01 / interval_s, interval_s, interval_s), 1.36 * interval_s, 0.01 * interval_s);
    EXPECT_NEAR(blend_group_delay_s(0.25 / interval_s, interval_s, interval_s), 1.22 * interval_s, 0.01 * interval_s);
  }
  EXPECT_NEAR(blend_group_delay_s(0.01, 1.0, 0.0), 0.86, 0.01) << "a reading of the moment";
}

// How strong gusts are is no wind.
TEST(BlendedSources, OneOfMaximaMakesNoWind) {
  BlendRun run(2, without_noise({{.priority = 1, .value = ReadingValue::kMaximum}, {.priority = 2}}));
  run.read_for(60.0, 1.0, 12.0, 270.0, 0);
  EXPECT_EQ(run.report(0).health, SourceHealth::kSilent);
  EXPECT_NEAR(speed_of(run.state().wind), 4.0, 1e-6) << "the climate's";
  EXPECT_EQ(run.state().live_weight, 0.0);
  for (int second = 0; second < 60; ++second) {
    EXPECT_FALSE(run.read(12.0, 270.0, 0));
    EXPECT_TRUE(run.read(6.0, 270.0, 1));
    run.run_for(1.0);
  }
  EXPECT_NEAR(speed_of(run.state().wind), 6.0, 0.1);
}

TEST(BlendedSources, WhatNobodySaysIsAssumedByTheInterval) {
  BlendRun run(
      3, without_noise(
             {{.value = ReadingValue::kUnknown}, {.value = ReadingValue::kUnknown}, {.value = ReadingValue::kMean}}));
  for (int second = 0; second < 1200; ++second) {
    if (second % 14 == 0) run.read(5.0 + 0.01 * second, 180.0, 0);
    if (second % 60 == 0) run.read(5.0 + 0.01 * second, 180.0, 1);
    run.run_for(1.0);
  }
  EXPECT_EQ(run.estimator().taken(0).value, ReadingValue::kInstant);
  EXPECT_EQ(run.estimator().taken(1).value, ReadingValue::kMean);
  EXPECT_EQ(run.estimator().taken(2).value, ReadingValue::kMean);

  // One whose interval wavers about the limit stays what it is.
  BlendRun wavering(1, without_noise({{.value = ReadingValue::kUnknown}}));
  for (int i = 0; i < 60; ++i)
    wavering.read_for(27.0 + static_cast<double>(i / 15 % 2) * 6.0, 33.0, 5.0 + 0.01 * i, 180.0);
  EXPECT_EQ(wavering.estimator().taken(0).value, ReadingValue::kInstant);
}

// One of which nobody says what it is is taken as what is assumed, bit for bit.
TEST(BlendedSources, WhatIsAssumedIsTakenAsIfItWereStated) {
  for (const auto& [interval_s, value] : {std::pair{14, ReadingValue::kInstant}, {60, ReadingValue::kMean}}) {
    Settings assumed = BlendRun::usual(3, 0.3);
    Settings stated = assumed;
    assumed.sources = {{.value = ReadingValue::kUnknown}};
    stated.sources = {{.value = value}};
    BlendRun first(1, assumed);
    BlendRun second(1, stated);
    for (int i = 0; i < 40; ++i) {
      const double speed_m_s = 6.0 + 2.0 * std::sin(1.7 * i);
      first.read_for(interval_s, interval_s, speed_m_s, 180.0);
      second.read_for(interval_s, interval_s, speed_m_s, 180.0);
      // A mean of a minute is taken as instantaneous until its interval is known.
      if (value == ReadingValue::kInstant) {
        EXPECT_EQ(speed_of(first.state().wind - second.state().wind), 0.0) << i;
      }
    }
    EXPECT_LT(speed_of(first.state().wind - second.state().wind), 0.2) << interval_s;
  }
}

// A slow wave of the wind, as readings of the moment, comes out of the estimator as much later as is stated.
TEST(BlendedSources, AWaveIsAsMuchLaterAsStated) {
  constexpr double kWave_hz = 0.05;
  BlendRun run(1, without_noise({{}}));
  double cosine = 0.0;
  double sine = 0.0;
  for (int second = 0; second < 1200; ++second) {
    const double turn = 2.0 * std::numbers::pi * kWave_hz;
    run.read(8.0 + 0.5 * std::sin(turn * second), 180.0);
    double time_s = second;
    run.run_for(1.0, [&](const State& state) {
      time_s += kBlendTick_s;
      if (second < 600) return;
      cosine += state.wind.v_m_s * std::cos(turn * time_s);
      sine += state.wind.v_m_s * std::sin(turn * time_s);
    });
  }
  const double delay_s = -std::atan2(cosine, sine) / (2.0 * std::numbers::pi * kWave_hz);
  EXPECT_NEAR(delay_s, blend_group_delay_s(kWave_hz, 1.0, 0.0), 0.15);
}

// Random speech and silence of four sources of all kinds, garbage included.
TEST(BlendedSources, AreFiniteBoundedAndContinuousUnderRandomFaults) {
  constexpr double kStrongest_m_s = 30.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Settings settings = BlendRun::usual(seed, 0.3);
    const ReadingValue value = seed % 2 == 0 ? ReadingValue::kInstant : ReadingValue::kMean;
    settings.sources = {{.priority = 1, .east_m = -20.0, .value = value},
                        {.priority = 1, .weight = 4.0, .east_m = 20.0, .south_m = 5.0, .averaging_s = 20.0},
                        {.priority = 2, .value = value, .direction_step_deg = 45.0},
                        {.is_relative = true}};
    BlendRun run(4, settings);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    double fastest_m_s = 0.0;
    for (int step = 0; step < 500; ++step) {
      const auto source = static_cast<std::size_t>(unit(random) * 5.0);
      const double kind = unit(random);
      const std::optional<double> direction_deg =
          unit(random) < 0.3 ? std::nullopt : std::optional(359.9 * unit(random));
      if (kind < 0.05) {
        run.read(std::nan(""), 10.0, source);
      } else if (kind < 0.1) {
        run.read(1e300, 10.0, source);
      } else if (kind < 0.7) {
        run.read(kStrongest_m_s * unit(random), direction_deg, source);
      }
      run.run_for(kind > 0.98 ? 20.0 : 0.3 * unit(random), [&](const State& state) {
        ASSERT_TRUE(std::isfinite(state.wind.u_m_s) && std::isfinite(state.wind.v_m_s));
        ASSERT_TRUE(state.live_weight >= 0.0 && state.live_weight <= 1.0);
        for (const double east_m : {-50.0, 50.0}) {
          const Vector there = run.estimator().ground().at(*shared_gust_noise(), east_m, 0.0);
          ASSERT_TRUE(std::isfinite(there.u_m_s) && std::isfinite(there.v_m_s));
          fastest_m_s = std::max(fastest_m_s, speed_of(there));
        }
      });
    }
    EXPECT_LT(fastest_m_s, 10.0 * kStrongest_m_s) << "seed " << seed;
    EXPECT_LT(run.take_largest_step_m_s(), 2.0 * kStrongest_m_s) << "seed " << seed;
  }
}

}  // namespace
}  // namespace yuragi::wind::blend
