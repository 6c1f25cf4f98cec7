#include "drivers/decode/microphone/mic_calibration.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace yuragi::drivers::microphone {
namespace {

std::vector<decode::microphone::MicLevelAndSpeed> pairs_of_law(const decode::microphone::MicPowerLaw& law,
                                                               double noise_power, double scatter_db,
                                                               std::size_t count = 60) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<decode::microphone::MicLevelAndSpeed> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const double speed_m_s = 0.5 + 9.5 * static_cast<double>((7 * i) % count) / static_cast<double>(count);
    const double power = std::pow(speed_m_s / law.gain_m_s, 2.0 * law.exponent) + noise_power;
    pairs.push_back({10.0 * std::log10(power) + scatter_db * normal(random), speed_m_s});
  }
  return pairs;
}

TEST(MicCalibration, APowerLawGivesBackTheSpeedThatMadeThePower) {
  for (const double exponent : {1.3, 2.0, 3.2}) {
    const decode::microphone::MicPowerLaw law{25.0, exponent};
    for (const double speed_m_s : {0.5, 3.0, 12.0}) {
      const double power = std::pow(speed_m_s / law.gain_m_s, 2.0 * exponent);
      EXPECT_NEAR(decode::microphone::mic_speed_m_s(law, power, 0.0), speed_m_s, 1e-9);
      EXPECT_NEAR(decode::microphone::mic_speed_m_s(law, power + 1e-6, 1e-6), speed_m_s, 1e-6);
    }
    EXPECT_EQ(decode::microphone::mic_speed_m_s(law, 1e-7, 1e-6), 0.0) << "below the noise it is calm";
    EXPECT_EQ(decode::microphone::mic_speed_m_s(law, 1e30, 0.0), 120.0) << "no wind is faster";
  }
}

TEST(MicCalibration, ACurveIsStraightBetweenItsPointsAndNeverFalls) {
  const decode::microphone::MicCurve curve = *decode::microphone::parse_mic_curve("-60:0 -50:2, -40:6");
  const auto at_db = [&](double level_db) {
    return decode::microphone::mic_speed_m_s(curve, std::pow(10.0, level_db / 10.0), 0.5);
  };
  EXPECT_NEAR(at_db(-55.0), 1.0, 1e-9);
  EXPECT_NEAR(at_db(-45.0), 4.0, 1e-9);
  EXPECT_NEAR(at_db(-90.0), 0.0, 1e-9);
  EXPECT_NEAR(at_db(-30.0), 10.0, 1e-9) << "it goes on as steeply as it came";
  EXPECT_EQ(decode::microphone::mic_speed_m_s(curve, 0.0, 0.0), 0.0);
  EXPECT_EQ(decode::microphone::format_mic_curve(curve), "-60.00:0.000 -50.00:2.000 -40.00:6.000");
  EXPECT_EQ(*decode::microphone::parse_mic_curve(decode::microphone::format_mic_curve(curve)), curve);
}

TEST(MicCalibration, RefusesCurvesThatAreNone) {
  for (const char* text : {"", "-60:0", "-60:0 -60:1", "-50:1 -60:2", "-60:2 -50:1", "-60:0 -50", "-60:0 x:1",
                           "-60:-1 -50:1", "-60:0 -50:500", "-60:nan -50:1", "-60:0;-50:1"}) {
    EXPECT_FALSE(decode::microphone::parse_mic_curve(text)) << text;
  }
}

TEST(MicCalibration, FindsThePowerLawThatMadeThePairs) {
  for (const double exponent : {1.3, 2.0, 3.2}) {
    const decode::microphone::MicPowerLaw law{18.0, exponent};
    const auto exact = decode::microphone::fit_mic_power_law(pairs_of_law(law, 1e-7, 0.0), 1e-7);
    ASSERT_TRUE(exact);
    EXPECT_NEAR(exact->exponent, exponent, 0.02);
    EXPECT_NEAR(exact->gain_m_s, law.gain_m_s, 0.5);

    const auto fit = decode::microphone::fit_mic_calibration(pairs_of_law(law, 0.0, 1.0));
    ASSERT_TRUE(fit);
    EXPECT_TRUE(std::holds_alternative<decode::microphone::MicPowerLaw>(fit->calibration));
    EXPECT_LT(fit->mean_error_m_s, 0.6);
  }
}

TEST(MicCalibration, TakesACurveWhereNoPowerLawFits) {
  std::vector<decode::microphone::MicLevelAndSpeed> pairs;
  for (int i = 0; i < 40; ++i) {
    const double level_db = -60.0 + static_cast<double>((7 * i) % 40);
    pairs.push_back({level_db, 0.15 * (level_db + 60.0)});
  }
  const auto fit = decode::microphone::fit_mic_calibration(pairs);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(std::holds_alternative<decode::microphone::MicCurve>(fit->calibration));
  EXPECT_LT(fit->mean_error_m_s, 0.02);
  EXPECT_NEAR(decode::microphone::mic_speed_m_s(fit->calibration, 1e-4, 0.0), 3.0, 0.05);
}

