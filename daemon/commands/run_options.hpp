#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/settings/config.hpp"

namespace yuragi {

/// The options that `run`, `record`, `replay` and `sensors watch` share.
struct RunOptions {
  std::optional<std::filesystem::path> config_file;
  std::optional<std::string> address;  ///< of the daemon; empty: the configured one
  std::optional<double> duration_s;
  bool verbose = false;

  /// Adds --config, --duration, --verbose, and --listen: for a command that is the daemon.
  void add_to(CLI::App& command);

  /// The same with --connect: for a command that asks a running daemon.
  void add_to_client(CLI::App& command);

  /// The configuration that they name, or the default one. Throws ConfigError.
  Config config() const;

  /// Sends the log to standard error, in the form that a journal and a person can read.
  void set_up_log() const;

 private:
  void add_common(CLI::App& command);
};

/// Adds --connect, where a running daemon is, and the old name that it had, --listen, which is understood with a note.
void add_connect(CLI::App& command, std::optional<std::string>& address);

/// What an option's text has to go through to be read as seconds: 90, 90s, 5min, 2h.
CLI::Validator duration_in_seconds();

}  // namespace yuragi
