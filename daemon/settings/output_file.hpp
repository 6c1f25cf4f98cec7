#pragma once

#include <filesystem>

namespace yuragi {

/// A file that is there as a whole or not at all: it is written under another name beside its own, and takes its own
/// name with commit(). Without that it is removed.
class OutputFile {
 public:
  /// Throws ExitError where the file is there already and `force` is false, where it is a recording that somebody is
  /// writing (or was, when it was killed), or where its folder is not there.
  OutputFile(std::filesystem::path file, bool force);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write.
  const std::filesystem::path& working_path() const { return working_path_; }

  /// Gives the file its name. Throws ExitError.
  void commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path working_path_;
};

}  // namespace yuragi
