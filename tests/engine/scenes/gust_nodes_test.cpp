#include "engine/scenes/gust_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/gusty_wind.hpp"

namespace yuragi::scenes {
namespace {

/// 60 m by 7 m, the nodes half a metre apart.
constexpr GroundNodes kFieldNodes{
    .west_m = -30.0, .north_m = 4.0, .cell_x_m = 0.5, .cell_z_m = 0.5, .columns = 121, .lines = 15};

/// Gusts of all lengths that the nodes hold wholly.
wind::turbulence::GustNoise::Moment gusts_at_nodes(float gustiness = 0.0F) {
  GustyWind gusty({6.0, 3.0}, 0.5F);
  wind::turbulence::GustNoise::Moment gusts = gusty.step(100.0).gusts;
  for (std::size_t i = 0; i < 2 * wind::turbulence::GustNoise::kTileOctaves; ++i) {
    const bool is_held = i % wind::turbulence::GustNoise::kTileOctaves <
                         wind::turbulence::GustNoise::kTileOctaves - wind::turbulence::GustNoise::kShortOctaves;
    if (!is_held) gusts.along_m_s[wind::turbulence::GustNoise::kFirstTileOctave + i] = 0.0F;
    if (!is_held) gusts.across_m_s[wind::turbulence::GustNoise::kFirstTileOctave + i] = 0.0F;
  }
  gusts.gustiness = gustiness;
  return gusts;
}

TEST(GustNodes, HasTheGustsOfEachNode) {
  GustNodes nodes(shared_gusts(), kFieldNodes, best_simd_row());
  ASSERT_EQ(nodes.x_m().size(), kFieldNodes.size());
  for (const float gustiness : {0.0F, 0.3F}) {
    wind::turbulence::GustNoise::Moment gusts = gusts_at_nodes(gustiness);
    gusts.ahead = {0.0, 1.0};  // so that local() is not turned: v along, -u across
    nodes.read(gusts, {}, nodes.all_lines());
    double squares = 0.0;
    double scatter = 0.0;
    for (std::size_t i = 0; i < kFieldNodes.size(); ++i) {
      const wind::Vector there = shared_gusts()->local(gusts, nodes.x_m()[i], nodes.z_m()[i]);
      squares += std::pow(static_cast<double>(nodes.along_m_s()[i]) - there.v_m_s, 2) +
                 std::pow(static_cast<double>(nodes.across_m_s()[i]) + there.u_m_s, 2);
      scatter += there.u_m_s * there.u_m_s + there.v_m_s * there.v_m_s;
    }
    // What changes slowly is read at coarse nodes 15 m apart.
    EXPECT_LT(squares, 0.002 * scatter);
    EXPECT_GT(squares, 0.0);
  }
}

TEST(GustNodes, WithoutSlowGustsItIsExact) {
  GustNodes nodes(shared_gusts(), kFieldNodes, best_simd_row());
  wind::turbulence::GustNoise::Moment gusts = gusts_at_nodes();
  gusts.ahead = {0.0, 1.0};
  for (std::size_t i = 0; i < 2 * wind::turbulence::GustNoise::kTileOctaves; ++i) {
    if (GustNodes::is_coarse(i)) gusts.along_m_s[wind::turbulence::GustNoise::kFirstTileOctave + i] = 0.0F;
  }
  nodes.read(gusts, {}, nodes.all_lines());
  for (std::size_t i = 0; i < kFieldNodes.size(); ++i) {
    EXPECT_EQ(static_cast<double>(nodes.along_m_s()[i]),
              shared_gusts()->local(gusts, nodes.x_m()[i], nodes.z_m()[i]).v_m_s);
  }
}

TEST(GustNodes, WeightsWeakenAnOctavePlaceByPlace) {
  GustNodes weighted(shared_gusts(), kFieldNodes, best_simd_row());
  GustNodes plain(shared_gusts(), kFieldNodes, best_simd_row());
  for (const std::size_t octave : {std::size_t{1}, std::size_t{7}, wind::turbulence::GustNoise::kTileOctaves + 5}) {
    // None of it in the west, all of it in the east, 16 m about the middle aside; across, nothing changes.
    const std::span<const double> x_m = GustNodes::is_coarse(octave) ? weighted.coarse_x_m() : weighted.x_m();
    std::vector<float> weights;
    for (const double x : x_m) weights.push_back(x < 0.0 ? 0.0F : 1.0F);
    GustWeights weakened;
    weakened.along[octave] = weights;
    wind::turbulence::GustNoise::Moment gusts = gusts_at_nodes();
    weighted.read(gusts, weakened, weighted.all_lines());
    plain.read(gusts, {}, plain.all_lines());
    const std::vector<float> with(plain.along_m_s().begin(), plain.along_m_s().end());
    const std::vector<float> across(plain.across_m_s().begin(), plain.across_m_s().end());
    gusts.along_m_s[wind::turbulence::GustNoise::kFirstTileOctave + octave] = 0.0F;
    plain.read(gusts, {}, plain.all_lines());
    for (std::size_t i = 0; i < kFieldNodes.size(); ++i) {
      EXPECT_EQ(weighted.across_m_s()[i], across[i]);
      if (std::abs(weighted.x_m()[i]) < 16.0) continue;
      EXPECT_NEAR(weighted.along_m_s()[i], weighted.x_m()[i] < 0.0 ? plain.along_m_s()[i] : with[i], 1e-5F);
    }
    EXPECT_NE(with.front(), plain.along_m_s().front());
  }
}

TEST(GustNodes, LinesThatAreReadOneByOneHaveTheSameBits) {
  GustNodes at_once(shared_gusts(), kFieldNodes, best_simd_row());
  GustNodes one_by_one(shared_gusts(), kFieldNodes, best_simd_row());
  const wind::turbulence::GustNoise::Moment gusts = gusts_at_nodes(0.3F);
  at_once.read(gusts, {}, at_once.all_lines());
  for (std::size_t line = kFieldNodes.lines; line-- > 0;) one_by_one.read(gusts, {}, {line, 1});
  for (std::size_t i = 0; i < kFieldNodes.size(); ++i) {
    ASSERT_EQ(one_by_one.along_m_s()[i], at_once.along_m_s()[i]) << i;
    ASSERT_EQ(one_by_one.across_m_s()[i], at_once.across_m_s()[i]) << i;
  }
}

TEST(GustNodes, WavesThatTheNodesCannotHoldAreNotRead) {
  wind::turbulence::GustNoise::Moment gusts = gusts_at_nodes();
  gusts.along_m_s.fill(0.0F);
  gusts.across_m_s.fill(0.0F);
  gusts.along_m_s.back() = 1.0F;  // waves of 0.8 to 0.4 m
  GustNodes half_a_metre(shared_gusts(), kFieldNodes, best_simd_row());
  half_a_metre.read(gusts, {}, half_a_metre.all_lines());
  for (const float along_m_s : half_a_metre.along_m_s()) EXPECT_EQ(along_m_s, 0.0F);

  GroundNodes near_nodes = kFieldNodes;
  near_nodes.cell_x_m = near_nodes.cell_z_m = 0.1;
  GustNodes near_gusts(shared_gusts(), near_nodes, best_simd_row());
  near_gusts.read(gusts, {}, near_gusts.all_lines());
  float largest_m_s = 0.0F;
  for (const float along_m_s : near_gusts.along_m_s()) largest_m_s = std::max(largest_m_s, std::abs(along_m_s));
  EXPECT_GT(largest_m_s, 1.0F);
}

}  // namespace
}  // namespace yuragi::scenes
