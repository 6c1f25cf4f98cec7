#pragma once

#include "engine/base/simd_row.hpp"

// Kernel files are those that yuragi_kernel (config/cmake/Yuragi.cmake) compiles once a SIMD row.
//
// What stands in a kernel file: plain loops over raw pointers, in an anonymous namespace, and one constant table of
// functions named by YURAGI_ROW_NAME. What it includes may only hold declarations, plain structs, and functions that
// are always inlined (engine/math/trig.hpp). An ordinary inline function or template would be compiled in all three
// rows, and the linker keeps one of the copies, perhaps the AVX-512 one, for all rows.

#define YURAGI_JOIN_TOKENS(left, right) left##_##right
#define YURAGI_JOIN(left, right) YURAGI_JOIN_TOKENS(left, right)

/// In a kernel file: `table` with the name of the row behind it, as in bend_kernels_x86_64_v3.
#define YURAGI_ROW_NAME(table) YURAGI_JOIN(table, YURAGI_SIMD_ROW)

/// Elsewhere: the three tables of a kernel as initializer of a KernelRows. Builds that have the base row alone
/// (sanitizers) name it three times; is_runnable() keeps the others from being asked for.
#if YURAGI_ALL_SIMD_ROWS
#define YURAGI_KERNEL_ROWS(table) \
  { &table##_x86_64, &table##_x86_64_v3, &table##_x86_64_v4 }
#else
#define YURAGI_KERNEL_ROWS(table) \
  { &table##_x86_64, &table##_x86_64, &table##_x86_64 }
#endif

namespace yuragi {

/// A kernel's function table for each row.
template <class Table>
struct KernelRows {
  const Table* x86_64;
  const Table* x86_64_v3;
  const Table* x86_64_v4;

  const Table& operator[](SimdRow row) const noexcept {
    switch (row) {
      case SimdRow::kX86_64:
        break;
      case SimdRow::kX86_64_v3:
        return *x86_64_v3;
      case SimdRow::kX86_64_v4:
        return *x86_64_v4;
    }
    return *x86_64;
  }
};

}  // namespace yuragi
