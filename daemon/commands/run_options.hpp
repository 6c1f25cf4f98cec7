#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/settings/config.hpp"

namespace yuragi {

/// What `run`, `record`, `replay` and `sensors watch` ask for alike.
struct RunOptions {
  std::optional<std::filesystem::path> config_file;
  std::optional<std::string> listen;
  std::optional<double> duration_s;
  bool verbose = false;

  /// Adds --config, --listen, --duration and --verbose.
  void add_to(CLI::App& command);

  /// The configuration that they name, or the default one. Throws ConfigError.
  Config config() const;

  /// Sends the log to standard error, in the form that a journal and a person can read.
  void set_up_log() const;
};

}  // namespace yuragi
