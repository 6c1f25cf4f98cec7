#pragma once

#include <cstddef>
#include <span>

#include "engine/base/part.hpp"
#include "engine/pose/skeleton.hpp"

namespace yuragi::scenes {

/// A part's strands, in whole blocks, of any array with an element per strand.
template <class Value>
std::span<Value> strands_of(Part part, std::span<Value> values) noexcept {
  const std::size_t blocks = values.size() / pose::kStrandsPerBlock;
  const std::size_t begin = part.begin(blocks) * pose::kStrandsPerBlock;
  return values.subspan(begin, part.end(blocks) * pose::kStrandsPerBlock - begin);
}

}  // namespace yuragi::scenes
