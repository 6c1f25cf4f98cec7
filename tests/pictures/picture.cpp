#include "tests/pictures/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>

#include <stb_image.h>

namespace yuragi::viewer {
namespace {

constexpr int kSquare_px = 6;
constexpr double kChanged = 6.0;
constexpr int kBrighter = 4;

using Mean = std::array<double, 3>;

std::size_t index(int row, int columns, int column) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

std::vector<Mean> means_over_squares(const Picture& picture) {
  const int columns = (picture.width_px + kSquare_px - 1) / kSquare_px;
  const int rows = (picture.height_px + kSquare_px - 1) / kSquare_px;
  std::vector<Mean> sums(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<double> counts(sums.size());
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const std::size_t square = index(y / kSquare_px, columns, x / kSquare_px);
      const std::size_t at = 3 * index(y, picture.width_px, x);
      for (std::size_t channel = 0; channel < 3; ++channel) sums[square][channel] += picture.rgb[at + channel];
      counts[square] += 1.0;
    }
  }
  for (std::size_t square = 0; square < sums.size(); ++square) {
    for (double& channel : sums[square]) channel /= counts[square];
  }
  return sums;
}

bool have_same_size(const Picture& a, const Picture& b) {
  return a.width_px == b.width_px && a.height_px == b.height_px && a.rgb.size() == b.rgb.size();
}

}  // namespace

std::optional<Picture> read_picture(const std::filesystem::path& file) {
  Picture picture;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load(file.c_str(), &picture.width_px, &picture.height_px, nullptr, 3), stbi_image_free);
  if (!pixels) return std::nullopt;
  picture.rgb.assign(pixels.get(), pixels.get() + std::ptrdiff_t{3} * picture.width_px * picture.height_px);
  return picture;
}

PictureDifference difference(const Picture& a, const Picture& b) {
  if (!have_same_size(a, b) || a.rgb.empty()) return {255.0, 1.0};
  const std::vector<Mean> of_a = means_over_squares(a);
  const std::vector<Mean> of_b = means_over_squares(b);
  PictureDifference result;
  for (std::size_t square = 0; square < of_a.size(); ++square) {
    double most = 0.0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double differs = std::abs(of_a[square][channel] - of_b[square][channel]);
      result.mean += differs / 3.0;
      most = std::max(most, differs);
    }
    if (most > kChanged) result.changed_part += 1.0;
  }
  result.mean /= static_cast<double>(of_a.size());
  result.changed_part /= static_cast<double>(of_a.size());
  return result;
}

double signal_to_noise_db(const Picture& a, const Picture& b) {
  double squares = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double differs = static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]);
    squares += differs * differs;
  }
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.rgb.size()) / squares);
}

Picture difference_picture(const Picture& a, const Picture& b) {
  Picture result = a;
  for (std::size_t i = 0; i < std::min(a.rgb.size(), b.rgb.size()); ++i) {
    result.rgb[i] = static_cast<std::uint8_t>(std::min(255, kBrighter * std::abs(a.rgb[i] - b.rgb[i])));
  }
  return result;
}

}  // namespace yuragi::viewer
