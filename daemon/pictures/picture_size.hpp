#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/result.hpp"

namespace yuragi::daemon::pictures {

inline constexpr std::size_t kMostFilePixels = std::size_t{1} << 24;  ///< before it is scaled down
inline constexpr std::uint32_t kLongestFileSide_px = 16384;

/// Are the sides that a file says within these limits? Otherwise a message. To be asked before memory is.
Result<void, Failure> checked_size(std::uint64_t width_px, std::uint64_t height_px);

}  // namespace yuragi::daemon::pictures
