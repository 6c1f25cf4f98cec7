#pragma once

#include <filesystem>
#include <future>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi {

/// What is remembered of a site.
struct SiteMemory {
  std::vector<double> times_s;  ///< SpeedMemory::times_s: of its wind
  /// SiteSpectrum::known_s and learnt_db: of its gusts. Empty in a file of before they were learnt.
  std::vector<double> octaves_known_s, octaves_db;
};

/// A site's memory as a small JSON file.
class SiteFile {
 public:
  explicit SiteFile(std::filesystem::path file) : file_(std::move(file)) {}

  const std::filesystem::path& path() const noexcept { return file_; }

  /// What was written; nothing is checked but that it is numbers. A Failure says what is wrong.
  Result<SiteMemory, Failure> read() const;

  /// Writes the file on a thread of its own, as a whole or not at all; not while it is_writing().
  void save(SiteMemory memory);
  bool is_writing() const;

  /// Waits until it is written; what went wrong, if anything did. Told once.
  Failure wait();

 private:
  std::filesystem::path file_;
  std::future<Failure> writing_;
};

}  // namespace yuragi
