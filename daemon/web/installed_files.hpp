#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "daemon/http/server.hpp"

namespace yuragi::daemon::web {

/// The folder `name` of what was installed with the running program: share/yuragi/NAME beside its bin.
std::filesystem::path installed_folder(const std::string& name);

/// The files of a folder under one path: pages, styles, scripts and WebAssembly. They are kept in memory, so that a
/// disk that hangs delays no answer. NAME.br and NAME.gz are NAME, compressed, for clients that take it.
class InstalledFiles {
 public:
  /// `path`: "/guide/". `what`: for a person: "the guide". `remedy`: what to do where nothing is installed.
  struct Place {
    std::string path = {};
    std::string what = {};
    std::string remedy = {};
  };

  /// Reads them; a file that cannot be read is left out, and a folder that does not exist gives none. Waits for the
  /// disk.
  InstalledFiles(Place place, const std::filesystem::path& folder);

  /// Returns the file for a GET or HEAD of a path below the place's, or 404 with the reason; nullopt for all other
  /// paths. The path itself is index.html. Pure.
  std::optional<http::Response> answer(const http::Request& request) const;

 private:
  struct File {
    std::string text = {};
    std::string entity_tag = {};
  };
  const File* find(const std::string& name) const;

  Place place_;
  std::map<std::string, File> files_;  // by their names
};

}  // namespace yuragi::daemon::web
