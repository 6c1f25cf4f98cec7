#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "daemon/http/server.hpp"

namespace yuragi::daemon::web {

/// The folder of the guide that was installed with the running program (config/guide/make_html.py writes it).
std::filesystem::path installed_guide();

/// The guide as HTML, for the page's link. It is kept in memory, so that a disk that hangs delays no answer.
class Guide {
 public:
  Guide() = default;
  /// Reads the folder's pages and style sheet; a file that cannot be read is left out, and a folder that does not exist
  /// gives a guide without pages. Waits for the disk.
  explicit Guide(const std::filesystem::path& folder);

  /// Returns the page for a GET or HEAD of /guide/, or 404 with the reason; nullopt for all other paths. Pure.
  std::optional<http::Response> answer(const http::Request& request) const;

 private:
  std::map<std::string, std::string> files_;  // by their names
};

}  // namespace yuragi::daemon::web
