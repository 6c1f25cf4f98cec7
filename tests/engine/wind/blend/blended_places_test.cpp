#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/engine/wind/blend/blend_run.hpp"

namespace yuragi::wind::blend {
namespace {

constexpr double kReach_m = 30.0;

/// An estimator, and tapes that hear each of its ticks.
class PlacedBlend {
 public:
  PlacedBlend(const std::vector<SourceSettings>& sources, double turbulence_intensity, std::uint64_t seed = 1)
      : run(sources.size(), settings(sources, turbulence_intensity, seed)) {
    take(run.state());
  }

  void run_for(double duration_s, const std::function<void(const ground::Wind&)>& each = {}) {
    run.run_for(duration_s, [&](const State& state) {
      take(state);
      if (each) each(ground);
    });
  }
  void read_for(double duration_s, double speed_m_s, double direction_deg,
                const std::function<void(const ground::Wind&)>& each = {}) {
    for (int i = 0; i < static_cast<int>(duration_s); ++i) {
      run.read(speed_m_s, direction_deg);
      run_for(1.0, each);
    }
  }

  const ground::WindPen& pen(std::size_t index) { return run.estimator().stroke().pens[index]; }
  const ground::WindStroke& stroke() { return run.estimator().stroke(); }
  Vector at(double east_m, double south_m) const { return ground.at(*shared_gust_noise(), east_m, south_m); }

  BlendRun run;
  ground::Wind ground;

 private:
  static Settings settings(const std::vector<SourceSettings>& sources, double turbulence_intensity,
                           std::uint64_t seed) {
    Settings settings = BlendRun::usual(seed, turbulence_intensity);
    settings.reach_m = kReach_m;
    settings.sources = sources;
    return settings;
  }
  void take(const State& state) {
    ground = written_to(tapes_, {state, run.estimator().ground(), run.estimator().stroke()});
  }

