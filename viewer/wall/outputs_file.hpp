#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/output/output.hpp"

namespace yuragi::viewer::wall {

/// Returns the output of this name in a configuration file; without a name the first. Nullopt if the file has no output
/// and no name was given. Throws FailureError: kNoInput if the file cannot be read, kBadData with each mistake in it,
/// kUsage with the names of its outputs if it has none of this name.
std::optional<output::Output> load_output(const std::filesystem::path& file, const std::string& name);

}  // namespace yuragi::viewer::wall
