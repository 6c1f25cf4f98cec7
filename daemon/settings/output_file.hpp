#pragma once

#include <filesystem>

#include "engine/base/result.hpp"

namespace yuragi {

/// A file that is there as a whole or not at all: it is written under another name beside its own, and takes its own
/// name with commit(). Without that it is removed.
class OutputFile {
 public:
  /// Throws FailureError (kCannotCreate) where the file exists already and `force` is false, where it is a recording
  /// that is being written (or was, when its recorder was killed), or where its folder does not exist.
  OutputFile(std::filesystem::path file, bool force);
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
};

}  // namespace yuragi
