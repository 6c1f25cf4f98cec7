#pragma once

#include <algorithm>
#include <cstddef>

namespace yuragi {

/// One of several parts of a work that may run at the same time, on different threads: part `index` of `count`.
struct Part {
  std::size_t index = 0;
  std::size_t count = 1;

  /// The part's range of `units` elements: its begin and its end. The ranges of all parts cover every unit once.
  std::size_t begin(std::size_t units) const noexcept { return units * index / count; }
  std::size_t end(std::size_t units) const noexcept { return units * (index + 1) / count; }
};

}  // namespace yuragi
