#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/settings/config.hpp"
#include "daemon/tools/doctor/doctor.hpp"

namespace yuragi::daemon::commands {

/// Adds --config, of which `installed_config()` makes the file.
void add_installation_config(CLI::App& command, std::optional<std::filesystem::path>& file);

/// Adds --connect.
void add_daemon_address(CLI::App& command, std::optional<std::string>& address);

/// The configuration that a command for the technician is about: the given one, else that of the service if this
/// user can read it, else none (the built-in one).
std::optional<std::filesystem::path> installed_config(const std::optional<std::filesystem::path>& given);

/// What `doctor` examines: that configuration, its errors, and the daemon that listens at its address, or at `address`.
/// `client`: the name of the command in the daemon's log.
tools::doctor::Examination examination_of(const std::optional<std::filesystem::path>& given,
                                          const std::optional<std::string>& address, const std::string& client);

}  // namespace yuragi::daemon::commands
