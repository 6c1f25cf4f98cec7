#include "engine/scenes/tape_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "engine/scenes/wind_grid.hpp"
#include "tests/support/bits.hpp"
#include "tests/support/each_simd_row.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/measured_wind.hpp"

namespace yuragi::scenes {
namespace {

constexpr double kTapeTick_s = MeasuredWind::kTick_s;

/// 60 m by 7 m, the nodes half a metre apart: a part of them upwind of the sensors.
constexpr GroundNodes kTapeField{
    .west_m = -20.0, .north_m = -3.0, .cell_x_m = 0.5, .cell_z_m = 0.5, .columns = 121, .lines = 15};

std::vector<wind::blend::SourceSettings> sensors_at(std::size_t count) {
  std::vector<wind::blend::SourceSettings> sensors(count);
  for (std::size_t i = 0; i < count; ++i) {
    sensors[i].priority = 1;
    sensors[i].has_place = true;
    sensors[i].east_m = -5.0 + 20.0 * static_cast<double>(i);
    sensors[i].south_m = 1.0;
  }
  return sensors;
}

/// Ten seconds of a wind that turns, on the tapes.
wind::ground::DrivingWind fill(wind::ground::WindTapes& tapes, std::size_t sensors) {
  MeasuredWind measured(shared_gusts(), {6.0, 2.0}, sensors_at(sensors));
  wind::ground::DrivingWind wind;
  for (int tick = 0; tick < 600; ++tick) {
    wind = measured.step();
    tapes.write(wind.stroke);
  }
  wind.ground.tapes = &tapes;
  return wind;
}

TEST(TapeNodes, HasTheMeasuredWindAndWhatIsLeftOfTheNoiseAtEachNode) {
  for (const std::size_t sensors : {1U, 2U}) {
    wind::ground::WindTapes tapes(sensors);
    const wind::ground::Wind wind = fill(tapes, sensors).ground;
    const GustNodes nodes(shared_gusts(), kTapeField, best_simd_row());
    TapeNodes at_nodes(nodes);
    at_nodes.read(wind, nodes, nodes.all_lines(), {});
    float least = 1.0F;
    float most = 0.0F;
    const auto expect_weights = [&](const wind::ground::WindTapes::Reading& there, bool is_coarse, std::size_t node) {
      for (std::size_t i = 0; i < wind::ground::kTileOctaveCount; ++i) {
        if (GustNodes::is_coarse(i) != is_coarse || !nodes.is_held(i)) continue;
        ASSERT_EQ(at_nodes.weights().along[i][node], there.noise_along[i]) << node << ", octave " << i;
        ASSERT_EQ(at_nodes.weights().across[i][node], there.noise_across[i]) << node << ", octave " << i;
        least = std::min(least, there.noise_along[i]);
        most = std::max(most, there.noise_along[i]);
      }
    };
    double scatter_m_s = 0.0;
    for (std::size_t i = 0; i < nodes.x_m().size(); ++i) {
      const wind::ground::WindTapes::Reading there = tapes.at(nodes.x_m()[i], nodes.z_m()[i]);
      const wind::Vector measured = wind.measured_at(nodes.x_m()[i], nodes.z_m()[i]);
      ASSERT_EQ(at_nodes.known(i).u_m_s, measured.u_m_s) << i;
      ASSERT_EQ(at_nodes.known(i).v_m_s, measured.v_m_s) << i;
      ASSERT_EQ(at_nodes.gain(i), there.gain);
      scatter_m_s = std::max(scatter_m_s, speed_of(measured - at_nodes.known(0)));
      expect_weights(there, false, i);
    }
    for (std::size_t i = 0; i < nodes.coarse_x_m().size(); ++i) {
      expect_weights(tapes.at(nodes.coarse_x_m()[i], nodes.coarse_z_m()[i]), true, i);
    }
    // Much is known near the sensors, little far from them, and gusts are on their way.
    EXPECT_LT(least, 0.5F) << sensors;
    EXPECT_GT(most, 0.9F) << sensors;
    EXPECT_GT(scatter_m_s, 0.5) << sensors;
  }
}

TEST(TapeNodes, OctavesThatTheNodesCannotHoldAreNotReadFromTheTape) {
  const GustNodes nodes(shared_gusts(), kTapeField, best_simd_row());
  const TapeNodes at_nodes(nodes);
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < wind::ground::kTileOctaveCount; ++i) {
    EXPECT_EQ(at_nodes.weights().along[i].empty(), !nodes.is_held(i)) << i;
    if (!nodes.is_held(i)) ++left_out;
  }
  EXPECT_GT(left_out, 0U);
}

class TapeRows : public EachSimdRow {};
YURAGI_ON_EACH_ROW(TapeRows);

TEST_P(TapeRows, HaveTheBitsOfTheBaseRow) {
  std::array<std::vector<float>, 2> east_m_s;
  std::array<std::vector<float>, 2> south_m_s;
  const std::vector<float> x_m = {-3.0F, -1.0F, 0.3F, 2.0F, 4.0F};
  const std::vector<float> z_m = {2.0F, 0.0F, 1.1F, -3.0F, 3.5F};
  for (std::size_t run = 0; run < 2; ++run) {
    const SimdRow row = run == 0 ? kBaseSimdRow : GetParam();
    wind::ground::WindTapes tapes(1, row);
    MeasuredWind measured(shared_gusts(), {6.0, 2.0}, sensors_at(1));
    WindGrid grid(shared_gusts(), x_m, z_m, row);
    for (int tick = 0; tick < 300; ++tick) grid.step(written_to(tapes, measured.step()), kTapeTick_s);
    east_m_s[run].resize(x_m.size());
    south_m_s[run].resize(x_m.size());
    grid.sample(0, east_m_s[run], south_m_s[run]);
    const wind::ground::WindTapes::Reading reading = tapes.at(1.3, 0.7);
    east_m_s[run].push_back(static_cast<float>(reading.gusts.u_m_s));
    south_m_s[run].push_back(static_cast<float>(reading.gusts.v_m_s));
    east_m_s[run].insert(east_m_s[run].end(), reading.noise_along.begin(), reading.noise_along.end());
    south_m_s[run].insert(south_m_s[run].end(), reading.noise_across.begin(), reading.noise_across.end());
  }
  EXPECT_EQ(bits_of(east_m_s[0]), bits_of(east_m_s[1]));
  EXPECT_EQ(bits_of(south_m_s[0]), bits_of(south_m_s[1]));
  EXPECT_NE(east_m_s[0][5], 0.0F);
}

}  // namespace
}  // namespace yuragi::scenes
