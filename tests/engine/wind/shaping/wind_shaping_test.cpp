#include "engine/wind/shaping/wind_shaping.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "engine/wind/blend/blended_estimator.hpp"
#include "tests/support/gusty_wind.hpp"

namespace yuragi::wind::shaping {
namespace {

constexpr double kTick_s = 1.0 / 60.0;

/// A wind without gusts, which blows toward north-east.
ground::DrivingWind steady_wind(double speed_m_s, double time_s, double live_weight = 1.0) {
  const Vector ahead{0.6, 0.8};
  ground::DrivingWind wind{.state = {.time = MonoTime(from_seconds(time_s)),
                                     .wind = speed_m_s * ahead,
                                     .source = Source::kLive,
                                     .live_weight = live_weight},
                           .ground = speed_m_s * ahead};
  wind.ground.gusts.ahead = ahead;
  wind.ground.gusts.carried = shared_gusts()->begin(1);
  return wind;
}

/// A shaping, and the time that goes on from tick to tick.
class ShapedWind {
 public:
  explicit ShapedWind(const WindShapingSettings& settings) : shaping(settings, shared_gusts()) {}

  ground::DrivingWind after(double speed_m_s, double dt_s, bool is_open = true, double live_weight = 1.0) {
    time_s += dt_s;
    ground::DrivingWind wind = steady_wind(speed_m_s, time_s, live_weight);
    shaping.shape(wind, is_open, true, by_hand);
    return wind;
  }
  /// The last of many ticks.
  ground::DrivingWind after_long(double speed_m_s, double duration_s, bool is_open = true) {
    for (double end_s = time_s + duration_s - kTick_s; time_s < end_s;) after(speed_m_s, kTick_s, is_open);
    return after(speed_m_s, kTick_s, is_open);
  }

