#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "engine/base/simd_rows.hpp"

namespace yuragi {

/// One of the instruction sets that each kernel file is compiled for: its place in the list of the processor for which
/// this is built (config/cmake/SimdRows.cmake). All rows compute the same bits; only the time differs.
enum class SimdRow : std::uint8_t {};

/// The row that every machine of the kind runs.
inline constexpr SimdRow kBaseSimdRow{0};

#define YURAGI_COUNT_SIMD_ROW(name, printed, runnable) +1  // NOLINT(bugprone-macro-parentheses): a summand
inline constexpr std::size_t kSimdRowCount = 0 YURAGI_SIMD_ROWS(YURAGI_COUNT_SIMD_ROW);
#undef YURAGI_COUNT_SIMD_ROW

/// All rows, from the base row to the widest.
inline constexpr std::array kSimdRows = [] {
  std::array<SimdRow, kSimdRowCount> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = SimdRow{static_cast<std::uint8_t>(i)};
  return rows;
}();

/// The compilers' name of it: "x86-64-v3", "aarch64".
std::string_view name_of(SimdRow row);

/// Can this machine run the row?
bool is_runnable(SimdRow row);

/// The widest row that this processor supports (is_runnable()); chosen once, at the first call. Thread-safe.
SimdRow best_simd_row();

}  // namespace yuragi
