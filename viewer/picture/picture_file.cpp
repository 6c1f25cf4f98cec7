#include "viewer/picture/picture_file.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <stb_image_write.h>

#include "engine/platform/whole_file.hpp"
#include "viewer/picture/viewer_exit.hpp"

namespace yuragi::viewer::picture {
std::optional<Format> picture_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension == ".png") return Format::kPng;
  if (extension == ".jpg" || extension == ".jpeg") return Format::kJpeg;
  return std::nullopt;
}

void write_picture(const std::filesystem::path& file, int width_px, int height_px, std::span<const std::uint8_t> rgb) {
  std::vector<std::uint8_t> bytes;
  const auto append = [](void* context, void* data, int size) {
    const auto* const begin = static_cast<const std::uint8_t*>(data);
    auto& all = *static_cast<std::vector<std::uint8_t>*>(context);
    all.insert(all.end(), begin, begin + size);
  };
  constexpr int kJpegQuality = 92;  // of 100: keeps the edges of blades of grass
  const int is_encoded = picture_format(file) == Format::kJpeg
                             ? stbi_write_jpg_to_func(append, &bytes, width_px, height_px, 3, rgb.data(), kJpegQuality)
                             : stbi_write_png_to_func(append, &bytes, width_px, height_px, 3, rgb.data(), width_px * 3);
  if (is_encoded == 0) throw ViewerExit(EX_SOFTWARE, "there is no memory for the picture " + file.string());

  std::string why;
  try {
    const auto written = platform::write_whole(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    if (written) return;
    why = written.error().message;
  } catch (const FailureError& error) {
    why = error.what();
  }
  throw ViewerExit(EX_CANTCREAT, "cannot write " + why);
}

}  // namespace yuragi::viewer::picture
