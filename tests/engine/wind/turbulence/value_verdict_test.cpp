#include "engine/wind/turbulence/value_verdict.hpp"

#include <cstdint>
#include <initializer_list>

#include <gtest/gtest.h>

#include "engine/wind/turbulence/synthetic_wind.hpp"
#include "engine/wind/turbulence/wind_turbulence.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kMean_m_s = 5.0;

/// A station of unknown value in a synthetic wind, from the west.
class Station {
 public:
  explicit Station(std::uint64_t seed)
      : wind_({.mean_speed_m_s = kMean_m_s, .mean_direction_deg = 270.0, .turbulence_intensity = 0.2, .seed = seed}),
        turbulence_({}, 600.0, ReadingValue::kUnknown) {}

  void report_for(double duration_s, ReadingValue value, int steps_to_reading) {
    const double interval_s = kStep_s * steps_to_reading;
    const int readings = static_cast<int>(duration_s / interval_s);
    for (int i = 0; i < readings; ++i) {
      Vector sum;
      for (int step = 0; step < steps_to_reading; ++step) sum = sum + wind_.at(kStep_s * ++step_);
      const Vector instant = wind_.at(kStep_s * step_);
      const Vector mean = 1.0 / steps_to_reading * sum;
      turbulence_.forget(interval_s);
      turbulence_.take(value == ReadingValue::kMean ? mean : instant, {1.0, 0.0}, kMean_m_s, true);
      turbulence_.fit(interval_s, kMean_m_s);
    }
  }

  ReadingValue verdict() const { return turbulence_.verdict(); }

 private:
  SyntheticWind wind_;
  WindTurbulence turbulence_;
  int step_ = 0;
};

TEST(ValueVerdict, TellsMeansFromInstantaneousWindAfterHalfAnHour) {
  for (const ReadingValue value : {ReadingValue::kMean, ReadingValue::kInstant}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      Station station(seed);
      station.report_for(1700.0, value, 10);
      EXPECT_EQ(station.verdict(), ReadingValue::kUnknown);
      station.report_for(6000.0, value, 10);
      EXPECT_EQ(station.verdict(), value) << seed;
    }
  }
}

TEST(ValueVerdict, IsSilentWhereReadingsAreTooFarApart) {
  for (const ReadingValue value : {ReadingValue::kMean, ReadingValue::kInstant}) {
    Station station(1);
    station.report_for(20'000.0, value, 140);
    EXPECT_EQ(station.verdict(), ReadingValue::kUnknown);
  }
}

TEST(ValueVerdict, ANewIntervalBeginsAnew) {
  Station station(1);
  station.report_for(7000.0, ReadingValue::kInstant, 10);
  ASSERT_EQ(station.verdict(), ReadingValue::kInstant);
  station.report_for(60.0, ReadingValue::kMean, 20);
  EXPECT_EQ(station.verdict(), ReadingValue::kUnknown);
}

TEST(ValueVerdict, AConstantWindIsNeither) {
  ValueVerdict verdict(57.0);
  for (int second = 0; second < 7200; ++second) {
    verdict.forget(1.0);
    for (std::size_t scale = 0; scale < ValueVerdict::kScales; ++scale) verdict.add(scale, 0.0, 5.0);
    verdict.judge(1.0, 5.0);
  }
  EXPECT_EQ(verdict.verdict(), ReadingValue::kUnknown);
}

}  // namespace
}  // namespace yuragi::wind::turbulence
