// What water remembers of the wind: it wakes more slowly than a gust comes, outlives it, and is carried downwind.

#include "viewer/looks/water_memory.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi::viewer::looks {
namespace {

constexpr std::size_t kSide = 40;
constexpr float kCell_m = 0.2F;

/// A pond with the same forces everywhere.
class Pond {
 public:
  void advance_to(double time_s, float gust, float breaking, const glm::vec2& wind_m_s = {0.0F, 0.0F}) {
    std::ranges::fill(gusts_, gust);
    std::ranges::fill(breaking_, breaking);
    advance_to(time_s, wind_m_s);
  }
  void advance_to(double time_s, const glm::vec2& wind_m_s) {
    memory_.advance_to(time_s, {.wind_m_s = wind_m_s, .gusts = gusts_, .breaking = breaking_});
  }
  /// As advance_to() in steps of 1/60 s.
  void hold(double from_s, double to_s, float gust, float breaking) {
    const auto steps = std::lround((to_s - from_s) * 60.0);
    for (long i = 1; i <= steps; ++i) advance_to(from_s + static_cast<double>(i) / 60.0, gust, breaking);
  }

  std::vector<float>& gusts() { return gusts_; }
  float woken(std::size_t row = 20, std::size_t column = 20) const {
    return memory_.cells()[2 * (row * kSide + column)];
  }
  float foam() const { return memory_.cells()[2 * (20 * kSide + 20) + 1]; }
  const WaterMemory& memory() const { return memory_; }

 private:
  WaterMemory memory_{kSide, kSide, {kCell_m, 0.0F}, {0.0F, kCell_m}};
  std::vector<float> gusts_ = std::vector<float>(kSide * kSide, 0.0F);
  std::vector<float> breaking_ = std::vector<float>(kSide * kSide, 0.0F);
};

TEST(WaterMemory, BeginsSettled) {
  Pond pond;
  pond.advance_to(100.0, 0.7F, 0.2F, {3.0F, 4.0F});
  EXPECT_EQ(pond.woken(), 0.7F);
  EXPECT_EQ(pond.foam(), 0.2F);
  EXPECT_EQ(pond.memory().shaping_wind_m_s(), glm::vec2(3.0F, 4.0F));
}

TEST(WaterMemory, AGustWakesItWithATimeConstantOf1300Milliseconds) {
  Pond pond;
  pond.advance_to(0.0, 0.0F, 0.0F);
  pond.hold(0.0, 1.3, 1.0F, 0.0F);
  EXPECT_NEAR(pond.woken(), 1.0 - std::exp(-1.0), 0.01);
}

TEST(WaterMemory, ItCalmsAndLosesFoamWithATimeConstantOf3Seconds) {
  Pond pond;
  pond.advance_to(0.0, 1.0F, 1.0F);
  pond.hold(0.0, 3.0, 0.0F, 0.0F);
  EXPECT_NEAR(pond.woken(), std::exp(-1.0), 0.01);
  EXPECT_NEAR(pond.foam(), std::exp(-1.0), 0.01);
}

TEST(WaterMemory, DoesNotDependOnTheNumberOfSteps) {
  Pond often, seldom;
  for (Pond* pond : {&often, &seldom}) pond->advance_to(0.0, -0.5F, 0.0F);
  often.hold(0.0, 2.0, 0.8F, 0.4F);
  seldom.advance_to(2.0, 0.8F, 0.4F);
  EXPECT_NEAR(often.woken(), seldom.woken(), 1e-4);
  EXPECT_NEAR(often.foam(), seldom.foam(), 1e-4);
}

TEST(WaterMemory, TheSameMomentAgainChangesNothing) {
  Pond pond;
  pond.advance_to(5.0, 0.2F, 0.1F);
  pond.advance_to(5.0, 1.0F, 1.0F);
  EXPECT_EQ(pond.woken(), 0.2F);
}

TEST(WaterMemory, BackInTimeItBeginsAnew) {
  Pond pond;
  pond.advance_to(5.0, 0.2F, 0.1F);
  pond.advance_to(4.0, 0.9F, 0.3F);
  EXPECT_EQ(pond.woken(), 0.9F);
}

TEST(WaterMemory, IsCarriedDownwind) {
  Pond pond;
  for (std::size_t row = 18; row < 22; ++row) {
    for (std::size_t column = 8; column < 12; ++column) pond.gusts()[row * kSide + column] = 1.0F;
  }
  const glm::vec2 to_the_east_m_s(10.0F, 0.0F);
  pond.advance_to(0.0, to_the_east_m_s);
  std::ranges::fill(pond.gusts(), 0.0F);
  const auto middle_column = [&] {
    double sum = 0.0, weighted = 0.0;
    for (std::size_t column = 0; column < kSide; ++column) {
      sum += static_cast<double>(pond.woken(20, column));
      weighted += static_cast<double>(column) * static_cast<double>(pond.woken(20, column));
    }
    return weighted / sum;
  };
  const double before = middle_column();
  for (int i = 1; i <= 120; ++i) pond.advance_to(i / 60.0, to_the_east_m_s);
  // 6 % of 10 m/s for 2 s.
  EXPECT_NEAR((middle_column() - before) * static_cast<double>(kCell_m), 1.2, 0.1);
  EXPECT_NEAR(pond.memory().drifted_m().x, 1.2, 0.01);
}

TEST(WaterMemory, WithoutCellsOrWithForcesOfAnotherSizeNothingHappens) {
  WaterMemory none;
  none.advance_to(1.0, {});
  EXPECT_TRUE(none.cells().empty());
  WaterMemory few(2, 2, {1.0F, 0.0F}, {0.0F, 1.0F});
  const std::vector<float> wrong(3, 1.0F);
  few.advance_to(1.0, {.wind_m_s = {}, .gusts = wrong, .breaking = wrong});
  EXPECT_EQ(few.cells()[0], 0.0F);
}

}  // namespace
}  // namespace yuragi::viewer::looks
