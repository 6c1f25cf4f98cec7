#include "engine/operators/cloth_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/operators/cloth_spline.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"

namespace yuragi::operators {
namespace {

constexpr double kDynamicsTick_s = 1.0 / 60.0;
constexpr std::size_t kFineColumns = 100;
constexpr std::size_t kFineLinks = 90;
constexpr float kFineLink_m = 0.025F;

/// A cloth of 2 m along x, hanging in folds, and the air around it.
struct CoarseSetup {
  explicit CoarseSetup(bool is_first_column_fixed = false)
      : threads(make_threads(kFineLinks, kFineLink_m, folds())),
        coarse(threads, kFineColumns, edge(0.02F), edge(0.0F), edge(0.0F), is_first_column_fixed),
        east(coarse.stride(), 0.0F),
        south(coarse.stride(), 0.0F) {}

  static std::vector<float> folds() {
    std::vector<float> lean(2 * pose::padded_to_blocks(kFineColumns));
    for (std::size_t i = 0; i < lean.size(); ++i) lean[i] = 0.08F * std::sin(0.3F * static_cast<float>(i));
    return lean;
  }
  static std::vector<float> edge(float pitch_m) {
    std::vector<float> places_m(pose::padded_to_blocks(kFineColumns));
    for (std::size_t i = 0; i < places_m.size(); ++i) places_m[i] = pitch_m * static_cast<float>(i);
    return places_m;
  }
  void blow(float east_m_s, float south_m_s, std::uint64_t gust = 0) {
    const math::RandomStream random(gust, math::stream_id("cloth dynamics test"));
    for (std::size_t i = 0; i < east.size(); ++i) {
      const float factor = gust == 0 ? 1.0F : static_cast<float>(0.5 + random.uniform(i));
      east[i] = factor * east_m_s;
      south[i] = factor * south_m_s;
    }
  }
  ClothDynamicsJob job(double dt_s = kDynamicsTick_s) {
    return {.air_east_m_s = east, .air_south_m_s = south, .dt_s = dt_s, .cloth = &coarse};
  }
  void go_on(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) ASSERT_EQ(job().run(), ClothDynamicsJob::Problem::kNone);
  }
  bool is_at_rest() const {
    bool rests = std::all_of(coarse.lean().begin(), coarse.lean().end(), [](float lean) { return lean == 0.0F; });
    for (std::size_t row = 0; row < coarse.rows(); ++row) {
      for (std::size_t column = 0; column < coarse.columns(); ++column) {
        const auto offset = coarse.offset(column, row);
        rests = rests && offset.x_m == 0.0F && offset.y_m == 0.0F && offset.z_m == 0.0F;
      }
    }
    return rests;
  }
  double thread_length_m(std::size_t column) const {
    double length_m = 0.0;
    const auto rest = coarse.rest_link_m();
    for (std::size_t row = 0; row < coarse.links(); ++row) {
      const auto from = coarse.offset(column, row);
      const auto to = coarse.offset(column, row + 1);
      length_m += static_cast<double>(std::hypot(rest[column + 1] + to.x_m - from.x_m,
                                                 rest[coarse.stride() + column + 1] + to.y_m - from.y_m,
                                                 rest[2 * coarse.stride() + column + 1] + to.z_m - from.z_m));
    }
    return length_m;
  }