  WindShaping shaping;
  double time_s = 100.0;
  ByHand by_hand;
};

void expect_same_bits(const ground::DrivingWind& shaped, const ground::DrivingWind& real) {
  EXPECT_EQ(shaped.state.wind.u_m_s, real.state.wind.u_m_s);
  EXPECT_EQ(shaped.state.wind.v_m_s, real.state.wind.v_m_s);
  EXPECT_EQ(shaped.ground.everywhere.u_m_s, real.ground.everywhere.u_m_s);
  EXPECT_EQ(shaped.ground.everywhere.v_m_s, real.ground.everywhere.v_m_s);
  EXPECT_EQ(shaped.ground.gusts.along_m_s, real.ground.gusts.along_m_s);
  EXPECT_EQ(shaped.ground.gusts.across_m_s, real.ground.gusts.across_m_s);
  EXPECT_EQ(shaped.ground.gusts.carried.tiles[1].phase(), real.ground.gusts.carried.tiles[1].phase());
}

/// Winds that no site has: steps up to 75 m/s, calms, turns, and gusts of any strength.
ground::DrivingWind hostile_wind(std::mt19937& random, double time_s) {
  const auto uniform = [&](double to) { return to * static_cast<double>(random()) / 4294967296.0; };
  ground::DrivingWind wind = steady_wind(0.0, time_s, uniform(1.0));
  const double speed_m_s = random() % 3 == 0 ? 0.0 : uniform(75.0);
  const double angle_rad = uniform(6.28);
  wind.ground.gusts.ahead = {std::sin(angle_rad), std::cos(angle_rad)};
  wind.ground.everywhere = speed_m_s * wind.ground.gusts.ahead;
  for (float& gust_m_s : wind.ground.gusts.along_m_s) gust_m_s = static_cast<float>(uniform(5.0));
  for (float& gust_m_s : wind.ground.gusts.across_m_s) gust_m_s = static_cast<float>(uniform(5.0));
  wind.state.wind = speed_m_s * wind.ground.gusts.ahead;
  return wind;
}

TEST(WindShaping, WhatIsOffLeavesEveryWindAsItIsBitForBit) {
  WindShaping shaping({}, shared_gusts());
  std::mt19937 random(7);
  for (int tick = 0; tick < 2000; ++tick) {
    const ground::DrivingWind real = hostile_wind(random, kTick_s * tick);
    ground::DrivingWind shaped = real;
    shaping.shape(shaped, true);
    expect_same_bits(shaped, real);
    if (HasFailure()) return;
  }
}

TEST(WindShaping, WhatIsOffAfterAChangeLeavesEveryWindAsItIsBitForBit) {
  WindShaping shaping({.gusts = 2.0, .ceiling = {.from_m_s = 17.0, .most_m_s = 25.0}}, shared_gusts());
  std::mt19937 random(7);
  double time_s = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    if (tick == 500) shaping.change({});
    const ground::DrivingWind real = hostile_wind(random, time_s += kTick_s);
    ground::DrivingWind shaped = real;
    shaping.shape(shaped, true);
    EXPECT_TRUE(std::isfinite(speed_of(shaped.state.wind)));
    if (tick > 500 + static_cast<int>(6.0 * WindShaping::kChangeOver_s / kTick_s)) expect_same_bits(shaped, real);
    if (HasFailure()) return;
  }
}

TEST(WindShaping, TheCeilingAloneTouchesStormsOnly) {
  ShapedWind wind({.ceiling = {.from_m_s = 17.0, .most_m_s = 25.0}});
  for (const double speed_m_s : {0.0, 3.0, 16.99}) {
    const ground::DrivingWind shaped = wind.after(speed_m_s, kTick_s);
    expect_same_bits(shaped, steady_wind(speed_m_s, wind.time_s));
    EXPECT_EQ(wind.shaping.report().ceiling_gain, 1.0);
  }
  double before_m_s = 17.0;
  for (const double speed_m_s : {20.0, 33.0, 50.0, 75.0}) {
    const ground::DrivingWind shaped = wind.after(speed_m_s, kTick_s);
    EXPECT_GT(speed_of(shaped.state.wind), before_m_s);
    EXPECT_LT(speed_of(shaped.state.wind), 25.0);
    EXPECT_NEAR(direction_from_deg(shaped.state.wind), direction_from_deg({0.6, 0.8}), 1e-9);
    EXPECT_NEAR(speed_of(shaped.ground.everywhere), speed_of(shaped.state.wind), 1e-9) << "the ground goes with it";
    before_m_s = speed_of(shaped.state.wind);
  }
}

TEST(WindShaping, RaisesAWeakWindWithItsGustsToTheFloorWithinItsTime) {
  ShapedWind wind({.floor_m_s = 1.5, .over_s = 60.0});
  wind.after(2.0, kTick_s);
  const auto shape_gusty = [&](double dt_s) {
    wind.time_s += dt_s;
    ground::DrivingWind gusty = steady_wind(0.8, wind.time_s);
    gusty.ground.gusts.along_m_s.fill(0.1F);
    wind.shaping.shape(gusty, true);
    return gusty;
  };
  for (double since_s = 0.0; since_s < 60.0 + 10.0; since_s += kTick_s) shape_gusty(kTick_s);
  const ground::DrivingWind soon = shape_gusty(kTick_s);
  EXPECT_NEAR(speed_of(soon.state.wind), 1.5, 0.15) << "of the way from 2 m/s 5 % are left";
  const ground::DrivingWind later = shape_gusty(600.0);
  EXPECT_NEAR(speed_of(later.state.wind), 1.5, 1e-6);
  EXPECT_NEAR(direction_from_deg(later.state.wind), direction_from_deg({0.6, 0.8}), 1e-9);
  EXPECT_NEAR(later.ground.gusts.along_m_s[20], 0.1 * 1.5 / 0.8, 1e-6) << "gusts are raised with the mean";
}

TEST(WindShaping, LeavesAWindAboveTheFloorAsItIsBitForBit) {
  ShapedWind wind({.floor_m_s = 1.5});
  expect_same_bits(wind.after(4.0, kTick_s), steady_wind(4.0, wind.time_s));
  wind.after_long(0.9, 600.0);  // raised by a factor, without a breeze
  const ground::DrivingWind again = wind.after_long(4.0, 60.0);
  expect_same_bits(again, steady_wind(4.0, wind.time_s));
}

TEST(WindShaping, AStillWindGetsABreezeWithTheClimatesTurbulence) {
  WindShapingSettings settings{.floor_m_s = 2.0, .over_s = 10.0, .turbulence_intensity = 0.3, .length_m = 20.0};
  ShapedWind wind(settings);
  double sum = 0.0;
  double along_square = 0.0;
  double across_sum = 0.0;
  double across_square = 0.0;
  constexpr int kSamples = 40'000;
  for (int i = 0; i < kSamples; ++i) {
    const Vector shaped = wind.after(0.0, 0.5).state.wind;
    const double along_m_s = 0.6 * shaped.u_m_s + 0.8 * shaped.v_m_s;
    const double across_m_s = 0.6 * shaped.v_m_s - 0.8 * shaped.u_m_s;
    sum += along_m_s;
    along_square += (along_m_s - 2.0) * (along_m_s - 2.0);
    across_sum += across_m_s;
    across_square += across_m_s * across_m_s;
  }
  EXPECT_NEAR(sum / kSamples, 2.0, 0.1) << "the mean, where the wind last came from";
  EXPECT_NEAR(across_sum / kSamples, 0.0, 0.1);
  // The tiles hold waves of 4 m and more: all but a part of the variance.
  const double most_m_s = settings.turbulence_intensity * settings.floor_m_s;
  EXPECT_LT(std::sqrt(along_square / kSamples), 1.1 * most_m_s);
  EXPECT_GT(std::sqrt(along_square / kSamples), 0.8 * most_m_s);
  EXPECT_LT(std::sqrt(across_square / kSamples), std::sqrt(along_square / kSamples));
}

TEST(WindShaping, TheBreezeDiffersFromPlaceToPlaceAndTheMiddleIsItsMiddle) {
  ShapedWind wind({.floor_m_s = 2.0});
  const ground::DrivingWind shaped = wind.after_long(0.0, 30.0);
  const Vector middle = shaped.ground.at(*shared_gusts(), 0.0, 0.0);
  EXPECT_EQ(middle.u_m_s, shaped.state.wind.u_m_s);
  EXPECT_EQ(middle.v_m_s, shaped.state.wind.v_m_s);
  EXPECT_GT(speed_of(shaped.ground.at(*shared_gusts(), 40.0, 25.0) - middle), 0.02);
}

TEST(WindShaping, AFrontMeetsNoGainOfTheCalmBeforeIt) {
  ShapedWind wind({.floor_m_s = 1.5, .over_s = 120.0});
  wind.after_long(0.5, 600.0);
  EXPECT_NEAR(wind.shaping.report().floor_gain, 3.0, 0.01);
  // Within some seconds the factor is gone, long before the slow mean knows.
  double strongest_m_s = 0.0;
  for (double since_s = 0.0; since_s < 12.0; since_s += kTick_s) {
    const double front_m_s = std::min(8.0, 0.5 + since_s);
    strongest_m_s = std::max(strongest_m_s, speed_of(wind.after(front_m_s, kTick_s).state.wind));
  }
  EXPECT_LT(strongest_m_s, 1.3 * 8.0);
  EXPECT_LT(wind.shaping.report().floor_gain, 1.1);
}

TEST(WindShaping, OpeningAndClosingFadeWithoutAJumpHoweverOftenTheyChangeTheirMind) {
  constexpr double kFade_s = 60.0;
  ShapedWind wind({.closed_level = 0.2, .fade_s = kFade_s});
  double before_m_s = speed_of(wind.after(8.0, kTick_s).state.wind);
  EXPECT_EQ(before_m_s, speed_of(steady_wind(8.0, 0.0).state.wind));
  // Critically damped, toward targets within 0.8 of each other: at most 0.37 times that and the rate.
  const double most_step_m_s = 8.0 * 0.8 / std::numbers::e * (4.75 / kFade_s) * kTick_s * 1.001;
  std::mt19937 random(5);
  bool is_open = true;
  for (int tick = 0; tick < 60'000; ++tick) {
    if (random() % 900 == 0) is_open = !is_open;
    const double speed_m_s = speed_of(wind.after(8.0, kTick_s, is_open).state.wind);
    EXPECT_LE(std::abs(speed_m_s - before_m_s), most_step_m_s);
    EXPECT_GE(speed_m_s, 0.2 * 8.0 - 1e-9);
    EXPECT_LE(speed_m_s, 8.0 + 1e-9);
    before_m_s = speed_m_s;
    if (HasFailure()) return;
  }
}

TEST(WindShaping, AFadeIsDoneInItsTimeAndEndsExactly) {
  ShapedWind wind({.closed_level = 0.0, .fade_s = 30.0});
  wind.after(8.0, kTick_s);
  EXPECT_LT(speed_of(wind.after_long(8.0, 30.0, false).state.wind), 0.06 * 8.0);
  EXPECT_EQ(speed_of(wind.after_long(8.0, 300.0, false).state.wind), 0.0);
  EXPECT_GT(speed_of(wind.after_long(8.0, 30.0, true).state.wind), 0.94 * 8.0);
  expect_same_bits(wind.after_long(8.0, 300.0, true), steady_wind(8.0, wind.time_s));
}

TEST(WindShaping, BeginsClosedWhereItIsClosed) {
  ShapedWind wind({.closed_level = 0.25});
  EXPECT_EQ(speed_of(wind.after(8.0, kTick_s, false).state.wind), 2.0);
  EXPECT_EQ(wind.shaping.report().openness, 0.0);
}

TEST(WindShaping, AWindByHandIsReachedWithinItsTimeAndTheRealOneAfterIt) {
  ShapedWind wind({.turbulence_intensity = 0.0});
  wind.after(3.0, kTick_s);
  wind.by_hand.wind = HeldWind{.speed_m_s = 8.0, .direction_deg = 270.0};
  const Vector soon = wind.after_long(3.0, WindShaping::kHandOver_s).state.wind;
  EXPECT_LT(speed_of(soon - wind_from(8.0, 270.0)), 0.06 * speed_of(wind_from(8.0, 270.0) - 3.0 * Vector{0.6, 0.8}));
  const ground::DrivingWind held = wind.after_long(3.0, 60.0);
  EXPECT_NEAR(held.state.wind.u_m_s, 8.0, 1e-9);
  EXPECT_NEAR(held.state.wind.v_m_s, 0.0, 1e-9);
  EXPECT_NEAR(speed_of(held.ground.at(*shared_gusts(), 30.0, -20.0) - held.state.wind), 0.0, 1e-9) << "everywhere";
  EXPECT_NEAR(speed_of(held.ground.advection - held.state.wind), 0.0, 1e-9) << "it carries the gusts";
  EXPECT_EQ(wind.shaping.report().hand, 1.0);
  wind.by_hand.wind.reset();
  const ground::DrivingWind real = wind.after_long(3.0, 60.0);
  EXPECT_EQ(real.state.wind.u_m_s, steady_wind(3.0, 0.0).state.wind.u_m_s) << "bit for bit";
  EXPECT_EQ(real.ground.gusts.along_m_s, steady_wind(3.0, 0.0).ground.gusts.along_m_s);
  EXPECT_EQ(wind.shaping.report().hand, 0.0);
}

TEST(WindShaping, AWindByHandHasItsOwnMeanAndTurbulenceInACalmAndWhenClosed) {
  constexpr int kSamples = 10'000;
  Vector bias;
  for (const double direction_deg : {25.0, 100.0, 220.0, 310.0}) {
    ShapedWind wind({.closed_level = 0.0, .turbulence_intensity = 0.2, .length_m = 20.0});
    wind.after(0.0, kTick_s, false);
    wind.by_hand.wind = HeldWind{.speed_m_s = 5.0, .direction_deg = direction_deg};
    wind.after_long(0.0, 60.0, false);
    const Vector mean = wind_from(5.0, direction_deg);
    double square = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      const Vector gust = wind.after(0.0, 0.5, false).state.wind - mean;
      bias = bias + (1.0 / kSamples) * gust;
      square += 0.04 * dot(gust, mean) * dot(gust, mean);
    }
    EXPECT_GT(std::sqrt(square / kSamples), 0.8 * 0.2 * 5.0) << direction_deg;
    EXPECT_LT(std::sqrt(square / kSamples), 1.15 * 0.2 * 5.0) << direction_deg;
  }
  EXPECT_LT(speed_of(0.25 * bias), 0.1) << "of four ways across the noise";
}

