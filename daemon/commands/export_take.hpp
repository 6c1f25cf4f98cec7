#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace yuragi::daemon::commands {

/// The options of a take: one scene's motion as a file for 3D programs.
struct TakeOptions {
  std::optional<std::filesystem::path> config_file = {};
  std::string scene = {};  ///< its name; empty: the only one besides the ground
  double fps = 30.0;
  std::optional<double> duration_s = {};
  std::optional<std::size_t> every = {};  ///< of strands and leaves; nullopt: as few as possible are left out

  void add_to(CLI::App& command);
};

/// Runs a recording through wind and scenes in lock-step, from `start` on (seconds, or a moment), and writes a scene's
/// motion to `output`. Throws ExitError and FailureError.
void export_take(const TakeOptions& options, const std::filesystem::path& recording, const std::string& start,
                 const std::filesystem::path& output, bool force);

}  // namespace yuragi::daemon::commands
