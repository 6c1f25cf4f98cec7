#pragma once

#include <atomic>
#include <cstdint>
#include <span>

namespace yuragi::viewer::film {

/// Writes all of `bytes`, and waits for space until `is_stopping` is set. Returns 0, an errno, or ECANCELED if it was
/// set.
int write_all(int fd, std::span<const std::uint8_t> bytes, const std::atomic<bool>& is_stopping);

}  // namespace yuragi::viewer::film
