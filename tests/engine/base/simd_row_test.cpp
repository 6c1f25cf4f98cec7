#include "engine/base/simd_row.hpp"

#include <set>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

TEST(SimdRow, EveryRowHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (const SimdRow row : kSimdRows) names.insert(name_of(row));
  EXPECT_EQ(names, (std::set<std::string_view>{"x86-64", "x86-64-v3", "x86-64-v4"}));
}

TEST(SimdRow, TheBaseRowRunsEverywhere) {
  EXPECT_TRUE(is_runnable(SimdRow::kX86_64));
}

TEST(SimdRow, AMachineThatRunsAWideRowRunsTheNarrowerOnes) {
  EXPECT_TRUE(!is_runnable(SimdRow::kX86_64_v4) || is_runnable(SimdRow::kX86_64_v3));
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