TEST(WindShaping, WindsByHandThatBeginEndAndReplaceEachOtherNeverJump) {
  ShapedWind wind({.turbulence_intensity = 0.0});
  Vector before = wind.after(4.0, kTick_s).state.wind;
  std::mt19937 random(5);
  const auto uniform = [&](double to) { return to * static_cast<double>(random()) / 4294967296.0; };
  // Part, speed and direction are critically damped: a step of 1 changes by at most 1/e and the rate, also where
  // another follows before it is done (twice that). Of the part 20 + 4 m/s, of the speed 20 m/s, of the turn pi 20 m/s.
  constexpr double kRate_per_s = 4.75 / WindShaping::kHandOver_s / std::numbers::e;
  const double most_step_m_s = 2.0 * kRate_per_s * kTick_s * (24.0 + 20.0 + 20.0 * std::numbers::pi);
  double largest_m_s = 0.0;
  for (int tick = 0; tick < 60'000; ++tick) {
    if (random() % 200 == 0) {
      wind.by_hand.wind = HeldWind{.speed_m_s = uniform(20.0), .direction_deg = uniform(360.0)};
      if (random() % 3 == 0) wind.by_hand.wind.reset();
    }
    const Vector now = wind.after(4.0, kTick_s).state.wind;
    largest_m_s = std::max(largest_m_s, speed_of(now - before));
    EXPECT_LE(speed_of(now - before), most_step_m_s) << tick;
    EXPECT_LE(speed_of(now), 24.0);
    before = now;
    if (HasFailure()) return;
  }
  EXPECT_GT(largest_m_s, 0.0);
}

