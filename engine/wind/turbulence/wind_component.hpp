#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace yuragi::wind::turbulence {

/// Along the mean wind, across it, and upward.
enum class WindComponent : std::uint8_t { kAlong, kAcross, kUpward };
inline constexpr std::array<std::string_view, 3> kWindComponentNames = {"u", "v", "w"};

}  // namespace yuragi::wind::turbulence
