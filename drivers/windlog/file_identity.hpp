#pragma once

#include <cstdint>
#include <filesystem>
#include <system_error>

#include "engine/base/result.hpp"

namespace yuragi::drivers::windlog {

/// Which file a name refers to. Another file that takes over the name differs, as long as the first exists or is open.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  bool operator==(const FileIdentity&) const = default;
};

/// The error is why the name cannot be looked up. Follows symbolic links. Never throws.
Result<FileIdentity, std::error_code> identity_of(const std::filesystem::path& file) noexcept;

}  // namespace yuragi::drivers::windlog