TEST(WindShaping, AnyWindByHandIsFiniteAmongHostileWinds) {
  WindShaping shaping({.floor_m_s = 1.5, .gusts = 2.0, .ceiling = {.from_m_s = 17.0, .most_m_s = 25.0}},
                      shared_gusts());
  std::mt19937 random(7);
  ByHand by_hand;
  for (int tick = 0; tick < 5000; ++tick) {
    if (random() % 50 == 0) by_hand = {.wind = HeldWind{60.0, static_cast<double>(random() % 361)}, .is_dark = true};
    if (random() % 120 == 0) by_hand = {};
    ground::DrivingWind wind = hostile_wind(random, kTick_s * tick);
    shaping.shape(wind, true, true, by_hand);
    EXPECT_TRUE(std::isfinite(speed_of(wind.state.wind)));
    EXPECT_LT(speed_of(wind.state.wind), 25.0) << "the ceiling holds by hand, too";
    EXPECT_NEAR(speed_of(wind.ground.gusts.ahead), 1.0, 1e-9);
    EXPECT_GE(shaping.report().openness, 0.0);
    EXPECT_LE(shaping.report().openness, 1.0);
    if (HasFailure()) return;
  }
}

TEST(WindShaping, ABlackoutIsNotOpenWithinItsTimeAndChangesNoWind) {
  ShapedWind wind({.fade_s = 300.0});
  wind.after(8.0, kTick_s);
  wind.by_hand.is_dark = true;
  expect_same_bits(wind.after_long(8.0, WindShaping::kDarkOver_s), steady_wind(8.0, wind.time_s));
  EXPECT_LT(wind.shaping.report().openness, 0.06);
  wind.after_long(8.0, 30.0);
  EXPECT_EQ(wind.shaping.report().openness, 0.0);
  wind.by_hand.is_dark = false;
  wind.after_long(8.0, 30.0);
  EXPECT_EQ(wind.shaping.report().openness, 1.0);
}

