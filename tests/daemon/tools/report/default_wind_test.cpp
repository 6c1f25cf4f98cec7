#include "daemon/tools/report/default_wind.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "daemon/tools/report/gust_means.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "tests/daemon/tools/report/report_samples.hpp"

namespace yuragi::daemon::tools::report {
namespace {

constexpr std::int64_t kInterval_ms = 500;
constexpr double kInterval_s = 1e-3 * static_cast<double>(kInterval_ms);
constexpr double kDuration_s = 5.0 * 3600.0;

DefaultWind wind_of(double speed_m_s, double turbulence_intensity, double length_m) {
  DefaultWind wind;
  wind.speed_m_s = speed_m_s;
  wind.turbulence_intensity = turbulence_intensity;
  wind.length_m = length_m;
  return wind;
}

/// The daemon's own wind of these values of [wind], one reading each kInterval_s; `swing`: the amplitude of a slow
/// change of the wind's speed besides, over the mean.
std::vector<wind::Reading> model_wind(const DefaultWind& values, double swing = 0.0, double swing_period_s = 1.0) {
  static const auto kNoise = std::make_shared<const wind::turbulence::GustNoise>(wind::turbulence::GustNoiseSettings{});
  wind::blend::BlendedEstimator estimator(0,
                                          {.climate = {.mean_speed_m_s = values.speed_m_s,
                                                       .mean_direction_deg = 240.0,
                                                       .turbulence_intensity = values.turbulence_intensity,
                                                       .seed = 5},
                                           .length_m = values.length_m},
                                          kNoise);
  return test::made_readings(
      static_cast<std::size_t>(kDuration_s / kInterval_s), kInterval_ms, [&](std::size_t i, wind::Reading& reading) {
        const double time_s = kInterval_s * static_cast<double>(i);
        const wind::Vector slow = wind::wind_from(
            swing * values.speed_m_s * std::sin(2.0 * std::numbers::pi * time_s / swing_period_s), 240.0);
        const wind::Vector wind = estimator.advance(MonoTime(from_seconds(1.0 + time_s))).wind + slow;
        reading.speed_m_s = speed_of(wind);
        reading.direction_deg = wind::direction_from_deg(wind);
      });
}

/// As measured over 10 minutes.
double block_intensity(const std::vector<wind::Reading>& readings) {
  TenMinuteBlocks blocks(kInterval_s);
  double time_s = 0.0;
  for (const wind::Reading& reading : readings) {
    blocks.add(time_s, reading.speed_m_s, {});
    time_s += kInterval_s;
  }
  return blocks.finish().turbulence_intensity.value_or(0.0);
}

struct Site {
  const char* name = "";
  DefaultWind wind;
  double swing = 0.0, swing_period_s = 1.0;
};

TEST(DefaultWind, TheModelMakesTheIntensityOfItThatWasMeasured) {
  for (const Site& site : {
           Site{.name = "open land", .wind = wind_of(7.0, 0.2, 57.0)},
           Site{.name = "long gusts", .wind = wind_of(4.0, 0.3, 300.0)},
           // Most of its variance is slower than the gusts that its spectrum is fitted to.
           Site{.name = "swings of minutes", .wind = wind_of(4.0, 0.14, 20.0), .swing = 0.3, .swing_period_s = 700.0},
       }) {
    const auto readings = model_wind(site.wind, site.swing, site.swing_period_s);
    const auto measured = test::numbers_of(readings).sensors.at(0);
    ASSERT_TRUE(measured.blocks.turbulence_intensity) << site.name;
    const auto proposed = default_wind(measured);
    ASSERT_TRUE(proposed) << site.name;
    const double made = block_intensity(model_wind(*proposed));
    EXPECT_NEAR(made / *measured.blocks.turbulence_intensity, 1.0, 0.1)
        << site.name << ": measured " << *measured.blocks.turbulence_intensity << ", fitted "
        << measured.spectrum->von_karman->intensity << ", proposed " << proposed->turbulence_intensity << " with "
        << proposed->length_m << " m, made " << made;
  }
}

/// A sensor with a fitted spectrum.
SensorNumbers fitted(double speed_m_s, std::optional<double> length_m) {
  SensorNumbers sensor;
  sensor.mean_m_s = speed_m_s;
  sensor.assumed_length_m = 57.0;
  sensor.spectrum.emplace();
  sensor.spectrum->von_karman = {.speed_m_s = speed_m_s, .intensity = 0.2, .time_scale_s = 8.0, .length_m = length_m};
  return sensor;
}

TEST(DefaultWind, HasALengthEvenIfTheSpectrumDoesNotDetermineIt) {
  const auto assumed = default_wind(fitted(5.0, std::nullopt));
  ASSERT_TRUE(assumed);
  EXPECT_EQ(assumed->length_m, 57.0);
  EXPECT_FALSE(assumed->is_length_measured);
  EXPECT_EQ(assumed->turbulence_intensity, 0.2) << "without a block of 10 minutes that of the spectrum";
  const auto seen = default_wind(fitted(5.0, 30.0));
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->length_m, 30.0);
  EXPECT_TRUE(seen->is_length_measured);
}

TEST(DefaultWind, StaysWithinTheRangesOfTheConfiguration) {
  SensorNumbers sensor = fitted(1.2, 5000.0);
  sensor.blocks = {.blocks = 3, .turbulence_intensity = 0.8, .gust_factor = {}};
  auto wind = default_wind(sensor);
  ASSERT_TRUE(wind);
  EXPECT_LE(wind->turbulence_intensity, 1.0);
  EXPECT_GT(wind->turbulence_intensity, 0.8);
  EXPECT_LT(wind->length_m, 1000.0) << "shorter, since an intensity of more than 1 is not allowed";

  sensor.blocks.turbulence_intensity = 1.5;
  wind = default_wind(sensor);
  ASSERT_TRUE(wind);
  EXPECT_EQ(wind->turbulence_intensity, 1.0);
  EXPECT_FALSE(default_wind(fitted(0.0, 30.0)));
  EXPECT_FALSE(default_wind(SensorNumbers{}));
}

}  // namespace
}  // namespace yuragi::daemon::tools::report
