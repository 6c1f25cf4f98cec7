#include "viewer/app/wind_trace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace yuragi::viewer::app {
namespace {

TEST(WindTrace, KeepsTheMeansOfTheLastMinute) {
  WindTrace trace;
  for (int frame = 0; frame < 120 * 60; ++frame) trace.hear(frame / 60.0, frame / 60.0, 7.0);
  ASSERT_EQ(trace.speeds_m_s().size(), WindTrace::kSamples);
  EXPECT_NEAR(trace.speeds_m_s().front(), 60.0, 0.2);
  EXPECT_NEAR(trace.speeds_m_s().back(), 120.0, 0.3);
  EXPECT_FLOAT_EQ(trace.measured_m_s().back(), 7.0F);
}

TEST(WindTrace, AGapIsFilledAndATimeThatGoesBackBeginsAnew) {
  WindTrace trace;
  trace.hear(0.0, 3.0, {});
  trace.hear(10.0, 5.0, {});
  ASSERT_EQ(trace.speeds_m_s().size(), 80U);
  EXPECT_FLOAT_EQ(trace.speeds_m_s()[40], 3.0F);
  trace.hear(2.0, 4.0, {});
  EXPECT_TRUE(trace.speeds_m_s().empty());
}

TEST(WindTrace, TheSpectrumOfASineHasItsVarianceAtItsFrequency) {
  std::vector<float> speeds;
  constexpr double kFrequency_hz = 0.5;
  for (std::size_t i = 0; i < WindTrace::kSamples; ++i) {
    const double at_s = static_cast<double>(i) * WindTrace::kInterval_s;
    speeds.push_back(static_cast<float>(5.0 + 2.0 * std::sin(2.0 * std::numbers::pi * kFrequency_hz * at_s)));
  }
  const std::vector<SpectrumBand> bands = spectrum_of(speeds);
  const auto peak = std::ranges::max_element(bands, {}, &SpectrumBand::density_m2_s);
  ASSERT_NE(peak, bands.end());
  EXPECT_NEAR(peak->frequency_hz, kFrequency_hz, 0.15 * kFrequency_hz);
  double variance = 0.0;
  for (const SpectrumBand& band : bands) variance += band.density_m2_s * band.frequency_hz * std::log(1.25);
  EXPECT_NEAR(variance, 2.0, 0.5) << "half of the amplitude's square";
  EXPECT_TRUE(spectrum_of(std::vector<float>(10, 1.0F)).empty());
}

}  // namespace
}  // namespace yuragi::viewer::app
