// Any bytes as a picture's file: it is read whole, within the stream's limits, or refused. The first byte chooses the
// background and whether a format's own first bytes stand before the others.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "daemon/pictures/picture_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace yuragi;
  if (size == 0) return 0;
  constexpr std::array<std::uint8_t, 16> kPng{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
                                              0,    0,   0,   13,  'I',  'H',  'D',  'R'};
  constexpr std::array<std::uint8_t, 3> kJpeg{0xFF, 0xD8, 0xFF};
  std::vector<std::uint8_t> file;
  if ((data[0] & 3) == 1) file.assign(kPng.begin(), kPng.end());
  if ((data[0] & 3) == 2) file.assign(kJpeg.begin(), kJpeg.end());
  file.insert(file.end(), data + 1, data + size);
  const auto picture = daemon::pictures::decoded_picture(file, {data[0], 0, 255});
  if (!picture) {
    if (picture.error().message.empty()) std::abort();
    return 0;
  }
  const std::size_t pixels = std::size_t{picture->width_px} * picture->height_px;
  if (pixels == 0 || pixels > look::Image::kMaxPixels || picture->rgb.size() != 3 * pixels) std::abort();
  if (picture->width_px > look::Image::kMaxSide_px || picture->height_px > look::Image::kMaxSide_px) std::abort();
  return 0;
}
