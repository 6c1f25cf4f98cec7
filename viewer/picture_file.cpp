#include "viewer/picture_file.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include <stb_image_write.h>
#include <unistd.h>

#include "viewer/viewer_exit.hpp"

namespace yuragi::viewer {

std::optional<PictureFormat> picture_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension == ".png") return PictureFormat::kPng;
  if (extension == ".jpg" || extension == ".jpeg") return PictureFormat::kJpeg;
  return std::nullopt;
}

void write_picture(const std::filesystem::path& file, int width_px, int height_px, std::span<const std::uint8_t> rgb) {
  // Beside it first, so that the last step is a rename within one file system.
  std::filesystem::path beside = file;
  beside += ".part-" + std::to_string(::getpid());
  std::ofstream out(beside, std::ios::binary);
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::ofstream*>(context)->write(static_cast<const char*>(data), size);
  };
  constexpr int kJpegQuality = 92;  // of 100: blades of grass keep their edges
  const int is_encoded = picture_format(file) == PictureFormat::kJpeg
                             ? stbi_write_jpg_to_func(append, &out, width_px, height_px, 3, rgb.data(), kJpegQuality)
                             : stbi_write_png_to_func(append, &out, width_px, height_px, 3, rgb.data(), width_px * 3);
  out.close();

  std::error_code error;
  if (is_encoded != 0 && out) std::filesystem::rename(beside, file, error);
  if (is_encoded == 0 || !out || error) {
    std::error_code ignored;
    std::filesystem::remove(beside, ignored);
    throw ViewerExit(EX_CANTCREAT, "cannot write " + file.string() + (error ? ": " + error.message() : "") +
                                       "; does the folder exist, and may you write there?");
  }
}

}  // namespace yuragi::viewer