  ground::WindTapes tapes_;
};

SourceSettings placed_source(double east_m, double south_m = 0.0, int priority = 1) {
  return {.priority = priority, .has_place = true, .east_m = east_m, .south_m = south_m};
}

TEST(BlendedPlaces, WhoIsNotToldItsPlaceStandsAtTheWindwardEdge) {
  PlacedBlend blend({{}}, 0.0);
  for (const double from_deg : {180.0, 270.0, 45.0}) {
    blend.read_for(400.0, 5.0, from_deg);
    const Vector from = wind_from(1.0, from_deg);
    ASSERT_EQ(blend.stroke().pen_count, 1U);
    // The mean forgets the wind before within some times 100 s.
    EXPECT_NEAR(blend.pen(0).east_m, -kReach_m * from.u_m_s, 0.8) << from_deg;
    EXPECT_NEAR(blend.pen(0).south_m, kReach_m * from.v_m_s, 0.8) << from_deg;
    EXPECT_NEAR(std::hypot(blend.pen(0).east_m, blend.pen(0).south_m), kReach_m, 1e-9);
    EXPECT_NEAR(blend.run.state().upwind_m, kReach_m, 1e-9);
    EXPECT_NEAR(blend.run.state().to_middle_s, kReach_m / 5.0, 0.3);
    EXPECT_FALSE(blend.run.state().is_place_configured);
  }
}

TEST(BlendedPlaces, TheEdgeGoesRoundWithoutALeapWhenTheWindTurns) {
  PlacedBlend blend({{}}, 0.0);
  blend.read_for(200.0, 5.0, 180.0);
  double east_m = blend.pen(0).east_m;
  double south_m = blend.pen(0).south_m;
  blend.read_for(100.0, 5.0, 10.0, [&](const ground::Wind&) {
    ASSERT_LT(std::hypot(blend.pen(0).east_m - east_m, blend.pen(0).south_m - south_m), 0.6);
    east_m = blend.pen(0).east_m;
    south_m = blend.pen(0).south_m;
  });
  EXPECT_GT(blend.pen(0).east_m, -kReach_m);
}

TEST(BlendedPlaces, WhoIsToldItsPlaceStandsThereOrUpwindOfItByItsLead) {
  SourceSettings source = placed_source(3.0, -8.0);
  source.lead_m = 12.0;
  PlacedBlend blend({source}, 0.0);
  blend.read_for(300.0, 4.0, 180.0);
  EXPECT_NEAR(blend.pen(0).east_m, 3.0, 0.1);
  EXPECT_NEAR(blend.pen(0).south_m, -8.0 + 12.0, 0.1);
  EXPECT_TRUE(blend.run.state().is_place_configured);
  EXPECT_NEAR(blend.run.state().upwind_m, 4.0, 0.1);
  EXPECT_NEAR(blend.run.state().to_middle_s, 1.0, 0.05);
  blend.read_for(300.0, 4.0, 0.0);
  EXPECT_NEAR(blend.pen(0).south_m, -8.0 - 12.0, 0.1);
  blend.read_for(1.0, 4.0, 0.0);
  EXPECT_NEAR(blend.run.state().upwind_m, 20.0, 0.1);

  PlacedBlend downwind({placed_source(0.0, -8.0)}, 0.0);
  downwind.read_for(200.0, 4.0, 180.0);
  EXPECT_NEAR(downwind.run.state().upwind_m, -8.0, 0.1);
  EXPECT_EQ(downwind.run.state().to_middle_s, 0.0) << "a gust has passed the middle when it is measured";
}

TEST(BlendedPlaces, TheWindThatIsShownIsThatOfTheGroundAtThePen) {
  for (const bool is_placed : {false, true}) {
    PlacedBlend blend({is_placed ? placed_source(5.0, 3.0) : SourceSettings{}}, 0.3, 4);
    TestGusts gusts(2);
    for (int second = 0; second < 120; ++second) {
      if (second < 60 || second > 80) blend.run.read(std::max(0.1, 6.0 + 1.5 * gusts.next()), 200.0);
      blend.run_for(1.0, [&](const ground::Wind&) {
        // While it begins to be heard, the table of what is kept lags by half a second.
        if (second < 2) return;
        const Vector there = blend.at(blend.pen(0).east_m, blend.pen(0).south_m);
        ASSERT_NEAR(there.u_m_s, blend.run.state().wind.u_m_s, 1e-5) << second;
        ASSERT_NEAR(there.v_m_s, blend.run.state().wind.v_m_s, 1e-5) << second;
      });
    }
  }
}

TEST(BlendedPlaces, AConstantWindIsConstantEverywhere) {
  // The climate is the same wind: it has no turbulence, so that nothing fills anything.
  PlacedBlend blend({{}, placed_source(10.0, 5.0)}, 0.0);
  double largest_m_s = 0.0;
  for (int second = 0; second < 120; ++second) {
    blend.run.read(4.0, 180.0, 0);
    blend.run.read(4.0, 180.0, 1);
    blend.run_for(1.0, [&](const ground::Wind&) {
      for (const double east_m : {-30.0, 0.0, 10.0, 25.0}) {
        for (const double south_m : {-30.0, 5.0, 30.0}) {
          largest_m_s = std::max(largest_m_s, speed_of(blend.at(east_m, south_m) - Vector{0.0, 4.0}));
        }
      }
    });
  }
  EXPECT_LT(largest_m_s, 1e-3);
}

TEST(BlendedPlaces, CalmStaysCalmExactly) {
  Settings settings = BlendRun::usual(1, 0.2);
  settings.climate.mean_speed_m_s = 0.0;
  settings.reach_m = kReach_m;
  settings.sources = {{}, placed_source(10.0)};
  BlendRun run(2, settings);
  ground::WindTapes tapes;
  for (int second = 0; second < 60; ++second) {
    run.read(0.0, 90.0, 0);
    run.read(0.0, std::nullopt, 1);
    run.run_for(1.0, [&](const State& state) {
      const ground::Wind ground = written_to(tapes, {state, run.estimator().ground(), run.estimator().stroke()});
      ASSERT_EQ(speed_of(state.wind), 0.0);
      for (const double at_m : {-30.0, 0.0, 17.0}) ASSERT_EQ(speed_of(ground.at(*shared_gust_noise(), at_m, 9.0)), 0.0);
    });
  }
}

TEST(BlendedPlaces, AReadingThatIsNoNumberDisturbsNoPlace) {
  PlacedBlend with({{}}, 0.3, 2);
  PlacedBlend without({{}}, 0.3, 2);
  for (int second = 0; second < 60; ++second) {
    const double speed_m_s = 5.0 + std::sin(second);
    if (second > 20) {
      with.run.read(std::numeric_limits<double>::quiet_NaN(), 90.0);
      with.run.read(std::numeric_limits<double>::infinity(), 90.0);
    }
    with.run.read(speed_m_s, 180.0);
    without.run.read(speed_m_s, 180.0);
    with.run_for(1.0);
    without.run_for(1.0);
    for (const double at_m : {-20.0, 0.0, 20.0}) {
      ASSERT_TRUE(std::isfinite(speed_of(with.at(at_m, at_m))));
      ASSERT_NEAR(speed_of(with.at(at_m, at_m)), speed_of(without.at(at_m, at_m)), 0.5);
    }
  }
}

TEST(BlendedPlaces, AMicrophoneWritesWhereTheAnemometerStandsWhoseGustsItFills) {
  SourceSettings microphone = placed_source(-25.0, 0.0, 2);
  microphone.is_relative = true;
  PlacedBlend blend({placed_source(8.0), microphone}, 0.2);
  TestGusts gusts(3);
  double sum_m_s = 0.0;
  for (int second = 0; second < 120; ++second) {
    const double true_m_s = 6.0 + gusts.next();
    sum_m_s += true_m_s;
    if (second % 30 == 29) {
      blend.run.read(sum_m_s / 30.0, 180.0, 0);
      sum_m_s = 0.0;
    }
    blend.run.read(0.4 * true_m_s, std::nullopt, 1);
    blend.run_for(1.0);
  }
  ASSERT_EQ(blend.stroke().pen_count, 1U);
  EXPECT_NEAR(blend.pen(0).east_m, 8.0, 1e-9);
  double written_m_s = 0.0;
  for (std::size_t band = 6; band < 10; ++band) {
    written_m_s += std::abs(static_cast<double>(blend.pen(0).now.north_m_s[band]));
  }
  EXPECT_GT(written_m_s, 0.05) << "gusts that are too quick for the anemometer";
}

TEST(BlendedPlaces, TwoOfOneRankEachHaveTheirOwnGustsWhereTheyStand) {
  PlacedBlend blend({placed_source(-40.0), placed_source(40.0)}, 0.0);
  // West a gust of 20 s, east none.
  double west_m_s = 0.0;
  double east_m_s = 0.0;
  for (int second = 0; second < 400; ++second) {
    blend.run.read(6.0 + std::sin(2.0 * std::numbers::pi * second / 20.0), 180.0, 0);
    blend.run.read(6.0, 180.0, 1);
    blend.run_for(1.0, [&](const ground::Wind& ground) {
      if (second < 200) return;
      west_m_s = std::max(west_m_s, std::abs(ground.measured_at(-40.0, 0.0).v_m_s - 6.0));
      east_m_s = std::max(east_m_s, std::abs(ground.measured_at(40.0, 0.0).v_m_s - 6.0));
    });
  }
  EXPECT_EQ(blend.stroke().pen_count, 2U);
  EXPECT_GT(west_m_s, 0.6);
  EXPECT_LT(east_m_s, 0.3);
  EXPECT_NEAR(blend.pen(0).part, 0.5, 1e-6);
  EXPECT_EQ(blend.pen(0).presence, 1.0);
  EXPECT_EQ(blend.pen(1).presence, 1.0);
}

/// The largest step from tick to tick at some places, while two sensors at two places swing differently, and one of
/// them speaks when `speaks` says so.
double largest_step_m_s(const std::vector<SourceSettings>& sources, const std::function<bool(int second)>& speaks) {
  PlacedBlend blend(sources, 0.2);
  const std::vector<Vector> places = {{-15.0, 0.0}, {15.0, 0.0}, {0.0, -20.0}, {0.0, 0.0}};
  std::vector<Vector> before(places.size());
  double largest_m_s = 0.0;
  for (int second = 0; second < 330; ++second) {
    const double slow_m_s = 2.0 * std::sin(2.0 * std::numbers::pi * second / 800.0);
    const double quick_m_s = 0.5 * std::sin(2.0 * std::numbers::pi * second / 17.0);
    if (speaks(second)) blend.run.read(7.0 + slow_m_s + quick_m_s, 180.0, 0);
    blend.run.read(7.0 - slow_m_s + quick_m_s, 180.0, 1);
    blend.run_for(1.0, [&](const ground::Wind& ground) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        const Vector now = ground.measured_at(places[i].u_m_s, places[i].v_m_s);
        if (second > 150) largest_m_s = std::max(largest_m_s, speed_of(now - before[i]));
        before[i] = now;
      }
    });
  }
  return largest_m_s;
}

