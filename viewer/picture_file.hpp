#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace yuragi {

/// Writes width x height pixels of 3 bytes, rows from the top down, as a PNG. Whoever reads `file` finds the whole
/// picture or the one that was there before. Throws ViewerExit (EX_CANTCREAT).
void write_png(const std::filesystem::path& file, int width_px, int height_px, std::span<const std::uint8_t> rgb);

}  // namespace yuragi
