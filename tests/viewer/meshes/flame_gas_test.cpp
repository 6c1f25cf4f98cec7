#include "viewer/meshes/flame_gas.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/units.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "tests/viewer/test_models.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const FlameVolume& burning() {
  static const wire::SceneModel model = test_model("flame", {});
  static const FlameVolume volume = [] {
    const auto& surface = std::get<pose::SurfaceSkeleton>(model.skeleton);
    FlameVolume made(surface);
    auto pose = std::get<pose::SurfacePose>(pose::rest_pose(surface));
    std::ranges::fill(pose.heat, 0.5F);
    made.move_to(surface, pose);
    return made;
  }();
  return volume;
}

std::vector<std::uint8_t> copy(const FlameGas& gas) {
  return {gas.texels().begin(), gas.texels().end()};
}

std::vector<std::uint8_t> at(double time_s, double wind_m_s) {
  FlameGas gas(burning());
  gas.settle_at(time_s, wind_m_s, burning());
  return copy(gas);
}

/// The mean heat of a layer that is so much of the way up, 0 to 255.
double heat_at(const std::vector<std::uint8_t>& texels, double up) {
  constexpr std::size_t cells = FlameGas::kAcross * FlameGas::kAcross;
  const auto layer = static_cast<std::size_t>(up * (FlameGas::kLayers - 1));
  double sum = 0.0;
  for (std::size_t i = 0; i < cells; ++i) sum += texels[2 * (layer * cells + i)];
  return sum / cells;
}

TEST(FlameGas, HasTwoBytesACellAndAnExtentALayer) {
  FlameGas gas(burning());
  gas.settle_at(10.0, 4.0, burning());
  EXPECT_EQ(gas.texels().size(), 2 * FlameGas::kAcross * FlameGas::kAcross * FlameGas::kLayers);
  EXPECT_EQ(gas.extents().size(), FlameGas::kLayers);
  for (const float extent : gas.extents()) {
    EXPECT_GE(extent, 0.0F);
    EXPECT_LE(extent, 1.1F);
  }
}

/// The frequency of the strongest wave from 1 to 5 Hz in the heat of the layers above a part of the way up.
double puffs_hz(double above_up) {
  constexpr double kRate_hz = 15.0;
  constexpr std::size_t kPictures = 150;
  constexpr std::size_t cells = FlameGas::kAcross * FlameGas::kAcross;
  FlameGas gas(burning());
  std::vector<double> heat;
  double mean = 0.0;
  for (std::size_t i = 0; i < kPictures; ++i) {
    gas.advance_to(10.0 + static_cast<double>(i) / kRate_hz, 0.0, burning());
    double sum = 0.0;
    const auto lowest = static_cast<std::size_t>(above_up * (FlameGas::kLayers - 1)) * cells;
    for (std::size_t cell = lowest; cell < FlameGas::kLayers * cells; ++cell) sum += gas.texels()[2 * cell];
    heat.push_back(sum);
    mean += sum / kPictures;
  }
  double best_hz = 0.0;
  double most = 0.0;
  for (int step = 0; step <= 80; ++step) {
    const double hz = 1.0 + 0.05 * step;
    std::complex<double> wave;
    for (std::size_t i = 0; i < kPictures; ++i) {
      wave += (heat[i] - mean) * std::polar(1.0, -2.0 * kPi * hz * static_cast<double>(i) / kRate_hz);
    }
    if (std::norm(wave) <= most) continue;
    most = std::norm(wave);
    best_hz = hz;
  }
  return best_hz;
}

TEST(FlameGas, PuffsAsOftenAsAFireOfItsWidth) {
  // B. Cetegen and T. Ahmed 1993: 1.5 / sqrt(width in metres) Hz.
  const double wanted_hz = 1.5 / std::sqrt(2.0 * static_cast<double>(burning().thickest_m()));
  EXPECT_NEAR(puffs_hz(0.4), wanted_hz, 0.1 * wanted_hz);
}

TEST(FlameGas, BeginsSettled) {
  const std::vector<std::uint8_t> first = at(10.0, 0.0);
  EXPECT_GT(heat_at(first, 0.1), 20.0);
  EXPECT_GT(heat_at(first, 0.4), 5.0);
  EXPECT_LT(heat_at(first, 1.0), 0.2 * heat_at(first, 0.1)) << "it burns out";
}

