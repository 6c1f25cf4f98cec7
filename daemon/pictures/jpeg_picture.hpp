#pragma once

#include <cstdint>
#include <span>

#include "engine/base/result.hpp"
#include "engine/look/cloth_look.hpp"

namespace yuragi::daemon::pictures {

/// Real progressive files have about 10.
inline constexpr int kMaxJpegScans = 500;

bool is_jpeg(std::span<const std::uint8_t> bytes);

/// By libjpeg.
Result<look::Image, Failure> decoded_jpeg(std::span<const std::uint8_t> bytes);

}  // namespace yuragi::daemon::pictures