TEST(MicCalibration, NeverFallsWhateverThePairs) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> level_db(-70.0, -10.0);
  std::uniform_real_distribution<double> speed_m_s(0.0, 12.0);
  for (int round = 0; round < 50; ++round) {
    std::vector<decode::microphone::MicLevelAndSpeed> pairs(12);
    for (auto& pair : pairs) pair = {level_db(random), speed_m_s(random)};
    const auto curve = decode::microphone::fit_mic_curve(pairs);
    const auto best = decode::microphone::fit_mic_calibration(pairs);
    ASSERT_TRUE(curve);
    ASSERT_TRUE(best);
    for (const decode::microphone::MicCalibration& calibration :
         {decode::microphone::MicCalibration(*curve), best->calibration}) {
      double last_m_s = 0.0;
      for (int step = 0; step < 180; ++step) {
        const double db = -90.0 + 0.5 * step;
        const double now_m_s = decode::microphone::mic_speed_m_s(calibration, std::pow(10.0, db / 10.0), 0.0);
        EXPECT_GE(now_m_s, last_m_s);
        EXPECT_LE(now_m_s, 120.0);
        last_m_s = now_m_s;
      }
    }
  }
}

TEST(MicCalibration, ASpeedGivesBackTheLevelThatMadeIt) {
  const double noise_power = 1e-7;
  const decode::microphone::MicCalibration curve = *decode::microphone::parse_mic_curve("-60:0.5 -55:0.5 -50:2 -40:6");
  for (const decode::microphone::MicCalibration& calibration :
       {decode::microphone::MicCalibration(decode::microphone::MicPowerLaw{25.0, 1.7}), curve}) {
    for (double level_db = -54.0; level_db < -20.0; level_db += 1.5) {
      const double speed_m_s =
          decode::microphone::mic_speed_m_s(calibration, std::pow(10.0, 0.1 * level_db), noise_power);
      const auto back_db = decode::microphone::mic_level_db(calibration, speed_m_s, noise_power);
      ASSERT_TRUE(back_db);
      EXPECT_NEAR(*back_db, level_db, 1e-6);
    }
    EXPECT_FALSE(decode::microphone::mic_level_db(calibration, 0.0, noise_power)) << "many levels are a calm";
  }
  EXPECT_FALSE(decode::microphone::mic_level_db(curve, 0.5, 0.0)) << "so are they where the curve is level";
}

TEST(MicCalibration, TwoKnownWindsMakeAPowerLaw) {
  const decode::microphone::MicPowerLaw made{18.0, 1.6};
  const double noise_power = 1e-6;
  const auto heard = [&](double speed_m_s) {
    return decode::microphone::MicLevelAndSpeed{*decode::microphone::mic_level_db(made, speed_m_s, noise_power),
                                                speed_m_s};
  };
  const auto law = decode::microphone::mic_power_law_through(heard(2.0), heard(9.0), noise_power);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->gain_m_s, made.gain_m_s, 1e-9);
  EXPECT_NEAR(law->exponent, made.exponent, 1e-9);
  EXPECT_FALSE(decode::microphone::mic_power_law_through(heard(9.0), heard(2.0), noise_power))
      << "the slower comes first";
  EXPECT_FALSE(decode::microphone::mic_power_law_through({-70.0, 2.0}, {-20.0, 9.0}, noise_power))
      << "the slower is not heard";
  EXPECT_FALSE(decode::microphone::mic_power_law_through({-50.0, 2.0}, {-46.0, 20.0}, 0.0)) << "it grows too little";
}

TEST(MicCalibration, IsOfTheKindThatIsAskedFor) {
  std::vector<decode::microphone::MicLevelAndSpeed> pairs;
  for (int i = 0; i < 40; ++i) pairs.push_back({-60.0 + i, 0.15 * i});
  EXPECT_TRUE(std::holds_alternative<decode::microphone::MicCurve>(
      decode::microphone::fit_mic_calibration(pairs)->calibration));
  EXPECT_TRUE(std::holds_alternative<decode::microphone::MicPowerLaw>(
      decode::microphone::fit_mic_calibration(pairs, 0.0, decode::microphone::MicFitKind::kPowerLaw)->calibration));
  const auto of_law = pairs_of_law({18.0, 1.6}, 0.0, 0.0);
  EXPECT_TRUE(std::holds_alternative<decode::microphone::MicPowerLaw>(
      decode::microphone::fit_mic_calibration(of_law)->calibration));
  EXPECT_TRUE(std::holds_alternative<decode::microphone::MicCurve>(
      decode::microphone::fit_mic_calibration(of_law, 0.0, decode::microphone::MicFitKind::kCurve)->calibration));
}

TEST(MicCalibration, RefusesToLearnFromTooLittle) {
  const auto all = pairs_of_law({}, 0.0, 0.0);
  EXPECT_FALSE(decode::microphone::fit_mic_calibration(std::span(all).first(7)));
  std::vector<decode::microphone::MicLevelAndSpeed> even(20, {-40.0, 3.0});
  EXPECT_FALSE(decode::microphone::fit_mic_calibration(even)) << "one wind only";
  even = all;
  even[3].level_db = std::nan("");
  EXPECT_FALSE(decode::microphone::fit_mic_calibration(even));
  EXPECT_FALSE(decode::microphone::fit_mic_power_law(all, 1e6)) << "all below the noise";
}

}  // namespace
}  // namespace yuragi::drivers::microphone