TEST(WindShaping, HowOpenItIsDoesNotDependOnTheWindThatIsLeftWhenClosed) {
  for (const double closed_level : {0.0, 0.4, 1.0}) {
    ShapedWind wind({.closed_level = closed_level, .fade_s = 30.0});
    wind.after(8.0, kTick_s);
    EXPECT_EQ(wind.shaping.report().openness, 1.0);
    wind.after_long(8.0, 30.0, false);
    EXPECT_NEAR(wind.shaping.report().openness, 0.05, 0.02);
    wind.after_long(8.0, 300.0, false);
    EXPECT_EQ(wind.shaping.report().openness, 0.0);
  }
}

/// Two days of a site in steps of half a minute; every ten minutes another wind, from 0.2 to 2.2 m/s.
void live_through_days(ShapedWind& wind, double days, double live_weight = 1.0) {
  std::mt19937 random(11);
  for (int block = 0; block < static_cast<int>(days * 144.0); ++block) {
    const double speed_m_s = 0.2 + 2.0 * static_cast<double>(random()) / 4294967296.0;
    for (int i = 0; i < 20; ++i) wind.after(speed_m_s, 30.0, true, live_weight);
  }
}

TEST(WindShaping, TheSiteGainTakesTheSitesPercentilesToTheScenes) {
  ShapedWind wind({.site = {.median_m_s = 3.0, .strong_m_s = 5.0, .most_gain = 4.0}, .site_memory_s = 7.0 * 86400.0});
  wind.after(1.2, 1.0);
  EXPECT_EQ(wind.shaping.report().site_gain, 1.0) << "nothing is known yet";
  live_through_days(wind, 0.06);
  EXPECT_LT(wind.shaping.report().site_gain, 2.0) << "the gain grows with what is known";
  live_through_days(wind, 6.0);
  const WindShapingReport report = wind.shaping.report();
  EXPECT_NEAR(report.median_m_s, 1.2, 0.15);
  EXPECT_NEAR(report.strong_m_s, 2.1, 0.2);
  // The two percentiles, and a wind between them.
  EXPECT_NEAR(speed_of(wind.after_long(report.median_m_s, 900.0).state.wind), 3.0, 0.05);
  EXPECT_NEAR(speed_of(wind.after_long(report.strong_m_s, 900.0).state.wind), 5.0, 0.05);
  const double between_m_s = 0.5 * (report.median_m_s + report.strong_m_s);
  EXPECT_NEAR(speed_of(wind.after_long(between_m_s, 900.0).state.wind), 4.0, 0.05);
  EXPECT_NEAR(direction_from_deg(wind.after(1.0, kTick_s).state.wind), direction_from_deg({0.6, 0.8}), 1e-9);
}

