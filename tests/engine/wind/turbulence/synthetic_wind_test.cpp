#include "engine/wind/turbulence/synthetic_wind.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace yuragi::wind::turbulence {
namespace {

constexpr SyntheticWindSettings kSettings{
    .mean_speed_m_s = 6.0, .mean_direction_deg = 200.0, .turbulence_intensity = 0.2, .seed = 7};

TEST(SyntheticWind, HasTheMeanAndTheTurbulenceThatWereAskedFor) {
  const SyntheticWind wind(kSettings);
  const Vector downwind = wind_from(1.0, kSettings.mean_direction_deg);
  constexpr int kSeconds = 40'000;
  double sum = 0.0;
  double sum_along_squares = 0.0;
  double sum_across_squares = 0.0;
  for (int second = 0; second < kSeconds; ++second) {
    const Vector now = wind.at(second);
    const double along = now.u_m_s * downwind.u_m_s + now.v_m_s * downwind.v_m_s;
    const double across = now.u_m_s * downwind.v_m_s - now.v_m_s * downwind.u_m_s;
    sum += along;
    sum_along_squares += (along - 6.0) * (along - 6.0);
    sum_across_squares += across * across;
  }
  EXPECT_NEAR(sum / kSeconds, 6.0, 0.1);
  EXPECT_NEAR(std::sqrt(sum_along_squares / kSeconds), 1.2, 0.1);
  EXPECT_NEAR(std::sqrt(sum_across_squares / kSeconds), 0.8 * 1.2, 0.1);
}

TEST(SyntheticWind, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const SyntheticWind wind(kSettings);
  const SyntheticWind same(kSettings);
  SyntheticWindSettings other_settings = kSettings;
  other_settings.seed = 8;
  const SyntheticWind other(other_settings);
  EXPECT_EQ(wind.at(123.4).u_m_s, same.at(123.4).u_m_s);
  EXPECT_NE(wind.at(123.4).u_m_s, other.at(123.4).u_m_s);
}

// The spline's slope is at most that of the noise between samples; a jump would show as a step that does not shrink
// with dt.
TEST(SyntheticWind, MovesWithoutJumpsAlsoWhereItsTilesWrap) {
  const SyntheticWind wind(kSettings);
  for (const double wrap_s : {1024.0, 1024.0 * 1.6180339887498949, 0.25, 500.0}) {
    const Vector before = wind.at(wrap_s - 1e-6);
    const Vector after = wind.at(wrap_s + 1e-6);
    EXPECT_LT(speed_of(after - before), 1e-4) << "at " << wrap_s;
  }
}

TEST(SyntheticWind, IsFiniteForAMonthAndForTimesBeforeItsBeginning) {
  const SyntheticWind wind(kSettings);
  for (const double time_s : {-1e6, -0.1, 0.0, 31.0 * 86'400.0, 1e9}) {
    EXPECT_TRUE(std::isfinite(speed_of(wind.at(time_s)))) << time_s;
  }
}

}  // namespace
}  // namespace yuragi::wind::turbulence
