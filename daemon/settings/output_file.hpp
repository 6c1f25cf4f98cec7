#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi {

/// A file that is there as a whole or not at all: it is written under another name beside its own, and takes its own
/// name with commit(). Without that it is removed.
class OutputFile {
 public:
  /// A link is followed. `side_suffixes`: how the names end of what a library keeps beside such a file while it is
  /// being recorded (windlog::kSideSuffixes); they must live as long as this, and are removed with an unfinished file.
  /// Throws FailureError (kCannotCreate) where the file exists already and `force` is false, where it is not a regular
  /// file, where one of those exists beside it (it is being recorded, or was, when its recorder was killed), or where
  /// its folder does not exist.
  OutputFile(std::filesystem::path file, bool force, std::span<const std::string_view> side_suffixes = {});
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write.
  const std::filesystem::path& working_path() const { return working_path_; }

  /// Gives the file its name, or says why that failed.
  Result<void, Failure> commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path working_path_;
  std::span<const std::string_view> side_suffixes_;
};

}  // namespace yuragi
