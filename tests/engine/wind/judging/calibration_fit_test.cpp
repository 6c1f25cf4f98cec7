#include "engine/wind/judging/calibration_fit.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::wind::judging {
namespace {

using ::testing::HasSubstr;

std::vector<double> around(double mean, double deviation, std::size_t count, unsigned seed = 7) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;  // its own deviation must not be 0
  std::vector<double> values(count);
  for (double& value : values) value = mean + deviation * normal(random);
  return values;
}

// ---- zero ----

TEST(CalibrationFit, ACalmGivesTheOffsetAndTheNoise) {
  const auto air = measure_still_air(around(0.32, 0.02, 200));
  ASSERT_TRUE(air);
  EXPECT_NEAR(air->mean_m_s, 0.32, 0.005);
  EXPECT_NEAR(air->noise_m_s, 0.02, 0.004);

  Calibration calibration{.gain = 1.2, .offset_m_s = 0.7};
  calibration.offset_m_s = offset_for_zero_m_s(calibration, 0.32);
  EXPECT_NEAR(calibration.offset_m_s, -1.2 * 0.32, 1e-12);
  EXPECT_NEAR(zero_point_m_s(calibration), 0.32, 1e-12);

  Calibration bent{.gain = 1.2, .curve = parse_calibration_curve("1:0.5 5:5").value()};
  bent.offset_m_s = offset_for_zero_m_s(bent, 0.32);
  EXPECT_NEAR(zero_point_m_s(bent), 0.32, 1e-12) << "through the curve, too";
}

TEST(CalibrationFit, RefusesACalmThatIsNone) {
  EXPECT_THAT(measure_still_air(around(0.3, 0.02, 9)).error().message, HasSubstr("9 readings"));
  EXPECT_THAT(measure_still_air(around(0.5, 0.4, 100)).error().message, HasSubstr("not still"));
  EXPECT_THAT(measure_still_air(around(6.0, 0.05, 100)).error().message, HasSubstr("not a zero error"));
  std::vector<double> dying_wind(60);
  for (std::size_t i = 0; i < dying_wind.size(); ++i) dying_wind[i] = 0.4 - 0.4 * static_cast<double>(i) / 60.0;
  EXPECT_THAT(measure_still_air(dying_wind).error().message, HasSubstr("drift by -0.2 m/s"));
}

// ---- north ----

TEST(CalibrationFit, DirectionsAreAveragedThroughNorth) {
  const DirectionMean mean = direction_mean(std::vector{350.0, 10.0, 355.0, 5.0});
  EXPECT_NEAR(std::abs(signed_degrees(mean.mean_deg)), 0.0, 1e-9);
  EXPECT_GE(mean.mean_deg, 0.0);
  EXPECT_LT(mean.mean_deg, 360.0);
  EXPECT_NEAR(mean.spread_deg, std::sqrt((100.0 + 25.0) / 2.0), 0.1);
  EXPECT_EQ(direction_mean({}).count, 0U);
  EXPECT_GT(direction_mean(std::vector{0.0, 180.0}).spread_deg, 100.0);
  EXPECT_EQ(direction_mean(std::vector{0.0, 0.0}).spread_deg, 0.0);
}

TEST(CalibrationFit, AVaneThatIsHeldIsMeasuredAndOneThatTurnsIsRefused) {
  const auto held = measure_held_vane(around(359.5, 1.0, 100));
  ASSERT_TRUE(held);
  EXPECT_NEAR(signed_degrees(held->mean_deg), -0.5, 0.4);
  EXPECT_THAT(measure_held_vane(around(90.0, 12.0, 100)).error().message, HasSubstr("the vane moved"));
  EXPECT_THAT(measure_held_vane({}).error().message, HasSubstr("does this sensor have a vane"));
}

TEST(CalibrationFit, TwoVanesInOneWindGiveTheTurnBetweenThem) {
  const auto turn = measure_turn(around(-12.0, 15.0, 400));
  ASSERT_TRUE(turn);
  EXPECT_NEAR(signed_degrees(turn->mean_deg), -12.0, 2.5);
  EXPECT_FALSE(measure_turn(around(-12.0, 60.0, 400)));
  EXPECT_FALSE(measure_turn(around(-12.0, 1.0, 19)));
}

