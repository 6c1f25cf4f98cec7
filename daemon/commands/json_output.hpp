#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "daemon/settings/standard_output.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::commands {

/// Adds --json, for a command that prints a table: the same, and the numbers behind it, for a program to read.
inline void add_json(CLI::App& command, bool& as_json) {
  command.add_flag("--json", as_json, "print it as JSON");
}

// Write to standard output at once. What is not UTF-8 is replaced. Throw FailureError if that fails.

/// Over several lines, indented.
inline void print_json(const nlohmann::ordered_json& json) {
  settings::write_at_once(json_text(json, 2) + "\n");
}

/// On one line, for commands that continue.
inline void print_json_line(const nlohmann::ordered_json& json) {
  settings::write_at_once(json_text(json) + "\n");
}

}  // namespace yuragi::daemon::commands