TEST(WindShaping, TheSiteGainKeepsItsLimitsAndLearnsFromLiveWindOnly) {
  ShapedWind limited({.site = {.median_m_s = 20.0, .strong_m_s = 0.0, .most_gain = 2.5}, .site_memory_s = 86400.0});
  live_through_days(limited, 2.0, 0.3);
  EXPECT_EQ(limited.shaping.report().known_s, 0.0) << "the default wind says nothing of the site";
  EXPECT_EQ(limited.shaping.report().site_gain, 1.0);
  live_through_days(limited, 3.0);
  EXPECT_NEAR(limited.shaping.report().site_gain, 2.5, 1e-3);
  limited.after(1.0, 3600.0, true, 0.0);
  EXPECT_NEAR(limited.shaping.report().site_gain, 1.0, 1e-3) << "the default wind is as somebody wanted it";
}

TEST(WindShaping, WhatItRemembersGoesOnAfterARestart) {
  const WindShapingSettings settings{.site = {.median_m_s = 3.0}, .site_memory_s = 7.0 * 86400.0};
  ShapedWind before(settings);
  live_through_days(before, 4.0);
  ShapedWind after(settings);
  ASSERT_TRUE(after.shaping.restore(before.shaping.memory().times_s()));
  after.after(1.0, kTick_s);
  EXPECT_NEAR(after.shaping.report().site_gain, before.shaping.report().site_gain, 0.02);
  EXPECT_FALSE(after.shaping.restore(std::vector<double>{1.0, 2.0}));
}

