#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/wind/shaping/wind_shaping.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/stroke_run.hpp"

namespace yuragi::wind::shaping {
namespace {

/// A wind toward north of 6 m/s that is measured 20 m south of the middle, with gusts of 0.1 Hz and noise beside them.
class MeasuredWind {
 public:
  explicit MeasuredWind(double speed_m_s = 6.0) {
    run_.blow({0.0, speed_m_s});
    run_.take_only(kBand);
    gusts_.ahead = {0.0, 1.0};
    gusts_.carried = shared_gusts()->begin(1);
    gusts_.along_m_s.fill(0.2F);
    gusts_.across_m_s.fill(0.1F);
  }

  /// The next tick; gusts swing by `gust_m_s`.
  ground::DrivingWind next(double gust_m_s) {
    const double now_m_s = gust_m_s * std::sin(2.0 * std::numbers::pi * 0.1 * time_s_);
    time_s_ += StrokeRun::kTick_s;
    run_.step([now_m_s](std::size_t, ground::WindSample& now) {
      now.north_m_s[kBand] = static_cast<float>(now_m_s);
      now.known_along.fill(0.8F);
      now.known_across.fill(0.6F);
    });
    const Vector wind = run_.wind();
    shared_gusts()->carry(gusts_.carried, wind.u_m_s, -wind.v_m_s, StrokeRun::kTick_s);
    ground::DrivingWind driving{.state = {.time = MonoTime(from_seconds(100.0 + time_s_)),
                                          .wind = {},
                                          .source = Source::kLive,
                                          .live_weight = 1.0},
                                .stroke = run_.stroke()};
    driving.ground.gusts = gusts_;
    const Vector way = shared_gusts()->everywhere(gusts_);
    driving.ground.everywhere = wind + way;
    driving.stroke.pens[0].now.way = driving.stroke.pens[0].written.way = way;
    driving.state.wind = wind_where_measured(driving.ground, driving.stroke, *shared_gusts());
    return driving;
  }

