#include "engine/base/simd_row.hpp"

namespace yuragi {

std::string_view name_of(SimdRow row) {
  switch (row) {
    case SimdRow::kX86_64:
      return "x86-64";
    case SimdRow::kX86_64_v3:
      return "x86-64-v3";
    case SimdRow::kX86_64_v4:
      return "x86-64-v4";
  }
  return "?";
}

bool is_runnable(SimdRow row) {
  switch (row) {
    case SimdRow::kX86_64:
      return true;
#if YURAGI_ALL_SIMD_ROWS
    case SimdRow::kX86_64_v3:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    case SimdRow::kX86_64_v4:
      return is_runnable(SimdRow::kX86_64_v3) && __builtin_cpu_supports("avx512f") &&
             __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    case SimdRow::kX86_64_v3:
    case SimdRow::kX86_64_v4:
      return false;
#endif
  }
  return false;
}

SimdRow best_simd_row() {
  static const SimdRow best = [] {
    SimdRow widest = SimdRow::kX86_64;
    for (const SimdRow row : kSimdRows) {
      if (is_runnable(row)) widest = row;
    }
    return widest;
  }();
  return best;
}

}  // namespace yuragi
