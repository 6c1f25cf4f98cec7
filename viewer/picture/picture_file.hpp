#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

namespace yuragi::viewer::picture {

enum class Format : std::uint8_t { kPng, kJpeg };

/// The format that the end of a file's name asks for: .png, .jpg or .jpeg, in any case. Nothing for any other.
std::optional<Format> picture_format(const std::filesystem::path& file);

/// Writes width x height pixels of 3 bytes, rows from the top down, in the format that the name of `file` asks for (PNG
/// where it names none). Whoever reads `file` finds the whole picture or the one that was there before. Throws
/// ViewerExit (EX_CANTCREAT).
void write_picture(const std::filesystem::path& file, int width_px, int height_px, std::span<const std::uint8_t> rgb);

}  // namespace yuragi::viewer::picture
