#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::commands {

/// The options that `run`, `record`, `replay` and `sensors watch` share.
struct RunOptions {
  std::optional<std::filesystem::path> config_file;
  std::optional<std::string> address;  ///< of the daemon; empty: the configured one
  std::optional<double> duration_s;
  bool verbose = false;

  /// Adds --config, --duration, --verbose, and --listen: for a command that is the daemon.
  void add_to(CLI::App& command);

  /// The same with --connect instead of --listen: for a command that is a client of the daemon.
  void add_to_client(CLI::App& command);

  /// The configuration given by them, with what the page has set up, or the default one. Throws ConfigError.
  settings::Config config() const;
  /// The same without what the page has set up.
  settings::Config config_without_page() const;

 private:
  void add_common(CLI::App& command);
};

/// Adds --connect, the address of a running daemon, and --listen, its former name, which is accepted with a note.
void add_connect(CLI::App& command, std::optional<std::string>& address);

/// The CLI transform that reads a duration in seconds: 90, 90s, 5min, 2h.
CLI::Validator duration_in_seconds();

/// The configuration of a command that starts no daemon: of its file, with what the page has set up, or the built-in
/// one. What the page has set up and cannot be used is named on standard error.
settings::Config configuration_of(const std::optional<std::filesystem::path>& file);

}  // namespace yuragi::daemon::commands
