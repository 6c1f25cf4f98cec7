#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/output/output.hpp"

namespace yuragi::viewer::wall {

/// The output of this name in a configuration file; without a name the first. Nothing where the file has no output and
/// none was asked for. Throws FailureError: kNoInput where the file cannot be read, kBadData with each mistake in it,
/// kUsage where it has no output of this name, with those that it has.
std::optional<output::Output> load_output(const std::filesystem::path& file, const std::string& name);

}  // namespace yuragi::viewer::wall
