#include "engine/tables/toml_values.hpp"

#include "engine/base/printable_text.hpp"

namespace yuragi::tables {

void TomlMistakes::add(const toml::source_region& where, const std::string& key, const std::string& what) {
  std::string mistake = key + ": " + what;
  make_printable(mistake);
  text_.append(text_.empty() ? "" : "\n").append(place(where)).append(": ").append(mistake);
}

std::string TomlMistakes::place(const toml::source_region& where) const {
  return source_name_ + ':' + std::to_string(where.begin.line) + ':' + std::to_string(where.begin.column);
}

std::optional<ParameterValue> parameter_value_of(const toml::node& node) {
  if (const auto* flag = node.as_boolean()) return ParameterValue(flag->get());
  if (const auto* whole = node.as_integer()) return ParameterValue(whole->get());
  if (const auto* number = node.as_floating_point()) return ParameterValue(number->get());
  if (const auto* text = node.as_string()) return ParameterValue(text->get());
  return std::nullopt;
}

ParameterValues read_values(const toml::table& table, const std::string& prefix, std::span<const Parameter> parameters,
                            const std::set<std::string_view>& aside, TomlMistakes& mistakes) {
  // One key at a time, so that each error is reported at its own place.
  ParameterValues::Map good;
  for (const auto& [key, node] : table) {
    if (aside.contains(key.str())) continue;
    const std::optional<ParameterValue> value = parameter_value_of(node);
    if (!value) {
      mistakes.add(node.source(), prefix + std::string(key.str()), "takes one value: true, a number or a text");
      continue;
    }
    const ParameterValues::Map one{{std::string(key.str()), *value}};
    if (auto checked = ParameterValues::resolve(parameters, one); !checked) {
      mistakes.add(node.source(), prefix + checked.error().name, checked.error().message);
    } else {
      good.insert(one.begin(), one.end());
    }
  }
  return ParameterValues::resolve(parameters, good).value();
}

std::string read_name(const toml::table& entry, const std::string& prefix, std::string otherwise,
                      TomlMistakes& mistakes) {
  constexpr std::size_t kMaxName_bytes = 64;
  const toml::node* const node = entry.get("name");
  if (node == nullptr) return otherwise;
  const auto name = node->value<std::string>();
  if (!name || name->empty() || name->size() > kMaxName_bytes) {
    mistakes.add(node->source(), prefix + "name", "takes a text of 1 to 64 characters");
    return otherwise;
  }
  if (!is_printable(*name)) {
    mistakes.add(node->source(), prefix + "name", "\"" + *name + "\" has a control character in it; type it anew");
    return otherwise;
  }
  return *name;
}

std::vector<const toml::table*> entries_of(const toml::table& around, std::string_view key, const std::string& path,
                                           std::size_t most, TomlMistakes& mistakes) {
  std::vector<const toml::table*> entries;
  const toml::node* const node = around.get(key);
  if (node == nullptr) return entries;
  const toml::array* const list = node->as_array();
  if (list == nullptr || !(list->empty() || list->is_array_of_tables())) {
    mistakes.add(node->source(), path, "is one table; write [[" + path + "]] above it");
    return entries;
  }
  if (list->size() > most) {
    mistakes.add(list->get(most)->source(), path,
                 "too many: " + std::to_string(list->size()) + " (maximum " + std::to_string(most) + ")");
    return entries;
  }
  for (const toml::node& entry : *list) entries.push_back(entry.as_table());
  return entries;
}

}  // namespace yuragi::tables
