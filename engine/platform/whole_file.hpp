#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi::platform {

/// A file that is created as a whole or not at all: it is written under a temporary name in the same folder, and
/// renamed by commit(). Without a commit() it is removed.
class OutputFile {
 public:
  /// A link is followed. `side_suffixes`: suffixes of the files that SQLite keeps beside it while it is open
  /// (windlog::kSideSuffixes); they must outlive this object, and these files are removed with an unfinished file.
  /// Throws FailureError (kCannotCreate) if the file exists already and `force` is false, if it is not a regular file,
  /// if a file with such a suffix exists beside it (it is being recorded, or its recorder was killed), or if its folder
  /// does not exist.
  OutputFile(std::filesystem::path file, bool force, std::span<const std::string_view> side_suffixes = {});
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write.
  const std::filesystem::path& working_path() const { return working_path_; }

  /// Renames the file to its final name; the failure has the reason if that is not possible.
  Result<void, Failure> commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path working_path_;
  std::span<const std::string_view> side_suffixes_;
};

/// Reads a regular file of at most `most_bytes`. Waits only for the disk: a pipe is refused. The failure begins with a
/// verb ("does not exist", "is too large; allowed: up to 4096 bytes"), because the caller adds the file's name.
Result<std::string, Failure> read_whole(const std::filesystem::path& file, std::size_t most_bytes);

/// Writes a file whole or not at all, replacing an existing one. `permissions`: who may read and write it, at any
/// moment; nullopt: by the process's umask. The failure names the file. Throws like OutputFile.
Result<void, Failure> write_whole(const std::filesystem::path& file, std::string_view text,
                                  std::optional<std::filesystem::perms> permissions = std::nullopt);

}  // namespace yuragi::platform
