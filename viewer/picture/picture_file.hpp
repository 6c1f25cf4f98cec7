#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

namespace yuragi::viewer::picture {

enum class Format : std::uint8_t { kPng, kJpeg };

/// The format for a file name's extension: .png, .jpg or .jpeg, in any case. Nullopt for any other.
std::optional<Format> picture_format(const std::filesystem::path& file);

/// Writes width x height pixels of 3 bytes, rows from the top down, in the format that the name of `file` asks for (PNG
/// if it has no known extension). A reader of `file` gets either the whole picture or the previous one. Throws
/// ViewerExit (EX_CANTCREAT).
void write_picture(const std::filesystem::path& file, int width_px, int height_px, std::span<const std::uint8_t> rgb);

}  // namespace yuragi::viewer::picture
