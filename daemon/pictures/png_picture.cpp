#include "daemon/pictures/png_picture.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <png.h>

#include "daemon/pictures/picture_size.hpp"

namespace yuragi::daemon::pictures {
namespace {

constexpr std::array<std::uint8_t, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

/// Frees what libpng holds.
struct PngReading {
  png_image image{};
  PngReading() { image.version = PNG_IMAGE_VERSION; }
  ~PngReading() { png_image_free(&image); }
  PngReading(const PngReading&) = delete;
  PngReading& operator=(const PngReading&) = delete;
};

Failure damaged_png(const png_image& image) {
  return {.message = "is a damaged PNG file (" + std::string(image.message) + "); save it anew",
          .kind = FailureKind::kBadData};
}

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kPngSignature.size() && std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin());
}

Result<look::Image, Failure> decoded_png(std::span<const std::uint8_t> bytes, look::Color background) {
  PngReading reading;
  png_image& image = reading.image;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) return damaged_png(image);
  if (auto size = checked_size(image.width, image.height); !size) return size.error();
  image.format = PNG_FORMAT_RGB;
  look::Image pixels{.width_px = image.width, .height_px = image.height, .rgb = {}};
  pixels.rgb.resize(PNG_IMAGE_SIZE(image));
  const png_color behind{background.red, background.green, background.blue};
  if (png_image_finish_read(&image, &behind, pixels.rgb.data(), 0, nullptr) == 0) return damaged_png(image);
  return pixels;
}

}  // namespace yuragi::daemon::pictures
