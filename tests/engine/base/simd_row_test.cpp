#include "engine/base/simd_row.hpp"

#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

// The list of this processor's rows in config/cmake/SimdRows.cmake, of which sanitizer builds have the first alone.
TEST(SimdRow, EveryRowHasTheNameThatItsProcessorsCompilersGiveIt) {
  std::vector<std::string_view> names;
  for (const SimdRow row : kSimdRows) names.push_back(name_of(row));
#if defined(__x86_64__)
  std::vector<std::string_view> expected{"x86-64", "x86-64-v3", "x86-64-v4"};
#elif defined(__aarch64__)
  std::vector<std::string_view> expected{"aarch64"};
#else
  std::vector<std::string_view> expected{"base"};
#endif
  if (names.size() == 1) expected.resize(1);
  EXPECT_EQ(names, expected);
}

TEST(SimdRow, TheBaseRowRunsEverywhere) {
  EXPECT_TRUE(is_runnable(kBaseSimdRow));
}

TEST(SimdRow, AMachineThatRunsAWideRowRunsTheNarrowerOnes) {
  for (std::size_t i = 1; i < kSimdRows.size(); ++i) {
    EXPECT_TRUE(!is_runnable(kSimdRows[i]) || is_runnable(kSimdRows[i - 1])) << name_of(kSimdRows[i]);
  }
}

TEST(SimdRow, TheBestRowIsTheWidestThatRuns) {
  const SimdRow best = best_simd_row();
  EXPECT_TRUE(is_runnable(best));
  for (const SimdRow row : kSimdRows) {
    if (row > best) {
      EXPECT_FALSE(is_runnable(row)) << name_of(row);
    }
  }
}

}  // namespace
}  // namespace yuragi