TEST(CalibrationFit, TwoVanesAreComparedWhereBothSpoke) {
  std::vector<TimedDirection> indicated;
  std::vector<TimedDirection> truth;
  for (int i = 0; i < 200; ++i) indicated.push_back({0.5 * i, i % 2 == 0 ? 350.0 : 352.0});
  for (int i = 0; i < 3; ++i) truth.push_back({10.0 * i + 5.0, 11.0});
  truth.push_back({500.0, 200.0});
  const std::vector<double> turns_deg = pair_turns(indicated, truth, 10.0);
  ASSERT_EQ(turns_deg.size(), 3U);
  for (const double turn_deg : turns_deg) EXPECT_NEAR(turn_deg, 20.0, 1e-9);
}

TEST(CalibrationFit, AnAngleHasOneSignedForm) {
  EXPECT_EQ(signed_degrees(190.0), -170.0);
  EXPECT_EQ(signed_degrees(-190.0), 170.0);
  EXPECT_EQ(signed_degrees(180.0), 180.0);
  EXPECT_EQ(signed_degrees(-180.0), 180.0);
  EXPECT_EQ(signed_degrees(540.0), 180.0);
  EXPECT_EQ(signed_degrees(720.0), 0.0);
}

// ---- span ----

/// What a sensor says of winds from 1 to 12 m/s that it measures as (true - offset) / gain, with some scatter.
std::vector<CalibrationPoint> beside_truth(double gain, double offset_m_s, double scatter_m_s,
                                           std::size_t count = 120) {
  const std::vector<double> scatter = around(0.0, scatter_m_s, count);
  std::vector<CalibrationPoint> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const double true_m_s = 1.0 + 11.0 * static_cast<double>((37 * i) % count) / static_cast<double>(count);
    pairs.push_back({std::max(0.0, (true_m_s - offset_m_s) / gain), std::max(0.0, true_m_s + scatter[i])});
  }
  return pairs;
}

TEST(CalibrationFit, LeastSquaresFindTheLineThatMadeThePairs) {
  const auto exact = fit_line(beside_truth(1.07, 0.25, 0.0));
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->gain, 1.07, 1e-12);
  EXPECT_NEAR(exact->offset_m_s, 0.25, 1e-12);
  EXPECT_NEAR(exact->r_squared, 1.0, 1e-12);
  EXPECT_NEAR(exact->residual_m_s, 0.0, 1e-9);

  const auto noisy = fit_line(beside_truth(0.93, -0.2, 0.4));
  ASSERT_TRUE(noisy);
  EXPECT_NEAR(noisy->gain, 0.93, 0.03);
  EXPECT_NEAR(noisy->offset_m_s, -0.2, 0.2);
  EXPECT_NEAR(noisy->residual_m_s, 0.4, 0.06);
  EXPECT_GT(noisy->r_squared, 0.97);
}

TEST(CalibrationFit, ACalmSaysNothingOfTheLine) {
  auto pairs = beside_truth(1.07, 0.25, 0.0);
  for (int i = 0; i < 50; ++i) pairs.push_back({0.0, 0.3});  // a cup that needs 0.5 m/s to start
  EXPECT_NEAR(fit_line(pairs)->gain, 1.07, 1e-12);
}

TEST(CalibrationFit, TwoKnownPointsMakeALine) {
  const auto fit = fit_line(std::vector<CalibrationPoint>{{2.0, 3.0}, {10.0, 12.0}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->gain, 9.0 / 8.0, 1e-12);
  EXPECT_NEAR(fit->offset_m_s, 0.75, 1e-12);
}

TEST(CalibrationFit, RefusesALineThatWouldBeNonsense) {
  using Pairs = std::vector<CalibrationPoint>;
  EXPECT_THAT(fit_line(Pairs{}).error().message, HasSubstr("at least two are needed"));
  EXPECT_THAT(fit_line(Pairs{{3.0, 3.0}, {3.5, 4.0}}).error().message, HasSubstr("2 m/s between"));
  EXPECT_THAT(fit_line(Pairs{{3.0, 3.0}, {3.0, 9.0}}).error().message, HasSubstr("it is stuck"));
  EXPECT_THAT(fit_line(Pairs{{9.0, 3.0}, {3.0, 9.0}}).error().message,
              HasSubstr("reads less when the reference reads more"));
  EXPECT_THAT(fit_line(Pairs{{1.0, 2.0}, {1.5, 9.0}}).error().message, HasSubstr("is its unit right"));
  EXPECT_THAT(fit_line(beside_truth(1.0, 0.0, 4.0)).error().message, HasSubstr("agree too little"));
  using Limits = std::numeric_limits<double>;
  EXPECT_FALSE(fit_line(Pairs{{Limits::quiet_NaN(), 1.0}, {2.0, Limits::infinity()}, {3.0, 3.0}}));
}

TEST(CalibrationFit, OneKnownSpeedTurnsTheLineAboutItsZero) {
  const auto fit = fit_line_from_zero(0.3, {5.3, 5.5});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->gain, 1.1, 1e-12);
  EXPECT_NEAR(fit->gain * 0.3 + fit->offset_m_s, 0.0, 1e-12);
  EXPECT_FALSE(fit_line_from_zero(0.0, {1.0, 1.0})) << "too slow";
  EXPECT_FALSE(fit_line_from_zero(0.3, {0.2, 5.0})) << "it did not feel it";
  EXPECT_FALSE(fit_line_from_zero(0.0, {36.0, 5.0})) << "that is a unit, not a gain";
}

