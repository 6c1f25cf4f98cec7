#include "tests/answer/test_wind.hpp"

#include <gtest/gtest.h>

#include "tests/answer/scene_run.hpp"
#include "tests/answer/spectra.hpp"
#include "tests/answer/wind_record.hpp"

namespace yuragi::answer {
namespace {

WindRecord recorded(std::size_t beaufort_index, double seconds, double direction_deg = 0.0) {
  TestWind wind(
      test_gusts(),
      {.speed_m_s = kMeanSpeed_m_s[beaufort_index], .direction_deg = direction_deg, .seed = wind_seed(beaufort_index)});
  WindRecord record;
  for (int tick = 0; tick < 1800; ++tick) wind.step(kTick_s);
  for (int tick = 0; tick < static_cast<int>(seconds * kRate_hz); ++tick) {
    wind.step(kTick_s);
    record.take(wind.at_origin());
  }
  return record;
}

TEST(TestWind, IsOfItsBeaufortNumberAndGusty) {
  for (std::size_t number = 0; number < kBeauforts; ++number) {
    const WindRecord record = recorded(number, usual_length(number).record_s);
    EXPECT_NEAR(record.mean_speed_m_s(), kMeanSpeed_m_s[number], 0.05 * kMeanSpeed_m_s[number]);
    EXPECT_NEAR(record.intensity(), 0.2, 0.02);
  }
}

TEST(TestWind, HasTheSpectrumOfVonKarman) {
  // In % of the mean, at Beaufort 5: integrals of von Karman's spectrum of 57 m over bands of frequency.
  const Spectrum spectrum = Welch(kRate_hz).of(recorded(2, 300.0).speed_m_s());
  const auto percent = [&](double from_hz, double to_hz) {
    return 100.0 * std::sqrt(spectrum.variance(from_hz, to_hz)) / kMeanSpeed_m_s[2];
  };
  EXPECT_NEAR(percent(0.05, 0.199), 9.0, 3.0);
  EXPECT_NEAR(percent(0.2, 0.499), 5.2, 1.0);
  EXPECT_NEAR(percent(0.5, 0.999), 3.6, 0.5);
  EXPECT_NEAR(percent(1.0, 1.999), 2.4, 0.5);
}

TEST(TestWind, HasNoWavesShorterThanTwoMetres) {
  const Spectrum spectrum = Welch(kRate_hz).of(recorded(0, 600.0).speed_m_s());
  EXPECT_LT(spectrum.deviation_above(1.0), 0.1 * spectrum.deviation_above(0.2));
}

TEST(TestWind, BlowsWhereItIsToldTo) {
  const Horizontal downwind = recorded(1, 60.0, 90.0).downwind();
  EXPECT_LT(downwind.east, -0.98);
}

}  // namespace
}  // namespace yuragi::answer
