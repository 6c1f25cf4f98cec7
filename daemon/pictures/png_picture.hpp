#pragma once

#include <cstdint>
#include <span>

#include "engine/base/result.hpp"
#include "engine/look/cloth_look.hpp"

namespace yuragi::daemon::pictures {

bool is_png(std::span<const std::uint8_t> bytes);

/// By libpng's simplified interface.
Result<look::Image, Failure> decoded_png(std::span<const std::uint8_t> bytes, look::Color background);

}  // namespace yuragi::daemon::pictures
