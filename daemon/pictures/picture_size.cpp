#include "daemon/pictures/picture_size.hpp"

#include <string>

namespace yuragi::daemon::pictures {

Result<void, Failure> checked_size(std::uint64_t width_px, std::uint64_t height_px) {
  const bool is_empty = width_px == 0 || height_px == 0;
  const bool is_long = width_px > kLongestFileSide_px || height_px > kLongestFileSide_px;
  if (!is_empty && !is_long && width_px * height_px <= kMostFilePixels) return {};
  return Failure{.message = "has " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                            " pixels; allowed: up to " + std::to_string(kMostFilePixels >> 20) + " million, and " +
                            std::to_string(kLongestFileSide_px) + " along a side; save it smaller",
                 .kind = FailureKind::kBadData};
}

}  // namespace yuragi::daemon::pictures
