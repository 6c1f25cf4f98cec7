#include "engine/wind/judging/calibration.hpp"

#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace yuragi::wind::judging {
namespace {

Reading raw_reading(double speed_m_s, std::optional<double> direction_deg = {}) {
  Reading reading;
  reading.speed_m_s = speed_m_s;
  reading.direction_deg = direction_deg;
  return reading;
}

TEST(Calibration, ByItselfChangesNothing) {
  const Calibration calibration;
  for (const double speed_m_s : {0.0, 0.3, 8.0, 119.0}) {
    EXPECT_EQ(calibration.applied_to(raw_reading(speed_m_s)).speed_m_s, speed_m_s);
  }
  EXPECT_EQ(calibration.applied_to(raw_reading(1.0)).direction_deg, std::nullopt);
  EXPECT_EQ(calibration.applied_to(raw_reading(1.0, 359.5)).direction_deg, 359.5);
}

TEST(Calibration, ScalesAndShiftsButLeavesACalmACalm) {
  const Calibration calibration{.gain = 1.1, .offset_m_s = 0.4};
  EXPECT_NEAR(calibration.applied_to(raw_reading(10.0)).speed_m_s, 11.4, 1e-12);
  EXPECT_EQ(calibration.applied_to(raw_reading(0.0)).speed_m_s, 0.0);
  EXPECT_EQ((Calibration{.offset_m_s = -2.0}.applied_to(raw_reading(1.0)).speed_m_s), 0.0) << "never below 0";
  Reading reading = raw_reading(5.0);
  reading.gust_m_s = 8.0;
  EXPECT_NEAR(calibration.applied_to(reading).gust_m_s.value(), 9.2, 1e-12);
}

TEST(Calibration, TurnsTheDirectionThroughNorth) {
  EXPECT_NEAR((Calibration{.north_offset_deg = 20.0}.applied_to(raw_reading(1.0, 350.0)).direction_deg.value()), 10.0,
              1e-9);
  EXPECT_NEAR((Calibration{.north_offset_deg = -20.0}.applied_to(raw_reading(1.0, 10.0)).direction_deg.value()), 350.0,
              1e-9);
  for (const double offset_deg : {-360.0, -1e-14, 1e-14, 360.0}) {
    const double turned_deg =
        Calibration{.north_offset_deg = offset_deg}.applied_to(raw_reading(1.0, 0.0)).direction_deg.value();
    EXPECT_GE(turned_deg, 0.0);
    EXPECT_LT(turned_deg, 360.0);
  }
}

TEST(Calibration, TakesTheSensorsNumbersForWhatTheyReallyAre) {
  const Calibration km_h{.unit_m_s = 1.0 / 3.6, .gain = 1.1, .offset_m_s = 0.4};
  EXPECT_NEAR(km_h.applied_to(raw_reading(36.0)).speed_m_s, 11.4, 1e-12);
  Reading reading = raw_reading(36.0);
  reading.gust_m_s = 72.0;
  EXPECT_NEAR(km_h.applied_to(reading).gust_m_s.value(), 22.4, 1e-12);
}

TEST(Calibration, KnowsWhereItCrossesZero) {
  EXPECT_EQ(zero_point_m_s({}), 0.0);
  EXPECT_NEAR(zero_point_m_s({.unit_m_s = 0.5, .gain = 2.0, .offset_m_s = -0.6}), 0.3, 1e-12);
  const Calibration bent{.gain = 2.0, .offset_m_s = 0.5, .curve = parse_calibration_curve("1:0.5 5:4.5").value()};
  EXPECT_NEAR(zero_point_m_s(bent), 0.0, 1e-12) << "the curve crosses 0 at 0.5, and so does 2 * 0 + 0.5";
}

TEST(Calibration, FollowsItsCurveAndGoesOnBeyondIt) {
  Calibration calibration;
  calibration.curve = parse_calibration_curve("1:0.5 5:5  10:12").value();
  EXPECT_NEAR(calibration.applied_to(raw_reading(3.0)).speed_m_s, 2.75, 1e-12);
  EXPECT_NEAR(calibration.applied_to(raw_reading(5.0)).speed_m_s, 5.0, 1e-12);
  EXPECT_NEAR(calibration.applied_to(raw_reading(7.5)).speed_m_s, 8.5, 1e-12);
  EXPECT_NEAR(calibration.applied_to(raw_reading(15.0)).speed_m_s, 19.0, 1e-12);
  EXPECT_EQ(calibration.applied_to(raw_reading(0.2)).speed_m_s, 0.0) << "below its first point it ends at 0";
  EXPECT_LE(calibration.applied_to(raw_reading(119.0)).speed_m_s, kMaxPlausibleSpeed_m_s);
}

TEST(CalibrationCurve, IsRefusedWithWhatIsAllowed) {
  EXPECT_TRUE(parse_calibration_curve("").value().empty());
  EXPECT_TRUE(parse_calibration_curve("  ").value().empty());
  for (const auto* text : {"1:1", "1 2", "0:0 1:x", "0:0 nan:1", "0:0 1:inf", "5:5 1:6", "1:5 5:4", "0:0 0:1",
                           "-1:0 1:1", "0:0,1:1", ":", "0:0 1:"}) {
    const auto curve = parse_calibration_curve(text);
    ASSERT_FALSE(curve.has_value()) << text;
    EXPECT_NE(curve.error().message.find("allowed: two or more points"), std::string::npos);
  }
}

TEST(HeightFactor, IsTheLogarithmicProfiles) {
  EXPECT_EQ(height_factor(10.0, 10.0, 0.03), 1.0);
  EXPECT_NEAR(height_factor(10.0, 2.0, 0.03), std::log(2.0 / 0.03) / std::log(10.0 / 0.03), 1e-12);
  EXPECT_NEAR(height_factor(10.0, 2.0, 0.03) * height_factor(2.0, 10.0, 0.03), 1.0, 1e-12);
  EXPECT_TRUE(std::isfinite(height_factor(0.0, 10.0, 0.03)));
  EXPECT_GT(height_factor(10.0, 0.0, 0.03), 0.0);
}

}  // namespace
}  // namespace yuragi::wind::judging
