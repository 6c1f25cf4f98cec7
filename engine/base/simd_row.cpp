#include "engine/base/simd_row.hpp"

namespace yuragi {
namespace {

struct SimdRowDescription {
  std::string_view name;
  bool (*is_runnable)();
};

#define YURAGI_DESCRIBE_SIMD_ROW(name, printed, runnable) \
  SimdRowDescription{printed, [] { return static_cast<bool>(runnable); }},
constexpr std::array kDescriptions{YURAGI_SIMD_ROWS(YURAGI_DESCRIBE_SIMD_ROW)};
#undef YURAGI_DESCRIBE_SIMD_ROW

const SimdRowDescription& description_of(SimdRow row) {
  return kDescriptions[static_cast<std::size_t>(row)];
}

}  // namespace

std::string_view name_of(SimdRow row) {
  return description_of(row).name;
}

bool is_runnable(SimdRow row) {
  return description_of(row).is_runnable();
}

SimdRow best_simd_row() {
  static const SimdRow best = [] {
    SimdRow widest = kBaseSimdRow;
    for (const SimdRow row : kSimdRows) {
      if (is_runnable(row)) widest = row;
    }
    return widest;
  }();
  return best;
}

}  // namespace yuragi
