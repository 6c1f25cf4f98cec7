#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace yuragi::test {

/// A PNG file (ISO/IEC 15948) of 8 bits a part, not compressed (RFC 1950, RFC 1951: stored blocks), written by nothing
/// but this. `said_width_px` and `said_height_px` are what its header says, `rows` its pixels: a filter type of 0 and
/// 3 (or, `has_alpha`, 4) bytes a pixel in each.
inline std::vector<std::uint8_t> png_file(std::uint32_t said_width_px, std::uint32_t said_height_px,
                                          std::span<const std::uint8_t> rows, bool has_alpha = false) {
  std::vector<std::uint8_t> file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  const auto add_u32 = [](std::vector<std::uint8_t>& to, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<std::uint8_t>(value >> shift));
  };
  const auto add_chunk = [&](std::string_view type, std::span<const std::uint8_t> content) {
    add_u32(file, static_cast<std::uint32_t>(content.size()));
    const std::size_t begin = file.size();
    file.insert(file.end(), type.begin(), type.end());
    file.insert(file.end(), content.begin(), content.end());
    std::uint32_t crc = 0xFFFFFFFFU;
    for (std::size_t i = begin; i < file.size(); ++i) {
      crc ^= file[i];
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (0xEDB88320U & (0U - (crc & 1U)));
    }
    add_u32(file, ~crc);
  };

  std::vector<std::uint8_t> header;
  add_u32(header, said_width_px);
  add_u32(header, said_height_px);
  const std::array<std::uint8_t, 5> kind{8, static_cast<std::uint8_t>(has_alpha ? 6 : 2), 0, 0, 0};
  header.insert(header.end(), kind.begin(), kind.end());
  add_chunk("IHDR", header);

  std::vector<std::uint8_t> data{0x78, 0x01};
  constexpr std::size_t kBlock = 0xFFFF;
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (std::size_t at = 0; at < rows.size(); at += kBlock) {
    const std::span<const std::uint8_t> block = rows.subspan(at, std::min(kBlock, rows.size() - at));
    const auto size = static_cast<std::uint16_t>(block.size());
    data.push_back(at + kBlock >= rows.size() ? 1 : 0);
    for (const std::uint16_t value : {size, static_cast<std::uint16_t>(~size)}) {
      data.push_back(static_cast<std::uint8_t>(value & 0xFFU));
      data.push_back(static_cast<std::uint8_t>(value >> 8U));
    }
    data.insert(data.end(), block.begin(), block.end());
    for (const std::uint8_t byte : block) {
      a = (a + byte) % 65521U;
      b = (b + a) % 65521U;
    }
  }
  add_u32(data, b << 16 | a);
  add_chunk("IDAT", data);
  add_chunk("IEND", {});
  return file;
}

/// One of 2 x 2 pixels: red, green; blue, white.
inline std::vector<std::uint8_t> small_png() {
  const std::array<std::uint8_t, 14> rows{0, 255, 0, 0, 0, 255, 0, 0, 0, 0, 255, 255, 255, 255};
  return png_file(2, 2, rows);
}

}  // namespace yuragi::test
