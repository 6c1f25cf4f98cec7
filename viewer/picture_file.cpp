#include "viewer/picture_file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <stb_image_write.h>
#include <unistd.h>

#include "viewer/viewer_exit.hpp"
#include "viewer/write_all.hpp"

namespace yuragi::viewer {
namespace {

/// Returns 0, or an errno.
int write_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd < 0) return errno;
  static const std::atomic<bool> kNeverStops{false};
  const int error = write_all(fd, bytes, kNeverStops);
  const bool is_closed = ::close(fd) == 0;
  return error == 0 && !is_closed ? errno : error;
}

}  // namespace

std::optional<PictureFormat> picture_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension == ".png") return PictureFormat::kPng;
  if (extension == ".jpg" || extension == ".jpeg") return PictureFormat::kJpeg;
  return std::nullopt;
}

void write_picture(const std::filesystem::path& file, int width_px, int height_px, std::span<const std::uint8_t> rgb) {
  std::vector<std::uint8_t> bytes;
  const auto append = [](void* context, void* data, int size) {
    const auto* const begin = static_cast<const std::uint8_t*>(data);
    auto& all = *static_cast<std::vector<std::uint8_t>*>(context);
    all.insert(all.end(), begin, begin + size);
  };
  constexpr int kJpegQuality = 92;  // of 100: blades of grass keep their edges
  const int is_encoded = picture_format(file) == PictureFormat::kJpeg
                             ? stbi_write_jpg_to_func(append, &bytes, width_px, height_px, 3, rgb.data(), kJpegQuality)
                             : stbi_write_png_to_func(append, &bytes, width_px, height_px, 3, rgb.data(), width_px * 3);
  if (is_encoded == 0) throw ViewerExit(EX_SOFTWARE, "there is no memory for the picture " + file.string());

  // Beside it first, so that the last step is a rename within one file system.
  std::filesystem::path beside = file;
  beside += ".part-" + std::to_string(::getpid());
  std::error_code error(write_file(beside, bytes), std::generic_category());
  if (!error) std::filesystem::rename(beside, file, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  throw ViewerExit(EX_CANTCREAT, "cannot write " + file.string() + ": " + error.message());
}

}  // namespace yuragi::viewer
