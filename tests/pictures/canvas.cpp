#include "tests/pictures/canvas.hpp"

#include <algorithm>
#include <cstring>

#include <stb_easy_font.h>

#include "viewer/picture/picture_file.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kFontHeight_px = 12;  // of stb_easy_font
constexpr std::uint8_t kLetters = 230;

/// A corner of a rectangle, as stb_easy_font writes it. It writes four for each.
struct FontVertex {
  float x, y, z;
  std::array<std::uint8_t, 4> color;
};

}  // namespace

Canvas::Canvas(int width_px, int height_px)
    : width_px_(width_px),
      height_px_(height_px),
      rgb_(3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {}

void Canvas::put(int left_px, int top_px, int picture_width_px, std::span<const std::uint8_t> rgb) {
  const int rows = static_cast<int>(rgb.size()) / (3 * picture_width_px);
  const int columns = std::min(picture_width_px, width_px_ - left_px);
  for (int row = 0; row < std::min(rows, height_px_ - top_px); ++row) {
    std::copy_n(rgb.begin() + std::ptrdiff_t{3} * row * picture_width_px, 3 * columns,
                rgb_.begin() + std::ptrdiff_t{3} * ((top_px + row) * width_px_ + left_px));
  }
}

void Canvas::write_text(int left_px, int top_px, std::string text) {
  constexpr int kScale = kTextHeight_px / kFontHeight_px;
  std::vector<FontVertex> corners(text.size() * 20);
  const int rectangles = stb_easy_font_print(0.0F, 0.0F, text.data(), nullptr, corners.data(),
                                             static_cast<int>(corners.size() * sizeof(FontVertex)));
  for (std::size_t i = 0; i < static_cast<std::size_t>(rectangles); ++i) {
    const FontVertex& low = corners[4 * i];
    const FontVertex& high = corners[4 * i + 2];
    for (int y = kScale * static_cast<int>(low.y); y < kScale * static_cast<int>(high.y); ++y) {
      for (int x = kScale * static_cast<int>(low.x); x < kScale * static_cast<int>(high.x); ++x) {
        if (left_px + x >= width_px_ || top_px + y >= height_px_) continue;
        std::fill_n(rgb_.begin() + std::ptrdiff_t{3} * ((top_px + y) * width_px_ + left_px + x), 3, kLetters);
      }
    }
  }
}

void Canvas::save(const std::filesystem::path& file) const {
  picture::write_picture(file, width_px_, height_px_, rgb_);
}

}  // namespace yuragi::viewer
