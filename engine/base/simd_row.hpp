#pragma once

#include <array>
#include <string_view>

namespace yuragi {

/// The instruction sets that each kernel file is compiled for (config/cmake/Yuragi.cmake, yuragi_kernel). All rows
/// compute the same bits; only the time differs.
enum class SimdRow { kX86_64, kX86_64_v3, kX86_64_v4 };

inline constexpr std::array kSimdRows = {SimdRow::kX86_64, SimdRow::kX86_64_v3, SimdRow::kX86_64_v4};

std::string_view name_of(SimdRow row);

/// Was the row compiled in, and can this machine run it?
bool is_runnable(SimdRow row);

/// The widest row that is_runnable; chosen once, at the first call. Thread-safe.
SimdRow best_simd_row();

}  // namespace yuragi