TEST(WindShaping, WhateverComesTheWindIsFiniteBoundedAndItsGainsNeverJump) {
  const WindShapingSettings settings{.floor_m_s = 2.0,
                                     .site = {.median_m_s = 3.0, .strong_m_s = 9.0, .most_gain = 3.0},
                                     .site_memory_s = 8640.0,
                                     .over_s = 10.0,
                                     .ceiling = {.from_m_s = 17.0, .most_m_s = 25.0},
                                     .fade_s = 20.0};
  for (unsigned seed = 1; seed <= 5; ++seed) {
    WindShaping shaping(settings, shared_gusts());
    std::mt19937 random(seed);
    double time_s = 1e6;
    bool is_open = true;
    WindShapingReport before;
    for (int tick = 0; tick < 6000; ++tick) {
      // Mostly ticks; sometimes no time at all, a step back, or a machine that was halted.
      const auto kind = random() % 200;
      const double dt_s = kind == 0 ? 0.0 : kind == 1 ? -100.0 : kind == 2 ? 300.0 : kTick_s;
      if (random() % 300 == 0) is_open = !is_open;
      ground::DrivingWind wind = hostile_wind(random, time_s + dt_s);
      time_s = std::max(time_s, time_s + dt_s);
      shaping.shape(wind, is_open);

      ASSERT_TRUE(std::isfinite(wind.state.wind.u_m_s) && std::isfinite(wind.state.wind.v_m_s)) << seed << ' ' << tick;
      ASSERT_LT(speed_of(wind.state.wind), 25.0 + 1e-9);
      ASSERT_TRUE(std::isfinite(wind.ground.everywhere.u_m_s) && std::isfinite(wind.ground.everywhere.v_m_s));
      for (const float gust_m_s : wind.ground.gusts.along_m_s) ASSERT_TRUE(gust_m_s >= 0.0F && gust_m_s < 200.0F);

      // Critically damped: a range of targets R moves at most R w / e a second.
      const WindShapingReport now = shaping.report();
      const auto largest_step = [&](double range, double over_s) {
        return range * (4.75 / over_s) / std::numbers::e * std::max(dt_s, 0.0) + 1e-5;
      };
      if (tick > 0) {
        ASSERT_LE(std::abs(now.site_gain - before.site_gain), largest_step(3.0 - 1.0 / 3.0, settings.over_s));
        ASSERT_LE(std::abs(now.floor_gain - before.floor_gain), largest_step(2.0, 5.0));
        ASSERT_LE(std::abs(now.breeze_m_s - before.breeze_m_s), largest_step(2.0, 5.0));
        ASSERT_LE(std::abs(now.opening - before.opening), largest_step(1.0, settings.fade_s));
      }
      ASSERT_TRUE(now.site_gain > 0.3 && now.site_gain < 3.0 + 1e-6);
      ASSERT_TRUE(now.floor_gain > 1.0 - 1e-6 && now.floor_gain < WindShaping::kMaxFloorGain + 1e-6);
      before = now;
    }
  }
}

