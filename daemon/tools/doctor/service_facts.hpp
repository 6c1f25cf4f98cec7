#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace yuragi::daemon::tools::doctor {

// What rehearsal.hpp finds, and service_judgements.hpp judges for the user of a unit.

/// The service's use of a path.
enum class PathUse : std::uint8_t {
  kRead,        ///< a file
  kReadSecret,  ///< a file that no one else is to read
  kList,        ///< a folder
  kWriteFolder,
  kWriteFile,
  kDevice
};

/// A file, folder or device node, as stat() describes it.
struct Node {
  std::string path{};
  bool is_there = false;
  bool is_unseen = false;  ///< the caller may not look at it
  std::uint32_t mode = 0;  ///< permissions, as chmod has them
  std::uint32_t owner = 0;
  std::uint32_t group = 0;
  bool has_acl = false;       ///< further rights, which are not read
  bool is_read_only = false;  ///< its file system
  std::string group_name{};
  std::vector<std::string> device_classes{};  ///< of a device node, as DeviceAllow= names them: "char-ttyUSB"
};

/// A path that the configuration names.
struct PathFacts {
  std::string what{};  ///< "[http] token_file"
  PathUse use = PathUse::kRead;
  bool is_optional = false;     ///< the service makes it, or finds it later
  std::vector<Node> folders{};  ///< above it, from / on; of a link also those above what it leads to
  Node node{};
};

/// An address where the service is to listen.
struct ListenFacts {
  std::string what{};  ///< "[http] listen"
  std::string address{};
  std::uint16_t port = 0;
  std::string trouble{};                    ///< why nobody can listen there; empty: somebody can
  std::optional<std::uint32_t> listener{};  ///< the user id of the program that listens there
  bool is_own = false;                      ///< it is this daemon that listens there
  std::uint16_t first_unprivileged_port = 1024;
};

/// A program that a unit starts.
struct ProgramFacts {
  std::string path{};
  bool is_there = false;
  int exit_code = 0;   ///< of `--version`
  std::string text{};  ///< its output
};

/// A monitor that an [[output]] names.
struct MonitorFacts {
  std::string output{};
  std::string monitor{};                              ///< its name, or its number from 0
  std::optional<std::vector<std::string>> present{};  ///< nullopt: there is no display that could be asked
};

}  // namespace yuragi::daemon::tools::doctor
