#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::doctor {

/// The path of a program beside this one, or in the system's own folders, or an absolute path; nullopt if there is
/// none.
std::optional<std::string> find_program(const std::string& name);

struct ProgramOutput {
  std::string text;    ///< standard output and error
  int exit_code = -1;  ///< -1: it was ended because it took too long or printed too much
};

/// Runs a program of the system, found in the system's own folders or beside this program, without a shell's
/// expansion of its arguments, and returns its output, at most `most_bytes` of it; nullopt if there is no such
/// program. Waits for `timeout` at most.
std::optional<ProgramOutput> program_output(std::vector<std::string> command, Nanoseconds timeout,
                                            std::size_t most_bytes = 4'000'000);

}  // namespace yuragi::daemon::tools::doctor
