#pragma once

#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/wind/blend/gust_reach_fit.hpp"
#include "engine/wind/judging/group_gains.hpp"

namespace yuragi::daemon::shaping {

/// What has been learnt of a site.
struct SiteMemory {
  std::vector<double> times_s;  ///< SpeedMemory::times_s: of its wind
  /// SiteSpectrum::known_s and learnt_db: of its gusts. Empty in files of older versions.
  std::vector<double> octaves_known_s, octaves_db;
  /// How its sensors differ. Empty in files of older versions.
  wind::judging::LearntByName gains{};
  std::string gains_refusal{};  ///< why those of the file are not read; empty: they are
  /// The reach of its gusts; the default if the file has none.
  wind::blend::GustReach reach{};
  std::string reach_refusal{};  ///< why that of the file is not read; empty: it is
};

/// Keeps a SiteMemory in a small JSON file.
class SiteFile {
 public:
  explicit SiteFile(std::filesystem::path file) : file_(std::move(file)) {}

  const std::filesystem::path& path() const noexcept { return file_; }

  /// Reads the file. Checks only that the values are numbers. The gains of sensors and the reach of gusts are left out
  /// if they are wrong: the site's wind is worth more than they are.
  Result<SiteMemory, Failure> read() const;

  /// Renames a file that cannot be read as one, so that save() does not overwrite it: FILE.unreadable, or, if there is
  /// one already, FILE.unreadable-2 and so on. Returns the new name, or why it could not be renamed.
  Result<std::filesystem::path, Failure> set_aside() const;

  /// Writes the file on a thread of its own, as a whole or not at all. Precondition: not is_writing().
  void save(SiteMemory memory);
  bool is_writing() const;

  /// Waits until it is written. Returns the failure, once; its text is empty if there was none.
  Failure wait();

 private:
  std::filesystem::path file_;
  std::future<Failure> writing_;
};

}  // namespace yuragi::daemon::shaping