/// What an anemometer with a reading a second says in half an hour of calm, breeze, front, storm, silence and calm.
std::optional<Reading> reading_of_a_day(int second, std::mt19937& random) {
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
  };
  Reading reading;
  reading.time.mono = MonoTime(std::chrono::seconds(second));
  reading.direction_deg = std::fmod(350.0 + 40.0 * std::sin(0.01 * second) + uniform(-10.0, 10.0) + 360.0, 360.0);
  if (second < 400) return reading;
  if (second < 700) reading.speed_m_s = uniform(0.4, 1.0);
  if (second >= 700 && second < 1100)
    reading.speed_m_s = std::min(30.0, 0.1 * (second - 700)) * (1.0 + 0.3 * std::sin(0.5 * second));
  if (second >= 1100 && second < 1200) return std::nullopt;
  return reading;
}

TEST(WindShaping, TheBlendedWindMovesNoQuickerForBeingShapedWhateverTheDayBrings) {
  constexpr int kRate_hz = 15;
  blend::BlendedEstimator estimator(1, {.climate = {.mean_speed_m_s = 3.0}, .rate_hz = kRate_hz}, shared_gusts());
  WindShaping shaping({.floor_m_s = 2.0,
                       .over_s = 60.0,
                       .ceiling = {.from_m_s = 17.0, .most_m_s = 25.0},
                       .closed_level = 0.3,
                       .fade_s = 60.0},
                      shared_gusts());
  // The largest steps from tick to tick while it is calm, and in the storm; in the middle and at a corner.
  struct Largest {
    double real_m_s = 0.0, shaped_m_s = 0.0;
  };
  Largest calm, storm;
  std::mt19937 random(3);
  ground::DrivingWind last_real, last_shaped;
  double weakest_mean_m_s = 1e9;
  for (int tick = 0; tick < 1400 * kRate_hz; ++tick) {
    const int second = tick / kRate_hz;
    if (tick % kRate_hz == 0) {
      if (const auto reading = reading_of_a_day(second, random)) estimator.accept(0, *reading);
    }
    const State state = estimator.advance(MonoTime(from_seconds(static_cast<double>(tick) / kRate_hz)));
    const ground::DrivingWind real{state, estimator.ground()};
    ground::DrivingWind shaped = real;
    shaping.shape(shaped, second / 250 % 2 == 0);
    ASSERT_TRUE(std::isfinite(speed_of(shaped.state.wind)));
    ASSERT_LT(speed_of(shaped.state.wind), 25.0);
    if (second > 200 && second < 400) weakest_mean_m_s = std::min(weakest_mean_m_s, shaping.report().shaped_mean_m_s);

    Largest& largest = second < 700 ? calm : storm;
    for (const double at_m : {0.0, 40.0}) {
      if (tick == 0) break;
      const auto at = [at_m](const ground::DrivingWind& wind) { return wind.ground.at(*shared_gusts(), at_m, at_m); };
      largest.real_m_s = std::max(largest.real_m_s, speed_of(at(real) - at(last_real)));
      largest.shaped_m_s = std::max(largest.shaped_m_s, speed_of(at(shaped) - at(last_shaped)));
    }
    last_real = real;
    last_shaped = shaped;
  }
  EXPECT_GT(weakest_mean_m_s, 1.9) << "a calm is raised";
  // The floor's gain, and gusts that pass at up to its speed; in a storm no gain is above 1, and others of the same
  // gusts pass.
  EXPECT_LT(calm.shaped_m_s, WindShaping::kMaxFloorGain * calm.real_m_s + 0.05);
  EXPECT_LT(storm.shaped_m_s, 1.1 * storm.real_m_s);
}

}  // namespace
}  // namespace yuragi::wind::shaping
