#pragma once

#include <array>
#include <cstddef>

#include "engine/base/simd_row.hpp"

// Kernel files are those that yuragi_kernel (config/cmake/Yuragi.cmake) compiles once a SIMD row.
//
// Content of a kernel file: plain loops over raw pointers, in an anonymous namespace, and one constant table of
// functions named by YURAGI_ROW_NAME. Its headers may contain only declarations, plain structs, and functions that are
// always inlined (engine/math/trig.hpp). An ordinary inline function or template would be compiled in all rows, and the
// linker keeps one of the copies, perhaps the AVX-512 one, for all rows.

#define YURAGI_JOIN_TOKENS(left, right) left##_##right
#define YURAGI_JOIN(left, right) YURAGI_JOIN_TOKENS(left, right)

/// In a kernel file: `table` with the name of the row behind it, as in bend_kernels_x86_64_v3.
#define YURAGI_ROW_NAME(table) YURAGI_JOIN(table, YURAGI_SIMD_ROW)

/// In a header: declares each row's table, of the struct `Table`.
#define YURAGI_DECLARE_KERNEL_ROWS(Table, table) YURAGI_SIMD_ROWS(YURAGI_DECLARE_KERNEL_ROW, Table, table)
#define YURAGI_DECLARE_KERNEL_ROW(row, printed, runnable, Table, table) extern const Table table##_##row;

/// Elsewhere: the tables of a kernel as initializer of a KernelRows.
#define YURAGI_KERNEL_ROWS(table)                          \
  {                                                        \
    { YURAGI_SIMD_ROWS(YURAGI_KERNEL_ROW_ADDRESS, table) } \
  }
#define YURAGI_KERNEL_ROW_ADDRESS(row, printed, runnable, table) &table##_##row,

namespace yuragi {

/// A kernel's function table for each row.
template <class Table>
struct KernelRows {
  std::array<const Table*, kSimdRowCount> rows;

  const Table& operator[](SimdRow row) const noexcept { return *rows[static_cast<std::size_t>(row)]; }
};

}  // namespace yuragi