TEST(FlameGas, TheSameTimesGiveTheSameBits) {
  FlameGas one(burning());
  FlameGas other(burning());
  for (int i = 0; i < 30; ++i) {
    one.advance_to(10.0 + i / 25.0, 4.0, burning());
    other.advance_to(10.0 + i / 25.0, 4.0, burning());
  }
  EXPECT_EQ(copy(one), copy(other));
  EXPECT_EQ(one.risen(), other.risen());
}

TEST(FlameGas, ItsStepsDoNotDependOnThePictures) {
  FlameGas often(burning());
  FlameGas seldom(burning());
  often.settle_at(10.0, 4.0, burning());
  seldom.settle_at(10.0, 4.0, burning());
  for (int i = 1; i <= 60; ++i) often.advance_to(10.0 + i / 120.0, 4.0, burning());
  seldom.advance_to(10.5, 4.0, burning());
  EXPECT_EQ(copy(often), copy(seldom));
}

TEST(FlameGas, ChangesWithinATenthOfASecond) {
  FlameGas gas(burning());
  gas.settle_at(10.0, 4.0, burning());
  const std::vector<std::uint8_t> before = copy(gas);
  gas.advance_to(10.0, 4.0, burning());
  EXPECT_EQ(copy(gas), before) << "no time has passed";
  gas.advance_to(10.1, 4.0, burning());
  EXPECT_NE(copy(gas), before);
}

TEST(FlameGas, SettlesAnewAfterAStepBackAndAJump) {
  FlameGas gas(burning());
  gas.settle_at(10.0, 4.0, burning());
  gas.advance_to(10.2, 4.0, burning());
  gas.advance_to(9.0, 4.0, burning());
  EXPECT_EQ(copy(gas), at(9.0, 4.0));
  gas.advance_to(9.0 + FlameGas::kJump_s + 0.1, 4.0, burning());
  EXPECT_EQ(copy(gas), at(9.0 + FlameGas::kJump_s + 0.1, 4.0));
}

TEST(FlameGas, ItsSootEndsBeforeTheGridDoes) {
  constexpr std::size_t n = FlameGas::kAcross;
  for (const double wind_m_s : {0.0, 4.0, 16.0}) {
    const std::vector<std::uint8_t> texels = at(20.0, wind_m_s);
    for (std::size_t layer = 0; layer < FlameGas::kLayers; ++layer) {
      for (std::size_t i = 0; i < n; ++i) {
        for (const std::size_t cell : {i, (n - 1) * n + i, i * n, i * n + n - 1}) {
          EXPECT_EQ(texels[2 * (layer * n * n + cell) + 1], 0) << wind_m_s;
        }
      }
    }
    for (std::size_t cell = (FlameGas::kLayers - 1) * n * n; cell < FlameGas::kLayers * n * n; ++cell) {
      EXPECT_EQ(texels[2 * cell + 1], 0) << wind_m_s;
    }
  }
}

TEST(FlameGas, TakesAWindThatIsNoNumberAsNone) {
  const std::vector<std::uint8_t> calm = at(10.0, 0.0);
  for (const double wind_m_s : {kNan, kInfinite, -kInfinite, -5.0}) EXPECT_EQ(at(10.0, wind_m_s), calm) << wind_m_s;
}

TEST(FlameGas, TakesAHugeWindAsTheStrongest) {
  EXPECT_EQ(at(10.0, 1e300), at(10.0, FlameGas::kMaxWind_m_s));
}

TEST(FlameGas, StaysAsItIsAtATimeThatIsNoNumber) {
  FlameGas gas(burning());
  gas.settle_at(10.0, 4.0, burning());
  const std::vector<std::uint8_t> before = copy(gas);
  for (const double time_s : {kNan, kInfinite, -kInfinite, 1e300, -1e300}) {
    gas.advance_to(time_s, 4.0, burning());
    gas.settle_at(time_s, 4.0, burning());
    EXPECT_EQ(copy(gas), before) << time_s;
  }
}

}  // namespace
}  // namespace yuragi::viewer::meshes
