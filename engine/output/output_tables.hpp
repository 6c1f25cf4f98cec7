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

/// Every [[output]] of a configuration. What is wrong goes to `mistakes`.
std::vector<Table> read_outputs(const toml::table& root, tables::TomlMistakes& mistakes);

/// The outputs of a configuration's text; nothing else of it is looked at. Fails with every mistake, a line for each:
/// `source_name:line:column: key: what is wrong; what is allowed`.
Result<std::vector<Output>, Failure> parse_outputs(std::string_view toml_text, const std::string& source_name);

}  // namespace yuragi::output
