#include "daemon/tools/report/site_tally.hpp"

#include <cmath>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "engine/math/philox.hpp"

namespace yuragi::daemon::tools::report {
namespace {

/// Half an hour of a wind of 5 m/s with gusts that last for some seconds, and a gap.
std::optional<SiteNumbers> learnt_from(double interval_s) {
  SiteTally lesson({.intensity = 0.2, .length_m = 25.0}, interval_s);
  const math::RandomStream random(1, 1);
  const double kept = std::exp(-interval_s / 8.0);
  double gust_m_s = 0.0;
  std::uint64_t drawn = 0;
  for (double time_s = 0.0; time_s < 1800.0; time_s += interval_s) {
    gust_m_s = kept * gust_m_s + std::sqrt(1.0 - kept * kept) * random.normal(drawn++);
    if (time_s > 600.0 && time_s < 700.0) continue;
    lesson.add(time_s, 5.0 + gust_m_s, wind::Vector{0.1 * gust_m_s, 5.0 + gust_m_s});
  }
  return lesson.numbers();
}

TEST(SiteTally, LearnsTheOctavesThatASensorIsQuickEnoughFor) {
  const auto quick = learnt_from(0.1);
  ASSERT_TRUE(quick);
  EXPECT_EQ(quick->octaves_db.size(), 7U);
  EXPECT_EQ(quick->length_m, 25.0);
  EXPECT_GT(quick->known_s, 600.0);
  const auto second = learnt_from(1.0);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->octaves_db.size(), 4U);
  // Both see the same wind, which falls with the square of the frequency, steeper than von Karman's, and is the same
  // across as along, which von Karman's is not.
  for (std::size_t octave = 0; octave < 4; ++octave) {
    EXPECT_NEAR(second->octaves_db[octave], quick->octaves_db[octave], 1.7) << octave;
  }
  EXPECT_LT(quick->octaves_db[5], quick->octaves_db[0]);
  EXPECT_FALSE(learnt_from(2.0));
}

}  // namespace
}  // namespace yuragi::daemon::tools::report
