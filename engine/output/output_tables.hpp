#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/output/output.hpp"
#include "engine/tables/toml_values.hpp"

namespace yuragi::output {

inline constexpr std::string_view kOutputList = "output";
inline constexpr std::string_view kWindowList = "window";

/// Reads every [[output]] of a configuration. Errors go to `mistakes`.
std::vector<Table> read_outputs(const toml::table& root, tables::TomlMistakes& mistakes);

/// The outputs of a configuration's text; the rest is ignored. Fails with every mistake, one line each:
/// `source_name:line:column: key: what is wrong; what is allowed`.
Result<std::vector<Output>, Failure> parse_outputs(std::string_view toml_text, const std::string& source_name);

}  // namespace yuragi::output
