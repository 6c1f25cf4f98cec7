#include "simulators/core/wind_phases.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace yuragi::simulators::core {
namespace {

WindPhase steady(double start_s, double speed_m_s, double direction_deg, double ramp_s = 0.0) {
  return {.start_s = start_s,
          .ramp_s = ramp_s,
          .synthetic = {.mean_speed_m_s = speed_m_s, .mean_direction_deg = direction_deg, .turbulence_intensity = 0.0},
          .recording = ""};
}

TEST(WindPhases, WithoutARampBeginAtTheirMoment) {
  const auto wind = play_phases({steady(0.0, 2.0, 90.0), steady(10.0, 8.0, 180.0)});
  EXPECT_NEAR(wind->at(9.999).speed_m_s, 2.0, 1e-9);
  EXPECT_NEAR(wind->at(9.999).direction_deg, 90.0, 1e-9);
  EXPECT_NEAR(wind->at(10.0).speed_m_s, 8.0, 1e-9);
  EXPECT_NEAR(wind->at(1e6).direction_deg, 180.0, 1e-9);
}

TEST(WindPhases, GoAlongARampBySmoothShares) {
  const auto wind = play_phases({steady(0.0, 2.0, 90.0), steady(10.0, 10.0, 90.0, 4.0)});
  EXPECT_NEAR(wind->at(10.0).speed_m_s, 2.0, 1e-9);
  EXPECT_NEAR(wind->at(11.0).speed_m_s, 2.0 + 8.0 * (3.0 / 16.0 - 2.0 / 64.0), 1e-9);
  EXPECT_NEAR(wind->at(12.0).speed_m_s, 6.0, 1e-9);
  EXPECT_NEAR(wind->at(14.0).speed_m_s, 10.0, 1e-9);
}

TEST(WindPhases, TurnTheWindAsAVector) {
  const auto wind = play_phases({steady(0.0, 4.0, 350.0), steady(10.0, 4.0, 80.0, 2.0)});
  const PlayedMoment halfway = wind->at(11.0);
  EXPECT_NEAR(halfway.direction_deg, 35.0, 1e-9);
  EXPECT_NEAR(halfway.speed_m_s, 4.0 * std::cos(std::acos(-1.0) / 4.0), 1e-9);
}

TEST(WindPhases, ThatAreMissedBetweenTwoCallsArePassed) {
  const auto wind = play_phases({steady(0.0, 1.0, 0.0), steady(1.0, 2.0, 0.0), steady(2.0, 3.0, 0.0)});
  EXPECT_NEAR(wind->at(0.5).speed_m_s, 1.0, 1e-9);
  EXPECT_NEAR(wind->at(5.0).speed_m_s, 3.0, 1e-9);
}

TEST(WindPhases, BeginTheirOwnWindAtItsBeginning) {
  const wind::turbulence::SyntheticWindSettings gusty{.mean_speed_m_s = 6.0, .seed = 9};
  const auto wind = play_phases({steady(0.0, 1.0, 0.0), {.start_s = 100.0, .synthetic = gusty, .recording = ""}});
  const auto alone = play_synthetic_wind(gusty);
  for (const double time_s : {0.0, 0.7, 12.0}) {
    EXPECT_NEAR(wind->at(100.0 + time_s).speed_m_s, alone->at(time_s).speed_m_s, 1e-9);  // 100.7 - 100 is not quite 0.7
  }
}

}  // namespace
}  // namespace yuragi::simulators::core
