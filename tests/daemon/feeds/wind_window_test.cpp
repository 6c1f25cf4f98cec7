#include "daemon/feeds/wind_window.hpp"

#include <gtest/gtest.h>

namespace yuragi::daemon::feeds {
namespace {

using values::Quantity;

values::Readout wind_of(double speed_m_s) {
  values::Readout wind;
  wind[Quantity::kSpeed] = speed_m_s;
  wind[Quantity::kU] = speed_m_s;
  wind[Quantity::kNorm] = speed_m_s / 10.0;
  return wind;
}

/// 10 s of 4 m/s, with a gust of 10 m/s for a time in the middle and a lull of 1 m/s for half a second before.
WindWindow::Summary summary_of(double gust_s, double rate_hz) {
  WindWindow window;
  for (int i = 0; i <= 10.0 * rate_hz; ++i) {
    const double time_s = i / rate_hz;
    const bool is_gust = time_s > 5.0 && time_s <= 5.0 + gust_s;
    window.add(wind_of(is_gust ? 10.0 : (time_s > 2.0 && time_s <= 2.5 ? 1.0 : 4.0)), time_s);
  }
  return window.take();
}

TEST(WindWindowTest, HasMeanStrongest3SecondsAndMinimum) {
  const WindWindow::Summary wind = summary_of(4.0, 60.0);
  EXPECT_NEAR(wind.mean_m_s, (0.5 * 1.0 + 4.0 * 10.0 + 5.5 * 4.0) / 10.0, 0.02);
  EXPECT_NEAR(wind.strongest_3_s_m_s, 10.0, 1e-9);
  EXPECT_EQ(wind.min_m_s, 1.0);
  EXPECT_NEAR(wind.u_m_s, wind.mean_m_s, 1e-9);
  EXPECT_NEAR(wind.norm, wind.mean_m_s / 10.0, 1e-9);
}

TEST(WindWindowTest, AShortGustIsAveragedOver3Seconds) {
  EXPECT_NEAR(summary_of(1.5, 60.0).strongest_3_s_m_s, 7.0, 0.6);
}

TEST(WindWindowTest, IsTheSameAtAnyRate) {
  const WindWindow::Summary slow = summary_of(4.0, 10.0), fast = summary_of(4.0, 240.0);
  EXPECT_NEAR(slow.mean_m_s, fast.mean_m_s, 0.05);
  EXPECT_NEAR(slow.strongest_3_s_m_s, fast.strongest_3_s_m_s, 0.05);
}

TEST(WindWindowTest, BeginsAnewAndKnowsTheLastWind) {
  WindWindow window;
  EXPECT_EQ(window.take().mean_m_s, 0.0);
  window.add(wind_of(9.0), 0.0);
  window.add(wind_of(9.0), 0.5);
  window.take();
  EXPECT_EQ(window.take().mean_m_s, 9.0) << "nothing has been added";
  window.add(wind_of(2.0), 60.0);
  window.add(wind_of(2.0), 61.0);
  EXPECT_NEAR(window.take().mean_m_s, 2.0, 1e-9);
}

}  // namespace
}  // namespace yuragi::daemon::feeds
