#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "engine/base/result.hpp"
#include "engine/look/cloth_look.hpp"

namespace yuragi::daemon::pictures {

inline constexpr std::size_t kMaxFile_bytes = std::size_t{16} << 20;

// A Failure describes what is wrong with a picture, and what is allowed or what to do: "is 40 MB large; allowed: up to
// 16 MB".

/// Reads a PNG or JPEG file, by its first bytes, and scales it down if it has more than
/// Image::kMaxPixels pixels or longer sides than Image allows. Clear parts of a PNG show `background`. Blocks while
/// the disk does; never waits for a pipe. Thread-safe: yes.
Result<std::shared_ptr<const look::Image>, Failure> read_picture(const std::filesystem::path& file,
                                                                 look::Color background);

/// The same of a file's bytes.
Result<look::Image, Failure> decoded_picture(std::span<const std::uint8_t> bytes, look::Color background);

}  // namespace yuragi::daemon::pictures
