#include "engine/tables/toml_values.hpp"

namespace yuragi::tables {

void TomlMistakes::add(const toml::source_region& where, const std::string& key, const std::string& what) {
  text_.append(text_.empty() ? "" : "\n").append(place(where)).append(": ").append(key).append(": ").append(what);
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

}  // namespace yuragi::tables
