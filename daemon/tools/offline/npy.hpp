#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace yuragi {

/// Writes float32 values of the given shape (C order: the last index runs fastest) as a NumPy file, format 1.0,
/// little-endian.
///
/// The file appears whole or not at all (OutputFile). The product of the shape must be the number of values
/// (std::logic_error). Throws FailureError (kCannotCreate) when it cannot be written, or when something that is not a
/// regular file has its name. Source: NEP 1, "A simple file format for NumPy arrays".
void write_npy(const std::filesystem::path& file, std::span<const std::size_t> shape, std::span<const float> values);

/// How such a file begins, for whoever writes the values piece by piece: what follows are they, as they stand in
/// memory.
std::string npy_header(std::span<const std::size_t> shape);

}  // namespace yuragi
