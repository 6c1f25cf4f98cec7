#pragma once

#include "daemon/pictures/picture_file.hpp"

namespace yuragi::daemon::pictures {

bool is_jpeg(std::span<const std::uint8_t> bytes);

/// By libjpeg.
Result<look::Image, Failure> decoded_jpeg(std::span<const std::uint8_t> bytes);

}  // namespace yuragi::daemon::pictures
