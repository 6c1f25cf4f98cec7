#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace yuragi::daemon::tools::offline {

/// Writes float32 values of the given shape (C order: the last index runs fastest) as a NumPy file, format 1.0,
/// little-endian.
///
/// The file is created as a whole or not at all (OutputFile). The product of the shape must be the number of values
/// (std::logic_error). Throws FailureError (kCannotCreate) when it cannot be written, or exists and is not a regular
/// file. Source: NEP 1, "A simple file format for NumPy arrays".
void write_npy(const std::filesystem::path& file, std::span<const std::size_t> shape, std::span<const float> values);

/// The header of such a file, for writing it piece by piece: the values follow as they are in memory.
std::string npy_header(std::span<const std::size_t> shape);

}  // namespace yuragi::daemon::tools::offline
