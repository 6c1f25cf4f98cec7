#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/result.hpp"

namespace yuragi::daemon::pictures {

inline constexpr std::size_t kMaxFilePixels = std::size_t{1} << 24;  ///< before it is scaled down
inline constexpr std::uint32_t kMaxFileSide_px = 16384;

/// Checks that the sides given in a file are within these limits; otherwise a message. Call it before allocating.
Result<void, Failure> checked_size(std::uint64_t width_px, std::uint64_t height_px);

}  // namespace yuragi::daemon::pictures
