#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace yuragi::daemon::commands {

/// Adds --json, for a command that prints a table: the same, and the numbers behind it, for a program to read.
void add_json(CLI::App& command, bool& as_json);

// Write to standard output at once. What is not UTF-8 is replaced. Throw FailureError if that fails.

/// Over several lines, indented.
void print_json(const nlohmann::ordered_json& json);

/// On one line, for commands that continue.
void print_json_line(const nlohmann::ordered_json& json);

}  // namespace yuragi::daemon::commands
