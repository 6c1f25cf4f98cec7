#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "daemon/http/server.hpp"

namespace yuragi::daemon::web {

/// Where the folder of own pages is served.
inline constexpr std::string_view kSitePath = "/site/";

/// Returns true for kSitePath, what is below it, and it without its last slash. Pure.
bool is_of_site(std::string_view path);

/// A larger file of the folder is refused.
inline constexpr std::size_t kMaxSiteFile_bytes = 8UL << 20;

/// Reads the file of `folder` that a GET or HEAD of /site/... asks for. Names that begin with a dot, "..", links that
/// leave the folder, what is no regular file, and files that are too large are refused. A folder is answered with its
/// index.html. Scripts, styles and data may come from this daemon only (Content-Security-Policy). Waits for the disk.
http::Response site_response(const std::filesystem::path& folder, const http::Request& request);

/// The folder of own pages: each request is answered from the disk, on a thread of its own, so that a disk that hangs
/// delays no other answer. Thread-safe: no.
class Site {
 public:
  /// Further requests are refused (503) while so many wait for the disk.
  static constexpr std::size_t kMaxWaiting = 32;

  /// `folder`: empty: nothing is served, which each answer reports.
  explicit Site(std::filesystem::path folder);
  ~Site();
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  /// Calls `reply` once, at once or on the thread; never after a disk that hangs for ever.
  void answer(const http::Request& request, std::function<void(http::Response)> reply);

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;  ///< null: nothing is served
};

}  // namespace yuragi::daemon::web
