#include "engine/wind/turbulence/wind_turbulence.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"

namespace yuragi::wind::turbulence {
namespace {

constexpr double kMean_m_s = 6.0;

/// What WindTurbulence computes, each mean summed anew; the wind blows to the east.
class PlainDifferences {
 public:
  void break_off() { readings_.clear(); }
  void take(Vector wind) {
    readings_.push_back(wind);
    for (std::size_t scale = 0; scale < Fit::kScales; ++scale) {
      const std::size_t count = std::size_t{1} << scale;
      if (readings_.size() < 2 * count) return;
      Vector difference;
      for (std::size_t back = 1; back <= count; ++back) {
        difference = difference + readings_[readings_.size() - back] - readings_[readings_.size() - count - back];
      }
      const double part = 1.0 / (static_cast<double>(count) * kMean_m_s);
      along.add(scale, std::clamp(part * difference.u_m_s, -1.0, 1.0), kMean_m_s);
      across.add(scale, std::clamp(part * difference.v_m_s, -1.0, 1.0), kMean_m_s);
    }
  }

  Fit along{{}, 600.0}, across{{}, 600.0};

 private:
  std::vector<Vector> readings_;
};

TEST(WindTurbulence, HasTheDifferencesOfPlainSumsHoweverLongItRuns) {
  const math::RandomStream random(5, math::stream_id("readings"));
  WindTurbulence turbulence({}, 600.0);
  PlainDifferences plain;
  Vector wind{kMean_m_s, 0.0};
  constexpr std::uint64_t kReadings = 30'000;  // 15 turns of the ring
  for (std::uint64_t i = 0; i < kReadings; ++i) {
    // A slow walk with quick steps; for a while a storm, then almost calm, in which errors of the storm's would show.
    const auto [u, v] = random.normal_pair(i);
    const double height_m_s = i % 5000 < 1000 ? 8.0 : 0.01;
    wind = Vector{kMean_m_s, 0.0} + 0.99 * (wind - Vector{kMean_m_s, 0.0}) + 0.1 * height_m_s * Vector{u, v};
    if (i % 7777 == 7776) {
      turbulence.break_off();
      plain.break_off();
    }
    turbulence.take(wind, {1.0, 0.0}, kMean_m_s, true);
    plain.take(wind);
    if (i % 1000 == 999) {  // so that what was is soon forgotten
      turbulence.forget(600.0);
      plain.along.forget(600.0);
      plain.across.forget(600.0);
    }
    if (i % 100 != 99) continue;
    for (std::size_t scale = 0; scale < Fit::kScales; ++scale) {
      const double along = plain.along.measured(scale);
      ASSERT_NEAR(turbulence.along().measured(scale), along, 1e-9 * along) << "reading " << i << ", scale " << scale;
      const double across = plain.across.measured(scale);
      ASSERT_NEAR(turbulence.across().measured(scale), across, 1e-9 * across) << "reading " << i << ", scale " << scale;
    }
  }
  EXPECT_GT(turbulence.along().measured(Fit::kScales - 1), 0.0);
}

TEST(WindTurbulence, AConstantWindHasNoneAfterAnyNumberOfReadings) {
  WindTurbulence turbulence({}, 600.0);
  for (int i = 0; i < 10'000; ++i) turbulence.take({7.1, -0.3}, {1.0, 0.0}, 7.1, true);
  for (std::size_t scale = 0; scale < Fit::kScales; ++scale) {
    EXPECT_EQ(turbulence.along().measured(scale), 0.0);
    EXPECT_EQ(turbulence.across().measured(scale), 0.0);
  }
}

TEST(WindTurbulence, WithoutADirectionNothingIsKnownAcrossTheWind) {
  WindTurbulence turbulence({}, 600.0);
  turbulence.take({5.0, 0.0}, {1.0, 0.0}, 5.0, false);
  turbulence.take({7.0, 3.0}, {1.0, 0.0}, 5.0, false);
  EXPECT_DOUBLE_EQ(turbulence.along().measured(0), 0.16);
  EXPECT_EQ(turbulence.across().measured(0), 0.0);
}

}  // namespace
}  // namespace yuragi::wind::turbulence