// Slow waves, of which the law loses nothing, are 4 m/s apart when one falls silent, and when it is back. Of its word a
// hand-over of 3 s takes 0.25 a second, which is 1.2 a second of its presence.
constexpr double kMaxChange_m_s = 4.0 * 1.2 * kBlendTick_s;
bool is_there(int second) {
  return second < 200 || second > 270;
}

TEST(BlendedPlaces, OneOfTwoThatComesOrGoesMovesNoPlaceByALeap) {
  const std::vector<SourceSettings> sources = {placed_source(-15.0), placed_source(15.0)};
  const double normal_m_s = largest_step_m_s(sources, [](int) { return true; });
  EXPECT_LT(normal_m_s, 0.02);
  EXPECT_LT(largest_step_m_s(sources, is_there), kMaxChange_m_s + normal_m_s);
}

TEST(BlendedPlaces, OneThatTakesOverAtAnotherPlaceMovesNoPlaceByALeap) {
  EXPECT_LT(largest_step_m_s({placed_source(-15.0), placed_source(15.0, 0.0, 2)}, is_there), 2.0 * kMaxChange_m_s);
}

TEST(BlendedPlaces, AGustComesLaterTheFartherDownwindAPlaceIs) {
  PlacedBlend blend({{}}, 0.0);
  blend.read_for(300.0, 5.0, 180.0);
  std::vector<double> arrived_s(3, 0.0);
  const std::vector<double> south_m = {30.0, 10.0, -20.0};
  double time_s = 0.0;
  blend.read_for(20.0, 8.0, 180.0, [&](const ground::Wind& ground) {
    time_s += kBlendTick_s;
    for (std::size_t i = 0; i < south_m.size(); ++i) {
      if (arrived_s[i] == 0.0 && ground.measured_at(0.0, south_m[i]).v_m_s > 6.0) arrived_s[i] = time_s;
    }
  });
  // The front itself makes the wind that carries it a little faster.
  EXPECT_NEAR(arrived_s[1] - arrived_s[0], 20.0 / 5.1, 0.4);
  EXPECT_NEAR(arrived_s[2] - arrived_s[0], 50.0 / 5.2, 0.9);
}

}  // namespace
}  // namespace yuragi::wind::blend
