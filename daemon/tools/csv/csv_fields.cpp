#include "daemon/tools/csv/csv_fields.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

bool are_digits(std::string_view text, std::size_t most) {
  return !text.empty() && text.size() <= most && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Appends a part, so that the whole is a time in ISO 8601: "2018", "2018-291", "2018-291 01:05".
void append_time_part(std::string& time, TimePartForm form, std::string_view text) {
  if (form == TimePartForm::kDayOfYear && are_digits(text, 3)) {
    time += '-';
    time.append(3 - text.size(), '0');
    time += text;
    return;
  }
  if (!time.empty()) time += ' ';
  if (form == TimePartForm::kHoursAndMinutes && are_digits(text, 4)) {
    constexpr std::size_t kDigits = 4;
    const std::size_t begin = time.size();
    time.append(kDigits - text.size(), '0');
    time += text;
    time.insert(begin + 2, ":");
    return;
  }
  time += text;
}

}  // namespace

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

Result<bool, RowRefusal> RowSplitter::split(std::span<char> line, Fields& fields) {
  if (!split_csv_line(line, layout_.delimiter, all_fields_)) return RowRefusal{"a quote that is not closed"};
  const std::size_t count = layout_.header.size();
  if (all_fields_.size() < count) return RowRefusal{"fewer fields than the header"};
  // A delimiter at the end of a line separates nothing.
  while (all_fields_.size() > count && all_fields_.back().empty()) all_fields_.pop_back();
  if (all_fields_.size() > count && !layout_.may_rows_be_longer) return RowRefusal{"more fields than the header"};
  for (const auto& [column, value] : conditions_) {
    if (all_fields_[column] != value) return false;
  }
  for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
    const auto& column = layout_.columns.by_role[role];
    if (column) fields.by_role[role] = all_fields_[column->index];
  }
  fields.time.clear();
  for (const TimePart& part : layout_.columns.time_parts)
    append_time_part(fields.time, part.form, all_fields_[part.column]);
  return true;
}

}  // namespace yuragi::daemon::tools::csv