 private:
  static constexpr std::size_t kBand = 5;
  StrokeRun run_{{{0.0, 20.0}}};
  turbulence::GustNoise::Moment gusts_;
  double time_s_ = 0.0;
};

constexpr std::array<Vector, 4> kPlaces = {Vector{0.0, 20.0}, {3.0, 10.0}, {-5.0, -15.0}, {10.0, 25.0}};

Vector wind_at(const ground::Wind& ground, Vector place) {
  return ground.at(*shared_gusts(), place.u_m_s, place.v_m_s);
}

/// A wind as it is and as it is shaped, each on tapes of its own.
struct Both {
  explicit Both(const WindShapingSettings& settings, double speed_m_s = 6.0)
      : wind(speed_m_s), shaping(settings, shared_gusts()) {}
  void next(double gust_m_s, bool is_open = true) {
    real = wind.next(gust_m_s);
    shaped = real;
    shaping.shape(shaped, is_open);
    real_ground = written_to(real_tapes, real);
    shaped_ground = written_to(shaped_tapes, shaped);
  }
  MeasuredWind wind;
  WindShaping shaping;
  ground::WindTapes real_tapes, shaped_tapes;
  ground::DrivingWind real, shaped;
  ground::Wind real_ground, shaped_ground;
};

TEST(WindShapingOfPlaces, WhatIsOffChangesNoBitAnywhere) {
  Both both({});
  for (int tick = 0; tick < 600; ++tick) {
    both.next(1.0);
    ASSERT_EQ(both.shaped.state.wind.v_m_s, both.real.state.wind.v_m_s);
    const ground::WindPen& shaped = both.shaped.stroke.pens[0];
    const ground::WindPen& real = both.real.stroke.pens[0];
    ASSERT_EQ(shaped.now.north_m_s, real.now.north_m_s);
    ASSERT_EQ(shaped.written.known_along, real.written.known_along);
    ASSERT_EQ(shaped.now.gain, 1.0);
    ASSERT_EQ(both.shaped.stroke.way_m, both.real.stroke.way_m);
    for (const Vector place : kPlaces) {
      ASSERT_EQ(wind_at(both.shaped_ground, place).u_m_s, wind_at(both.real_ground, place).u_m_s);
      ASSERT_EQ(wind_at(both.shaped_ground, place).v_m_s, wind_at(both.real_ground, place).v_m_s);
    }
  }
}

TEST(WindShapingOfPlaces, TheOpeningIsOnAllPlacesAtOnce) {
  Both both({.closed_level = 0.25, .fade_s = 5.0});
  for (int tick = 0; tick < 1800; ++tick) both.next(1.0, false);
  for (const Vector place : kPlaces) {
    const Vector real = wind_at(both.real_ground, place);
    const Vector shaped = wind_at(both.shaped_ground, place);
    EXPECT_NEAR(shaped.u_m_s, 0.25 * real.u_m_s, 1e-5);
    EXPECT_NEAR(shaped.v_m_s, 0.25 * real.v_m_s, 1e-5);
  }
}

TEST(WindShapingOfPlaces, GustsAreScaledAboutTheMeanAtAllPlaces) {
  for (const double gusts : {0.0, 0.5, 2.0, 3.0}) {
    Both both({.gusts = gusts});
    for (int tick = 0; tick < 900; ++tick) both.next(1.0);
    const Vector mean{0.0, 6.0};
    for (const Vector place : kPlaces) {
      const Vector real = wind_at(both.real_ground, place) - mean;
      const Vector shaped = wind_at(both.shaped_ground, place) - mean;
      EXPECT_GT(speed_of(real), 0.01);
      EXPECT_NEAR(shaped.u_m_s, gusts * real.u_m_s, 1e-4) << gusts;
      EXPECT_NEAR(shaped.v_m_s, gusts * real.v_m_s, 1e-4) << gusts;
    }
    const Vector shown = both.shaped.state.wind - mean;
    const Vector measured = both.real.state.wind - mean;
    EXPECT_NEAR(shown.v_m_s, gusts * measured.v_m_s, 1e-4) << gusts;
  }
}

TEST(WindShapingOfPlaces, WhereNothingIsMeasuredAllGustsAreScaledToo) {
  for (const double gusts : {0.0, 2.0}) {
    WindShaping shaping({.gusts = gusts}, shared_gusts());
    MeasuredWind wind;
    ground::DrivingWind real = wind.next(0.0);
    real.stroke.pen_count = 0;
    real.state.wind = wind_where_measured(real.ground, real.stroke, *shared_gusts());
    ground::DrivingWind shaped = real;
    shaping.shape(shaped, true);
    const Vector mean{0.0, 6.0};
    for (const Vector place : kPlaces) {
      const Vector expected = mean + gusts * (wind_at(real.ground, place) - mean);
      EXPECT_NEAR(wind_at(shaped.ground, place).u_m_s, expected.u_m_s, 1e-4) << gusts;
      EXPECT_NEAR(wind_at(shaped.ground, place).v_m_s, expected.v_m_s, 1e-4) << gusts;
    }
    EXPECT_NEAR(speed_of(shaped.state.wind - (mean + gusts * (real.state.wind - mean))), 0.0, 1e-4);
  }
}

TEST(WindShapingOfPlaces, TheCeilingsGainGoesWithTheGustThatItCut) {
  Both both({.ceiling = {.from_m_s = 5.0, .most_m_s = 8.0}});
  std::array<double, 600> gains{};
  for (int tick = 0; tick < 600; ++tick) {
    both.next(3.0);
    gains[static_cast<std::size_t>(tick)] = both.shaping.report().ceiling_gain;
    if (tick < 400) continue;
    // 12 m at 6 m/s: 120 ticks.
    const ground::WindTapes::Reading reading = both.shaped_tapes.at(0.0, 8.0);
    ASSERT_NEAR(reading.gain, gains[static_cast<std::size_t>(tick - 120)], 0.02) << tick;
    const Vector there = wind_at(both.shaped_ground, {0.0, 8.0});
    const Vector real = wind_at(both.real_ground, {0.0, 8.0});
    ASSERT_NEAR(there.v_m_s, reading.gain * real.v_m_s, 1e-4);
  }
}

TEST(WindShapingOfPlaces, ABreezeBlowsOverACalmThatIsMeasured) {
  Both both({.floor_m_s = 2.0, .over_s = 5.0}, 0.0);
  double largest_difference_m_s = 0.0;
  for (int tick = 0; tick < 3000; ++tick) {
    ground::DrivingWind calm = both.wind.next(0.0);
    calm.ground.gusts.along_m_s.fill(0.0F);
    calm.ground.gusts.across_m_s.fill(0.0F);
    calm.ground.everywhere = {};
    calm.stroke.pens[0].now.way = calm.stroke.pens[0].written.way = {};
    calm.state.wind = {};
    both.shaping.shape(calm, true);
    both.shaped_ground = written_to(both.shaped_tapes, calm);
    if (tick < 1500) continue;
    const Vector pen = wind_at(both.shaped_ground, {0.0, 20.0});
    ASSERT_NEAR(speed_of(pen - calm.state.wind), 0.0, 1e-3);
    ASSERT_LT(speed_of(pen), 6.0);
    largest_difference_m_s = std::max(largest_difference_m_s, speed_of(pen - wind_at(both.shaped_ground, {0.0, 0.0})));
  }
  EXPECT_GT(both.shaping.report().breeze_m_s, 1.9);
  EXPECT_GT(largest_difference_m_s, 0.2) << "it has gusts, although the calm is known";
}

}  // namespace
}  // namespace yuragi::wind::shaping
