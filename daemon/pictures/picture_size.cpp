#include "daemon/pictures/picture_size.hpp"

#include <string>

namespace yuragi::daemon::pictures {

Result<void, Failure> checked_size(std::uint64_t width_px, std::uint64_t height_px) {
  const bool is_empty = width_px == 0 || height_px == 0;
  const bool is_long = width_px > kMaxFileSide_px || height_px > kMaxFileSide_px;
  if (!is_empty && !is_long && width_px * height_px <= kMaxFilePixels) return {};
  return Failure{.message = "has " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                            " pixels; allowed: up to " + std::to_string(kMaxFilePixels >> 20) + " million, and " +
                            std::to_string(kMaxFileSide_px) + " along a side; save it smaller",
                 .kind = FailureKind::kBadData};
}

}  // namespace yuragi::daemon::pictures
