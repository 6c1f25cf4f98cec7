#include "daemon/tools/csv/csv_fields.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {

Result<RowSplitter, Failure> RowSplitter::make(const Layout& layout, const ImportOptions& options) {
  RowSplitter splitter(layout);
  for (const Condition& condition : options.conditions) {
    const auto found = std::ranges::find_if(
        layout.header, [&](const std::string& name) { return lower(name) == lower(condition.column); });
    if (found == layout.header.end()) {
      return Failure{fmt::format("--where: there is no column \"{}\"; the columns are {}", condition.column,
                                 fmt::join(layout.header, ", "))};
    }
    splitter.conditions_.emplace_back(found - layout.header.begin(), condition.value);
  }
  return splitter;
}

Result<bool, Failure> RowSplitter::split(std::span<char> line, Fields& fields) {
  if (!split_csv_line(line, layout_.delimiter, all_fields_)) return Failure{"a quote that is not closed"};
  const std::size_t count = layout_.header.size();
  if (all_fields_.size() < count) return Failure{"fewer fields than the header"};
  // A delimiter at the end of a line separates nothing.
  while (all_fields_.size() > count && all_fields_.back().empty()) all_fields_.pop_back();
  if (all_fields_.size() > count) return Failure{"more fields than the header"};
  for (const auto& [column, value] : conditions_) {
    if (all_fields_[column] != value) return false;
  }
  for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
    const auto& column = layout_.columns.by_role[role];
    if (column) fields.by_role[role] = all_fields_[column->index];
  }
  fields.time.clear();
  for (const std::size_t part : layout_.columns.time_parts) {
    if (!fields.time.empty()) fields.time += ' ';
    fields.time += all_fields_[part];
  }
  return true;
}

}  // namespace yuragi::daemon::tools::csv
