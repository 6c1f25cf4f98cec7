#include "engine/pose/quantise.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"
#include "engine/pose/strand_kinematics.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/random_strands.hpp"

namespace yuragi::pose {
namespace {

std::int16_t quantised(float angle_rad) {
  std::int16_t unit = 0;
  quantise({&angle_rad, 1}, {&unit, 1});
  return unit;
}

/// As a client does it.
void dequantise(std::span<const std::int16_t> units, std::span<float> angle_rad) {
  std::ranges::transform(units, angle_rad.begin(),
                         [](std::int16_t unit) { return static_cast<float>(unit) * kBendStep_rad; });
}

TEST(QuantiseTest, HasPiAtTheEndOfItsRange) {
  EXPECT_EQ(quantised(0.0F), 0);
  EXPECT_EQ(quantised(std::numbers::pi_v<float>), 32767);
  EXPECT_EQ(quantised(-std::numbers::pi_v<float>), -32767);
  EXPECT_NEAR(kBendStep_rad, std::numbers::pi / 32767.0, 1e-11);
}

TEST(QuantiseTest, SaturatesAndTurnsNanIntoZero) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float far : {3.2F, 100.0F, 1e30F, infinity}) {
    EXPECT_EQ(quantised(far), 32767);
    EXPECT_EQ(quantised(-far), -32767);
  }
  EXPECT_EQ(quantised(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(QuantiseTest, RoundsToTheNearest) {
  for (int unit = -32766; unit <= 32766; ++unit) {
    const float angle_rad = static_cast<float>(unit) * kBendStep_rad;
    EXPECT_EQ(quantised(angle_rad), unit);
    EXPECT_EQ(quantised(angle_rad + 0.49F * kBendStep_rad), unit);
    EXPECT_EQ(quantised(angle_rad - 0.49F * kBendStep_rad), unit);
  }
}

TEST(QuantiseTest, GoesThereAndBackWithinHalfAStep) {
  std::vector<float> angles_rad;
  for (int i = -31415; i <= 31415; i += 3) angles_rad.push_back(1e-4F * static_cast<float>(i));
  std::vector<std::int16_t> units(angles_rad.size());
  std::vector<float> back_rad(angles_rad.size());
  quantise(angles_rad, units);
  dequantise(units, back_rad);
  for (std::size_t i = 0; i < units.size(); ++i) EXPECT_NEAR(back_rad[i], angles_rad[i], 0.51F * kBendStep_rad);
}

TEST(QuantiseTest, MovesTheTipOfA1mBladeByAtMostHalfAMillimetre) {
  const std::size_t strands = 4096;
  for (const std::size_t links : {1U, 10U, 64U}) {
    const StrandSkeleton skeleton = random_strands(strands, links, 1.0 / static_cast<double>(links), links);
    const StrandPose pose = random_bends(skeleton, std::numbers::pi, links);
    StrandPose rounded = pose;
    std::vector<std::int16_t> units(strands);
    quantise(pose.bend_east_rad, units);
    dequantise(units, rounded.bend_east_rad);
    quantise(pose.bend_south_rad, units);
    dequantise(units, rounded.bend_south_rad);

    JointPositions exact(skeleton);
    JointPositions received(skeleton);
    EXPECT_EQ((StrandKinematicsJob{.skeleton = &skeleton, .pose = &pose, .joints = &exact}.run()),
              StrandKinematicsJob::Problem::kNone);
    EXPECT_EQ((StrandKinematicsJob{.skeleton = &skeleton, .pose = &rounded, .joints = &received}.run()),
              StrandKinematicsJob::Problem::kNone);
    float largest_m = 0.0F;
    for (std::size_t i = 0; i < strands; ++i) {
      const JointPosition a = exact.joint(i, links - 1);
      const JointPosition b = received.joint(i, links - 1);
      largest_m = std::max(largest_m, std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m));
    }
    EXPECT_LE(largest_m, 0.0005F);
    EXPECT_GT(largest_m, 0.0F);
  }
}

TEST(QuantiseTest, WaysSaturateRoundAndTurnNanIntoZero) {
  const float step_m = 0.001F;
  const float ways_m[] = {0.0F,
                          0.0014F,
                          0.0016F,
                          -0.0016F,
                          1e9F,
                          -std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()};
  std::int16_t units[7] = {};
  quantise_ways(ways_m, step_m, units);
  EXPECT_EQ(std::vector<int>(std::begin(units), std::end(units)), (std::vector{0, 1, 2, -2, 32767, -32767, 0}));
}

TEST(QuantiseTest, HeatIsTheNumberOfAColour) {
  const float heat[] = {0.0F, 1.0F, 0.5F, -3.0F, 7.0F, std::numeric_limits<float>::quiet_NaN()};
  std::uint8_t units[6] = {};
  quantise_heat(heat, units);
  EXPECT_EQ(std::vector<int>(std::begin(units), std::end(units)), (std::vector{0, 255, 128, 0, 255, 0}));
}

class QuantiseOnEachRow : public EachSimdRow {};
YURAGI_ON_EACH_ROW(QuantiseOnEachRow);

/// One value alone: to the nearest unit, halves to even.
template <class Unit>
Unit quantised_alone(float value, float units_per_one, float smallest, float largest) {
  const float scaled = value * units_per_one;
  if (std::isnan(scaled)) return 0;
  return static_cast<Unit>(std::nearbyint(std::clamp(scaled, smallest, largest)));
}

TEST_P(QuantiseOnEachRow, GivesTheSameUnitsAsOneValueAlone) {
  const float kPerRad = 32767.0F / std::numbers::pi_v<float>;
  const float step_m = 0.0003F;
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::array edges = {0.0F,
                            -0.0F,
                            std::numeric_limits<float>::denorm_min(),
                            std::numeric_limits<float>::min(),
                            std::numeric_limits<float>::max(),
                            std::numeric_limits<float>::lowest(),
                            infinity,
                            -infinity,
                            nan,
                            -nan,
                            0.5F / 255.0F,
                            1.5F / 255.0F,
                            1.0F,
                            std::nextafter(1.0F, 2.0F),
                            0.5F * step_m,
                            1.5F * step_m,
                            -2.5F * step_m,
                            std::numbers::pi_v<float>,
                            -std::numbers::pi_v<float>,
                            std::nextafter(std::numbers::pi_v<float>, 4.0F)};

  // Any bits that a float can have, and those of the usual range; whole registers, and what is left over.
  const math::RandomStream random(5, math::stream_id("values to quantise"));
  std::uint64_t drawn = 0;
  for (const std::size_t count : {0U, 1U, 2U, 7U, 15U, 16U, 31U, 33U, 63U, 65U, 127U, 1001U, 4099U}) {
    std::vector<float> values;
    for (std::size_t i = 0; i < count; ++i) {
      const double uniform = random.uniform(drawn++);
      const auto any_bits = std::bit_cast<float>(static_cast<std::uint32_t>(uniform * 4294967296.0));
      const auto usual = static_cast<float>(8.0 * uniform - 4.0);
      values.push_back(i % 3 == 0 ? edges[(i / 3) % edges.size()] : i % 3 == 1 ? any_bits : usual);
    }
    // One value more than there is room for, which nothing may touch.
    std::vector<std::int16_t> bends(count + 1, 77);
    std::vector<std::int16_t> ways(count + 1, 77);
    std::vector<std::uint8_t> heats(count + 1, 77);
    quantise(values, std::span(bends).first(count), GetParam());
    quantise_ways(values, step_m, std::span(ways).first(count), GetParam());
    quantise_heat(values, std::span(heats).first(count), GetParam());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(bends[i], quantised_alone<std::int16_t>(values[i], kPerRad, -32767.0F, 32767.0F)) << values[i];
      EXPECT_EQ(ways[i], quantised_alone<std::int16_t>(values[i], 1.0F / step_m, -32767.0F, 32767.0F)) << values[i];
      EXPECT_EQ(heats[i], quantised_alone<std::uint8_t>(values[i], 255.0F, 0.0F, 255.0F)) << values[i];
    }
    EXPECT_EQ(bends[count], 77);
    EXPECT_EQ(ways[count], 77);
    EXPECT_EQ(heats[count], 77);
  }
}

TEST(QuantiseTest, AClothOfTwoMetresIsWithinATenthOfAMillimetre) {
  GridSkeleton cloth;
  cloth.columns = 200;
  cloth.rows = 150;
  for (auto* values : {&cloth.rest_x_m, &cloth.rest_y_m, &cloth.rest_z_m}) values->assign(150 * cloth.stride(), 7.0F);
  for (std::size_t i = 0; i < cloth.rest_x_m.size(); ++i) {
    cloth.rest_x_m[i] = 100.0F + 2.0F * static_cast<float>(i % cloth.stride()) / 199.0F;
    const std::size_t row = i / cloth.stride();
    cloth.rest_y_m[i] = 2.0F * static_cast<float>(row) / 149.0F;
  }
  const float step_m = way_step_m(cloth);
  EXPECT_LE(step_m / 2.0F, 0.0001F);
  EXPECT_GE(step_m * 32767.0F, 2.0F * std::sqrt(8.0F) * 0.9999F) << "twice its diagonal fits in, and so every fold";
  EXPECT_GT(way_step_m(GridSkeleton{}), 0.0F);

  SurfaceSkeleton water;
  water.columns = water.rows = 2;
  water.rest_x_m = {-4.0F, 4.0F, -4.0F, 4.0F};
  water.rest_y_m = {0.0F, 0.0F, 0.0F, 0.0F};
  water.rest_z_m = {-4.0F, -4.0F, 4.0F, 4.0F};
  EXPECT_LE(way_step_m(water) / 2.0F, 0.00005F);
  water.is_closed = true;
  EXPECT_GE(way_step_m(water) * 32767.0F, 16.0F) << "a flame may lean by more than its height";

  SurfaceSkeleton point;
  point.columns = point.rows = 1;
  point.rest_x_m = point.rest_y_m = point.rest_z_m = {1.0F};
  EXPECT_GT(way_step_m(point), 0.0F);
}

}  // namespace
}  // namespace yuragi::pose
