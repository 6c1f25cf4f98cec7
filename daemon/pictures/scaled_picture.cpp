#include "daemon/pictures/scaled_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace yuragi::daemon::pictures {
namespace {

/// Screen values (IEC 61966-2-1, sRGB) as light, 0 to 1.
std::array<float, 256> light_of_values() {
  std::array<float, 256> light{};
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double value = static_cast<double>(i) / 255.0;
    light[i] = static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
  }
  return light;
}

std::uint8_t value_of_light(float light) {
  const double value = light <= 0.0031308F ? 12.92 * static_cast<double>(light)
                                           : 1.055 * std::pow(static_cast<double>(light), 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::clamp(std::lround(255.0 * value), 0L, 255L));
}

}  // namespace

look::Image scaled_down(look::Image picture) {
  const std::size_t width = picture.width_px;
  const std::size_t height = picture.height_px;
  const auto pixels = static_cast<double>(width * height);
  const double by = std::max({1.0, std::sqrt(pixels / static_cast<double>(look::Image::kMaxPixels)),
                              static_cast<double>(std::max(width, height)) / look::Image::kMaxSide_px});
  if (by <= 1.0) return picture;

  const auto scaled = [&](std::size_t side) {
    return std::max<std::size_t>(static_cast<std::size_t>(static_cast<double>(side) / by), 1);
  };
  const std::size_t columns = scaled(width);
  const std::size_t rows = scaled(height);
  const std::array<float, 256> light = light_of_values();
  look::Image small{.width_px = static_cast<std::uint32_t>(columns),
                    .height_px = static_cast<std::uint32_t>(rows),
                    .rgb = std::vector<std::uint8_t>(3 * columns * rows)};
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t top = row * height / rows;
    const std::size_t bottom = std::max((row + 1) * height / rows, top + 1);
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t left = column * width / columns;
      const std::size_t right = std::max((column + 1) * width / columns, left + 1);
      std::array<float, 3> sum{};
      for (std::size_t y = top; y < bottom; ++y) {
        for (std::size_t x = left; x < right; ++x) {
          for (std::size_t part = 0; part < 3; ++part) sum[part] += light[picture.rgb[3 * (y * width + x) + part]];
        }
      }
      const auto count = static_cast<float>((bottom - top) * (right - left));
      for (std::size_t part = 0; part < 3; ++part) {
        small.rgb[3 * (row * columns + column) + part] = value_of_light(sum[part] / count);
      }
    }
  }
  return small;
}

}  // namespace yuragi::daemon::pictures