  ClothThreads threads;
  CoarseCloth coarse;
  std::vector<float> east, south;
};

class ClothDynamicsOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(ClothDynamicsOnEachRow);

TEST_P(ClothDynamicsOnEachRow, ComputesTheSameBitsAsTheBaseRow) {
  CoarseSetup expected;
  CoarseSetup cloth;
  for (std::uint64_t tick = 1; tick < 120; ++tick) {
    expected.blow(3.0F, 8.0F, tick / 7);
    cloth.blow(3.0F, 8.0F, tick / 7);
    ClothDynamicsJob base = expected.job();
    base.row = kBaseSimdRow;
    base.run();
    ClothDynamicsJob job = cloth.job();
    job.row = GetParam();
    EXPECT_EQ(job.run(), ClothDynamicsJob::Problem::kNone);
  }
  EXPECT_EQ(bits_of(cloth.coarse.lean()), bits_of(expected.coarse.lean()));

  // And so does the spline through it.
  ClothSpline expected_spline(expected.coarse.knots(), kFineColumns, kFineLinks);
  ClothSpline spline(cloth.coarse.knots(), kFineColumns, kFineLinks);
  expected_spline.spread(expected.coarse.lean(), kBaseSimdRow);
  spline.spread(cloth.coarse.lean(), GetParam());
  std::vector<float> expected_out(kFineLinks * 2 * pose::padded_to_blocks(kFineColumns), 0.5F);
  std::vector<float> out = expected_out;
  ClothSplineJob{.spline = &expected_spline, .share = 0.7F, .row = kBaseSimdRow, .out = expected_out}.run();
  ClothSplineJob{.spline = &spline, .share = 0.7F, .row = GetParam(), .out = out}.run();
  EXPECT_EQ(bits_of(out), bits_of(expected_out));
}

TEST_P(ClothDynamicsOnEachRow, InCalmAirItDoesNotCreepFromRestIn10000Ticks) {
  CoarseSetup cloth;
  for (int tick = 0; tick < 10'000; ++tick) {
    ClothDynamicsJob job = cloth.job();
    job.row = GetParam();
    job.run();
  }
  EXPECT_TRUE(cloth.is_at_rest());
}

TEST(ClothDynamicsTest, TheWindBlowsItOutAndItSwingsBackThroughRestAndComesToIt) {
  CoarseSetup cloth;
  cloth.blow(0.0F, 5.0F);
  cloth.go_on(300);
  const std::size_t last = cloth.coarse.rows() - 1;
  const float blown_m = cloth.coarse.offset(10, last).z_m;
  EXPECT_GT(blown_m, 0.5F);
  cloth.blow(0.0F, 0.0F);
  float farthest_back_m = 0.0F;
  for (int tick = 0; tick < 200; ++tick) {
    cloth.go_on(1);
    farthest_back_m = std::min(farthest_back_m, cloth.coarse.offset(10, last).z_m);
  }
  EXPECT_LT(farthest_back_m, -0.02F * blown_m);
  cloth.go_on(6000);
  EXPECT_TRUE(cloth.is_at_rest());
}

TEST(ClothDynamicsTest, AStrongerWindBlowsItOutFarther) {
  double before_m = 0.0;
  for (const float speed_m_s : {1.0F, 2.0F, 4.0F, 8.0F, 16.0F}) {
    CoarseSetup cloth;
    cloth.blow(0.0F, speed_m_s);
    cloth.go_on(600);
    const auto offset = cloth.coarse.offset(10, cloth.coarse.rows() - 1);
    const auto blown_m = static_cast<double>(offset.z_m);
    EXPECT_GT(blown_m, 1.05 * before_m) << speed_m_s;
    before_m = blown_m;
  }
}

TEST(ClothDynamicsTest, CoarseThreadsKeepTheirLengthToAFewHundredthsInAGustyWind) {
  // The threads that are made of their leans keep it to 1e-5 (ClothProjectionJob).
  constexpr double kLength_m = static_cast<double>(kFineLink_m) * kFineLinks;
  CoarseSetup cloth;
  double largest = 0.0;
  for (std::uint64_t gust = 1; gust < 60; ++gust) {
    const float azimuth_rad = 0.1F * static_cast<float>(gust);
    cloth.blow(8.0F * std::sin(azimuth_rad), 8.0F * std::cos(azimuth_rad), gust);
    cloth.go_on(12);
    for (std::size_t column = 0; column < cloth.coarse.columns(); ++column) {
      largest = std::max(largest, std::abs(cloth.thread_length_m(column) / kLength_m - 1.0));
    }
  }
  EXPECT_LT(largest, 0.04);
}

TEST(ClothDynamicsTest, IsFiniteAndNoFasterThanItMayBeWhateverBlowsAndHoweverLongTheTicks) {
  CoarseSetup cloth;
  const math::RandomStream random(4, math::stream_id("cloth dynamics nasty"));
  std::vector<float> before(cloth.coarse.lean().begin(), cloth.coarse.lean().end());
  for (std::uint64_t tick = 0; tick < 600; ++tick) {
    const double dt_s = tick % 50 == 0 ? 3.0 : 0.03 * random.uniform(3 * tick) + 1e-6;
    const auto blast = static_cast<float>(tick % 3 == 0 ? 1e6 : 120.0);
    cloth.blow(blast * (static_cast<float>(random.uniform(3 * tick + 1)) - 0.5F),
               blast * (static_cast<float>(random.uniform(3 * tick + 2)) - 0.5F), tick);
    EXPECT_EQ(cloth.job(dt_s).run(), ClothDynamicsJob::Problem::kNone);
    const auto lean = cloth.coarse.lean();
    for (std::size_t i = 0; i < lean.size(); ++i) {
      ASSERT_LE(std::abs(lean[i] - before[i]), 8.0 * dt_s + 1e-5) << tick;  // and with it: finite
    }
    before.assign(lean.begin(), lean.end());
  }
  cloth.blow(0.0F, 0.0F);
  cloth.go_on(20'000);
  EXPECT_TRUE(cloth.is_at_rest());
}

TEST(ClothDynamicsTest, FixedEdgesDoNotMove) {
  CoarseSetup cloth(true);
  cloth.blow(6.0F, 14.0F, 3);
  cloth.go_on(100);
  const std::size_t last = cloth.coarse.rows() - 1;
  EXPECT_NE(cloth.coarse.offset(2, last).z_m, 0.0F);
  for (std::size_t row = 0; row <= last; ++row) EXPECT_EQ(cloth.coarse.offset(0, row).z_m, 0.0F);
  for (std::size_t column = 0; column < cloth.coarse.columns(); ++column) {
    EXPECT_EQ(cloth.coarse.offset(column, 0).z_m, 0.0F);
  }

  // Nor does the fixed column of what is made from it.
  ClothSpline spline(cloth.coarse.knots(), kFineColumns, kFineLinks);
  spline.spread(cloth.coarse.lean(), kBaseSimdRow);
  const std::size_t stride = pose::padded_to_blocks(kFineColumns);
  std::vector<float> out(kFineLinks * 2 * stride);
  EXPECT_EQ((ClothSplineJob{.spline = &spline, .out = out}.run()), ClothSplineJob::Problem::kNone);
  for (std::size_t line = 0; line < 2 * kFineLinks; ++line) EXPECT_EQ(out[line * stride], 0.0F);
  EXPECT_NE(out[1], 0.0F);
}

TEST(ClothSplineTest, StaysBetweenTheCoarseLeansAndFollowsThem) {
  CoarseSetup cloth;
  cloth.blow(2.0F, 6.0F);
  cloth.go_on(200);
  ClothSpline spline(cloth.coarse.knots(), kFineColumns, kFineLinks);
  spline.spread(cloth.coarse.lean(), kBaseSimdRow);
  const std::size_t stride = pose::padded_to_blocks(kFineColumns);
  std::vector<float> out(kFineLinks * 2 * stride);
  ClothSplineJob{.spline = &spline, .out = out}.run();
  const auto lean = cloth.coarse.lean();
  const auto [low, high] = std::minmax_element(lean.begin(), lean.end());
  for (const float value : out) {
    EXPECT_GE(value, *low - 1e-5F);
    EXPECT_LE(value, *high + 1e-5F);
  }

  // In the middle, where the lean goes nearly straight, it is the coarse one.
  const std::size_t coarse_link = cloth.coarse.links() / 2;
  const auto fine_link = static_cast<std::size_t>((static_cast<double>(coarse_link) + 0.5) * kFineLinks /
                                                  static_cast<double>(cloth.coarse.links()));
  const float coarse_lean = lean[(2 * coarse_link + 1) * cloth.coarse.stride() + cloth.coarse.columns() / 2];
  EXPECT_NEAR(out[(2 * fine_link + 1) * stride + kFineColumns / 2], coarse_lean, 0.1F * std::abs(coarse_lean));
}

/// Leans of some knots that grow evenly across and along.
struct EvenLeans {
  EvenLeans() : leans(knots.size()) {
    for (std::size_t link = 0; link < knots.links; ++link) {
      for (std::size_t i = 0; i < knots.stride; ++i) {
        leans[link * 2 * knots.stride + i] = 0.1F * static_cast<float>(i) + 0.2F * static_cast<float>(link);
        leans[(link * 2 + 1) * knots.stride + i] = -0.3F * static_cast<float>(i);
      }
    }
  }

  static constexpr std::size_t kColumns = 26;
  static constexpr std::size_t kLinks = 36;
  ClothKnots knots{.columns = 6, .links = 9, .stride = 16};
  std::vector<float> leans;
};

TEST(ClothSplineTest, GoesThroughTheLeansOfAnyKnots) {
  const EvenLeans even;
  ClothSpline spline(even.knots, EvenLeans::kColumns, EvenLeans::kLinks);
  spline.spread(even.leans, kBaseSimdRow);
  const std::size_t stride = pose::padded_to_blocks(EvenLeans::kColumns);
  std::vector<float> curved(EvenLeans::kLinks * 2 * stride, 0.5F);
  std::vector<float> straight(curved.size());
  const std::vector<float> base(2 * stride, 0.5F);
  ASSERT_EQ((ClothSplineJob{.spline = &spline, .out = curved}.run()), ClothSplineJob::Problem::kNone);
  ASSERT_EQ((ClothLineJob{.spline = &spline, .base = base, .out = straight}.run()), ClothLineJob::Problem::kNone);
  for (std::size_t link = 0; link < EvenLeans::kLinks; ++link) {
    for (std::size_t column = 0; column < EvenLeans::kColumns; ++column) {
      const double knot = 1.0 + static_cast<double>(column) / 5.0;
      const double knot_link = std::clamp((static_cast<double>(link) + 0.5) / 4.0 - 0.5, 0.0, 8.0);
      const std::size_t at = 2 * link * stride + column;
      EXPECT_NEAR(straight[at], 0.5 + 0.1 * knot + 0.2 * knot_link, 1e-5);
      EXPECT_NEAR(straight[at + stride], 0.5 - 0.3 * knot, 1e-5);
      if (link < 8 || link >= EvenLeans::kLinks - 8) continue;  // the spline bends before a thread's ends
      EXPECT_NEAR(curved[at], straight[at], 1e-5);
      EXPECT_NEAR(curved[at + stride], straight[at + stride], 1e-5);
    }
  }
}

TEST(ClothSplineTest, LinesOfNoLeanAreTheBaseOnEveryRow) {
  const EvenLeans even;
  ClothSpline spline(even.knots, EvenLeans::kColumns, EvenLeans::kLinks);
  const std::size_t width = 2 * pose::padded_to_blocks(EvenLeans::kColumns);
  std::vector<float> base(width);
  for (std::size_t i = 0; i < width; ++i) base[i] = 0.01F * static_cast<float>(i) - 0.2F;
  std::vector<float> out(3 * width);
  ASSERT_EQ((ClothLineJob{.spline = &spline, .base = base, .first_link = 5, .out = out}.run()),
            ClothLineJob::Problem::kNone);
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_EQ(out[i], base[i % width]);

  spline.spread(even.leans, kBaseSimdRow);
  std::vector<float> expected(out.size());
  ClothLineJob{.spline = &spline, .base = base, .first_link = 5, .row = kBaseSimdRow, .out = expected}.run();
  for (const SimdRow row : kSimdRows) {
    if (!is_runnable(row)) continue;
    ClothLineJob{.spline = &spline, .base = base, .first_link = 5, .row = row, .out = out}.run();
    EXPECT_EQ(bits_of(out), bits_of(expected));
  }
}

TEST(ClothSplineTest, ALineJobSaysWhatIsWrong) {
  using Problem = ClothLineJob::Problem;
  const EvenLeans even;
  const ClothSpline spline(even.knots, EvenLeans::kColumns, EvenLeans::kLinks);
  std::vector<float> out(2 * pose::padded_to_blocks(EvenLeans::kColumns));
  const std::vector<float> base = out;
  EXPECT_EQ((ClothLineJob{.base = base, .out = out}.run()), Problem::kNoSpline);
  EXPECT_EQ((ClothLineJob{.spline = &spline, .base = {}, .out = out}.run()), Problem::kSizesDiffer);
  EXPECT_EQ((ClothLineJob{.spline = &spline, .base = base, .first_link = EvenLeans::kLinks, .out = out}.run()),
            Problem::kSizesDiffer);
}

TEST(ClothDynamicsTest, SaysWhatIsWrongAndThenDoesNothing) {
  using Problem = ClothDynamicsJob::Problem;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CoarseSetup cloth;
  cloth.blow(5.0F, 5.0F);
  ClothDynamicsJob job = cloth.job();
  job.cloth = nullptr;
  EXPECT_EQ(job.run(), Problem::kNoCloth);
  for (const double dt_s : {0.0, -1.0, nan}) EXPECT_EQ(cloth.job(dt_s).run(), Problem::kStepNotPositive);
  for (double ClothDynamicsJob::*parameter :
       {&ClothDynamicsJob::normal_drag_per_m, &ClothDynamicsJob::skin_drag_per_m,
        &ClothDynamicsJob::across_stiffness_s2, &ClothDynamicsJob::damping_per_s, &ClothDynamicsJob::largest_speed_m_s,
        &ClothDynamicsJob::largest_lean_per_s}) {
    for (const double wrong : {-1.0, nan}) {
      job = cloth.job();
      job.*parameter = wrong;
      EXPECT_EQ(job.run(), Problem::kParameter);
    }
  }
  job = cloth.job();
  job.air_east_m_s = job.air_east_m_s.first(3);
  EXPECT_EQ(job.run(), Problem::kSizesDiffer);
  EXPECT_TRUE(cloth.is_at_rest());

  ClothSpline spline(cloth.coarse.knots(), kFineColumns, kFineLinks);
  std::vector<float> out(2 * pose::padded_to_blocks(kFineColumns));
  EXPECT_EQ((ClothSplineJob{.out = out}.run()), ClothSplineJob::Problem::kNoSpline);
  EXPECT_EQ((ClothSplineJob{.spline = &spline, .share = NAN, .out = out}.run()),
            ClothSplineJob::Problem::kShareNotFinite);
  EXPECT_EQ((ClothSplineJob{.spline = &spline, .first_link = kFineLinks, .out = out}.run()),
            ClothSplineJob::Problem::kSizesDiffer);
}

}  // namespace
}  // namespace yuragi::operators
