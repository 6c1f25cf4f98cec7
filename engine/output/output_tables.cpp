#include "engine/output/output_tables.hpp"

#include <algorithm>
#include <utility>

#include "engine/tables/parse_toml.hpp"

namespace yuragi::output {
namespace {

constexpr std::string_view kNameKey = "name";

/// Takes a value made from a table; an error is reported at its key.
template <class Made>
Made taken(Result<Made, ParameterError> made, const toml::table& table, const std::string& prefix,
           tables::TomlMistakes& mistakes) {
  if (made) return std::move(*made);
  const toml::node* const node = table.get(made.error().name);
  mistakes.add(node != nullptr ? node->source() : table.source(), prefix + made.error().name, made.error().message);
  return {};
}

Table read_output(const toml::table& entry, tables::TomlMistakes& mistakes) {
  const std::string prefix = std::string(kOutputList) + ".";
  std::string name = tables::read_name(entry, prefix, Output().name, mistakes);
  Table table;
  table.values = tables::read_values(entry, prefix, output_parameters(), {kNameKey, kWindowList}, mistakes);
  table.output = taken(output_of(std::move(name), table.values), entry, prefix, mistakes);

  const std::string windows = prefix + std::string(kWindowList);
  for (const toml::table* window : tables::entries_of(entry, kWindowList, windows, kMaxWindows, mistakes)) {
    table.windows.push_back(tables::read_values(*window, windows + ".", window_parameters(), {}, mistakes));
    table.output.windows.push_back(taken(window_of(table.windows.back()), *window, windows + ".", mistakes));
    const std::string& monitor = table.output.windows.back().monitor;
    const auto same = std::ranges::count(table.output.windows, monitor, &Window::monitor);
    if (same > 1) {
      mistakes.add(window->source(), windows + ".monitor",
                   monitor.empty() ? "is missing; only one window can be on the primary monitor"
                                   : "\"" + monitor + "\" is used by another window, too");
    }
  }
  if (table.output.windows.empty()) table.output.windows.emplace_back();
  return table;
}

}  // namespace

std::vector<Table> read_outputs(const toml::table& root, tables::TomlMistakes& mistakes) {
  std::vector<Table> outputs;
  for (const toml::table* entry :
       tables::entries_of(root, kOutputList, std::string(kOutputList), kMaxOutputs, mistakes)) {
    Table read = read_output(*entry, mistakes);
    const auto has_its_name = [&read](const Table& other) { return other.output.name == read.output.name; };
    if (std::ranges::any_of(outputs, has_its_name)) {
      const toml::node* const name = entry->get(kNameKey);
      mistakes.add(name != nullptr ? name->source() : entry->source(), "output.name",
                   "\"" + read.output.name + "\" is used twice; give each output a name");
    }
    outputs.push_back(std::move(read));
  }
  return outputs;
}

Result<std::vector<Output>, Failure> parse_outputs(std::string_view toml_text, const std::string& source_name) {
  tables::TomlMistakes mistakes(source_name);
  std::vector<Output> outputs;
  try {
    const toml::table root = tables::parse_toml(toml_text, source_name);
    for (Table& table : read_outputs(root, mistakes)) outputs.push_back(std::move(table.output));
  } catch (const toml::parse_error& error) {
    mistakes.add(error.source(), "TOML", std::string(error.description()));
  }
  if (!mistakes.empty()) return Failure{mistakes.text(), FailureKind::kBadData};
  return outputs;
}

}  // namespace yuragi::output
