#pragma once

#include <string>

#include <gtest/gtest.h>

#include "engine/base/simd_row.hpp"

namespace yuragi {

/// A test that runs on each row of the kernels; what this machine or build cannot run is skipped, and says so.
class EachSimdRow : public testing::TestWithParam<SimdRow> {
 protected:
  void SetUp() override {
    if (!is_runnable(GetParam())) {
      GTEST_SKIP() << "this machine or build cannot run the row " << name_of(GetParam());
    }
  }
};

inline std::string row_test_name(const testing::TestParamInfo<SimdRow>& row) {
  std::string name(name_of(row.param));
  for (char& letter : name) {
    if (letter == '-') letter = '_';
  }
  return name;
}

}  // namespace yuragi

#define YURAGI_ON_EACH_ROW(suite) \
  INSTANTIATE_TEST_SUITE_P(Rows, suite, testing::ValuesIn(::yuragi::kSimdRows), ::yuragi::row_test_name)