TEST(CalibrationFit, BinsFollowASensorThatIsNotStraight) {
  std::vector<CalibrationPoint> pairs;
  for (int i = 0; i < 200; ++i) {
    const double indicated_m_s = 0.5 + 0.05 * i;
    pairs.push_back({indicated_m_s, 0.3 + 0.8 * indicated_m_s + 0.04 * indicated_m_s * indicated_m_s});
  }
  const auto line = fit_line(pairs);
  const auto curve = fit_curve(pairs);
  ASSERT_TRUE(line);
  ASSERT_TRUE(curve);
  EXPECT_LT(curve->residual_m_s, 0.2 * line->residual_m_s);
  EXPECT_GT(curve->r_squared, line->r_squared);
  for (std::size_t i = 1; i < curve->curve.size(); ++i) {
    EXPECT_GT(curve->curve[i].measured_m_s, curve->curve[i - 1].measured_m_s);
    EXPECT_GT(curve->curve[i].true_m_s, curve->curve[i - 1].true_m_s);
  }
  // Beyond the fastest wind that there was (10.45 m/s) it goes on as there, not as the whole or as two bins say.
  const Calibration calibration{.curve = curve->curve};
  Reading storm;
  storm.speed_m_s = 18.0;
  const double steepness = 0.8 + 0.08 * 8.0;
  EXPECT_NEAR(calibration.applied_to(storm).speed_m_s, 0.3 + 0.8 * 10.45 + 0.04 * 10.45 * 10.45 + 7.55 * steepness,
              0.6);
  EXPECT_NEAR(calibration.curve.front().true_m_s, 0.3, 0.3);
}

TEST(CalibrationFit, ACurveRisesWhateverTheScatter) {
  int made = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<CalibrationPoint> pairs;
    for (int i = 0; i < 40; ++i) {
      const double indicated_m_s = 8.0 * uniform(random);
      pairs.push_back({indicated_m_s, std::max(0.0, indicated_m_s + 3.0 * uniform(random) - 1.5)});
    }
    const auto fit = fit_curve(pairs);
    if (!fit) continue;
    ++made;
    for (std::size_t i = 1; i < fit->curve.size(); ++i) {
      ASSERT_GT(fit->curve[i].measured_m_s, fit->curve[i - 1].measured_m_s + 0.2);
      ASSERT_GT(fit->curve[i].true_m_s, fit->curve[i - 1].true_m_s + 0.005);
      ASSERT_GE(fit->curve[i - 1].true_m_s, 0.0);
      ASSERT_GE(fit->curve[i - 1].measured_m_s, 0.0);
    }
  }
  EXPECT_GT(made, 100);
}

TEST(CalibrationFit, ACurveNeedsWindInSeveralBins) {
  std::vector<CalibrationPoint> pairs(20, {2.5, 2.5});
  pairs.resize(40, {6.5, 6.5});
  EXPECT_TRUE(fit_line(pairs));
  EXPECT_THAT(fit_curve(pairs).error().message, HasSubstr("there are 2"));
}

TEST(CalibrationFit, SensorsOfDifferentPaceAreComparedByTheirMeans) {
  std::vector<TimedSpeed> fast;
  std::vector<TimedSpeed> slow;
  for (int i = 0; i < 1000; ++i) fast.push_back({0.1 * i, 4.0 + 0.02 * i});
  for (int i = 0; i < 10; ++i) slow.push_back({10.0 * i + 5.0, 8.0});
  slow.push_back({500.0, 9.0});  // while the other was silent
  const auto pairs = pair_means(fast, slow, 20.0);
  ASSERT_EQ(pairs.size(), 5U);
  EXPECT_NEAR(pairs[0].measured_m_s, 4.0 + 0.02 * 99.5, 1e-9);
  EXPECT_EQ(pairs[0].true_m_s, 8.0);
}

}  // namespace
}  // namespace yuragi::wind::judging
