#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace yuragi::look {

/// A screen's color (sRGB).
struct Color {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Color&, const Color&) = default;
};

/// A picture: row after row from its upper left corner, 3 bytes a pixel (sRGB).
struct Image {
  static constexpr std::size_t kMaxPixels = std::size_t{1} << 20;
  static constexpr std::uint32_t kMaxSide_px = 4096;

  std::uint32_t width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 * width_px * height_px
  friend bool operator==(const Image&, const Image&) = default;
};

/// The configured look of a flag, a banner or a curtain.
struct ClothLook {
  std::optional<Color> color = std::nullopt;     ///< of the cloth; alone: plain. Nullopt: the viewer's own
  std::optional<Color> color_2 = std::nullopt;   ///< of its pattern
  std::shared_ptr<const Image> image = nullptr;  ///< covers all of it

  friend bool operator==(const ClothLook& a, const ClothLook& b) {
    const bool is_same_image = a.image == b.image || (a.image != nullptr && b.image != nullptr && *a.image == *b.image);
    return a.color == b.color && a.color_2 == b.color_2 && is_same_image;
  }
};

}  // namespace yuragi::look
