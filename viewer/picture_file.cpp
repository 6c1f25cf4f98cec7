#include "viewer/picture_file.hpp"

#include <fstream>
#include <system_error>

#include <stb_image_write.h>
#include <unistd.h>

#include "viewer/viewer_exit.hpp"

namespace yuragi {

void write_png(const std::filesystem::path& file, int width_px, int height_px, std::span<const std::uint8_t> rgb) {
  // Beside it first, so that the last step is a rename within one file system.
  std::filesystem::path beside = file;
  beside += ".part-" + std::to_string(::getpid());
  std::ofstream out(beside, std::ios::binary);
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::ofstream*>(context)->write(static_cast<const char*>(data), size);
  };
  const int is_encoded = stbi_write_png_to_func(append, &out, width_px, height_px, 3, rgb.data(), width_px * 3);
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

}  // namespace yuragi
