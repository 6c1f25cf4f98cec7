#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "engine/base/parameter.hpp"

namespace yuragi::tables {

/// Collects the mistakes in a file, one line each: `file:line:column: key: what is wrong; what is allowed`. Control
/// characters of the file are shown as question marks.
class TomlMistakes {
 public:
  /// `source_name`: the file's name in the lines.
  explicit TomlMistakes(std::string source_name) : source_name_(std::move(source_name)) {}

  void add(const toml::source_region& where, const std::string& key, const std::string& what);

  /// `file:line:column`.
  std::string place(const toml::source_region& where) const;

  bool empty() const { return text_.empty(); }
  const std::string& text() const { return text_; }

 private:
  std::string source_name_;
  std::string text_;
};

/// A TOML value as a parameter's value; nullopt for dates, arrays and tables, which no parameter has.
std::optional<ParameterValue> parameter_value_of(const toml::node& node);

/// The values of one table, except the keys in `aside`; `prefix` ("look.") precedes a key in mistakes. Wrong values are
/// reported to `mistakes`, and treated as missing.
ParameterValues read_values(const toml::table& table, const std::string& prefix, std::span<const Parameter> parameters,
                            const std::set<std::string_view>& aside, TomlMistakes& mistakes);

/// The `name` of an entry of a list: 1 to 64 bytes without control characters. `otherwise` if it is missing, or refused
/// as a mistake. `prefix` ("scene.") precedes the key in mistakes.
std::string read_name(const toml::table& entry, const std::string& prefix, std::string otherwise,
                      TomlMistakes& mistakes);

/// The tables of a list, in order, by pointer: a copy of a TOML table loses its lines and columns. It is a mistake if
/// `key` is not a list of tables, or has more than `most`; then the result is empty. `path` ("output.window") is the
/// name in mistakes.
std::vector<const toml::table*> entries_of(const toml::table& around, std::string_view key, const std::string& path,
                                           std::size_t most, TomlMistakes& mistakes);

}  // namespace yuragi::tables
