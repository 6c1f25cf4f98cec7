#pragma once

#include <filesystem>
#include <future>
#include <span>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi {

/// What is remembered of a site's wind (SpeedMemory::times_s), as a small JSON file.
class SiteFile {
 public:
  explicit SiteFile(std::filesystem::path file) : file_(std::move(file)) {}

  const std::filesystem::path& path() const noexcept { return file_; }

  /// The times as they were written; nothing but numbers is checked. A Failure says what is wrong.
  Result<std::vector<double>, Failure> read() const;

  /// Writes the file on a thread of its own, as a whole or not at all; not while it is_writing().
  void save(std::span<const double> times_s);
  bool is_writing() const;

  /// Waits until it is written; what went wrong, if anything did. Told once.
  Failure wait();

 private:
  std::filesystem::path file_;
  std::future<Failure> writing_;
};

}  // namespace yuragi
