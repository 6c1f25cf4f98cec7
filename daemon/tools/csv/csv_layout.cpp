#include "daemon/tools/csv/csv_layout.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>

#include "daemon/tools/csv/csv_known_tables.hpp"
#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/csv_names.hpp"
#include "daemon/tools/csv/csv_value.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

char delimiter_of(std::string_view header) {
  char best = ',';
  for (const char candidate : {';', '\t', '|'}) {
    if (std::ranges::count(header, candidate) > std::ranges::count(header, best)) best = candidate;
  }
  if (header.find(best) != std::string_view::npos) return best;
  return without_blanks(header).find(' ') == std::string_view::npos ? ',' : ' ';
}

bool is_number_or_date(std::string_view text) {
  return parse_decimal(text, 0).has_value() || has_date(text);
}

/// The first field that no header has: a number, a date, or one of several bytes of a dump ("3b A0 FF"; "D1" alone can
/// be a name). Nullopt: there is none.
std::optional<std::string_view> data_in(const std::vector<std::string>& fields) {
  const auto found = std::ranges::find_if(fields, is_number_or_date);
  if (found != fields.end()) return *found;
  const auto is_byte = [](std::string_view text) {
    return text.size() == 2 && text.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
  };
  constexpr std::ptrdiff_t kMinBytes = 4;
  const auto bytes = std::ranges::count_if(fields, is_byte);
  if (bytes < kMinBytes || 2 * bytes < static_cast<std::ptrdiff_t>(fields.size())) return std::nullopt;
  return *std::ranges::find_if(fields, is_byte);
}

/// A line without its comment sign.
std::string_view uncommented(std::string_view line, char comment) {
  while (comment != 0 && line.starts_with(comment)) line.remove_prefix(1);
  return without_blanks(line);
}

/// Zone and unit of speeds that the lines before a header name.
struct Preamble {
  std::optional<std::string> zone;
  std::optional<Unit> speed_unit;
};

void read_key(Preamble& preamble, std::string_view key, std::string_view value) {
  const std::string stem = joined(words_of(key));
  value = without_blanks(value);
  if (value.empty()) return;
  if (stem == "utcoffsetseconds") {
    if (const auto seconds = parse_decimal(value, 0)) {
      const std::int64_t minutes = std::abs(*seconds) / 60;
      const auto two = [](std::int64_t number) { return (number < 10 ? "0" : "") + std::to_string(number); };
      preamble.zone = (*seconds < 0 ? "-" : "+") + two(minutes / 60) + ":" + two(minutes % 60);
    }
  } else if ((stem == "timezone" || stem == "utcoffset" || stem == "zeitzone") && !preamble.zone) {
    std::string zone(value);
    // Hours alone: "-7".
    if (parse_decimal(zone, 0) && zone.find('.') == std::string::npos) {
      const bool has_sign = zone.starts_with('-') || zone.starts_with('+');
      zone = (has_sign ? zone.substr(0, 1) : "+") + (zone.size() - (has_sign ? 1 : 0) < 2 ? "0" : "") +
             zone.substr(has_sign ? 1 : 0);
    }
    if (Zone::parse(zone)) preamble.zone = zone;
  } else if (stem.starts_with("windspeed") || stem == "windunit") {
    if (const auto unit = find_speed_unit(value)) preamble.speed_unit = unit;
  }
}

/// "FH : hourly mean wind speed (in 0.1 m/s)" gives the unit of a column.
void read_legend(Columns& columns, std::string_view key, std::string_view text) {
  for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
    auto& column = columns.by_role[role];
    if (!column || lower(column->name) != lower(without_blanks(key))) continue;
    const auto open = text.find_last_of("([");
    if (open == std::string_view::npos) return;
    std::string_view unit = text.substr(open + 1);
    unit = unit.substr(0, unit.find_first_of(")]"));
    if (unit.starts_with("in ")) unit.remove_prefix(3);
    if (const auto found = find_unit(dimension_of(static_cast<Role>(role)), unit)) {
      column->unit = found;
      column->unit_source = "from the lines before the header";
    }
  }
}

class LayoutSearch {
 public:
  LayoutSearch(const std::vector<std::string>& lines, const ImportOptions& options)
      : lines_(lines), options_(options) {}

  Result<Layout, Failure> find() const {
    const std::size_t begin = next_line(options_.skip.value_or(0), false);
    if (begin >= lines_.size()) return Failure{"has no header line"};
    if (!options_.header.empty()) return layout_of_names(begin, options_.header);
    if (!options_.skip) {
      if (auto known = find_known_table(lines_)) return layout_of_known(*known);
    }
    auto first = layout_at(begin, fields_of(lines_[begin], delimiter(lines_[begin])), false);
    if (options_.skip || (first && has_fitting_row(*first))) return first;

    // In its order: a line, two lines, a comment. The first whose rows do not fit comes last.
    std::optional<Layout> unfitting;
    const auto keep = [&unfitting](Layout found) {
      if (!unfitting) unfitting = std::move(found);
    };
    if (first) keep(*first);
    for (std::size_t i = next_line(begin + 1, false); i < lines_.size(); i = next_line(i + 1, false)) {
      auto found = layout_at(i, fields_of(lines_[i], delimiter(lines_[i])), false);
      if (found && has_fitting_row(*found)) return found;
      if (found) keep(std::move(*found));
      auto of_two = layout_of_two(i);
      if (of_two && has_fitting_row(*of_two)) return std::move(*of_two);
    }
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!is_comment(lines_[i])) continue;
      const std::string_view text = uncommented(lines_[i], options_.comment);
      if (text.empty()) continue;
      auto found = layout_at(i, fields_of(text, delimiter(text)), true);
      if (found && found->row.size() == found->header.size()) return found;
    }
    if (unfitting) return std::move(*unfitting);
    return failure_of(begin, first.error());
  }

 private:
  bool is_comment(std::string_view line) const { return options_.comment != 0 && line.starts_with(options_.comment); }

  /// The next line from `i` on that is not empty; with `are_comments_taken`, be it a comment.
  std::size_t next_line(std::size_t i, bool are_comments_taken) const {
    while (i < lines_.size() && (without_blanks(lines_[i]).empty() || (!are_comments_taken && is_comment(lines_[i]))))
      ++i;
    return i;
  }

  char delimiter(std::string_view line) const {
    return options_.delimiter != 0 ? options_.delimiter : delimiter_of(line);
  }

  Result<Layout, Failure> layout_at(std::size_t i, std::vector<std::string> header, bool is_comment_header) const {
    if (header.empty()) return Failure{"the header has a quote that is not closed"};
    if (const auto data = data_in(header)) {
      return Failure{fmt::format("line {} is no header, because it has \"{}\"", i + 1, *data)};
    }
    Layout layout;
    const std::string_view text = is_comment_header ? uncommented(lines_[i], options_.comment) : lines_[i];
    layout.delimiter = delimiter(text);
    layout.header = std::move(header);

    // The first row has a number or a date; between it and the header stand rows of units.
    constexpr std::size_t kMaxUnitRows = 3;
    std::vector<std::vector<std::string>> unit_rows;
    std::size_t next = next_line(i + 1, is_comment_header);
    layout.first_row = next_line(i + 1, false) + 1;
    for (; next < lines_.size() && unit_rows.size() <= kMaxUnitRows; next = next_line(next + 1, is_comment_header)) {
      const bool is_commented = is_comment(lines_[next]);
      std::vector<std::string> fields =
          fields_of(is_commented ? uncommented(lines_[next], options_.comment) : std::string_view(lines_[next]),
                    layout.delimiter);
      if (!is_commented && std::ranges::any_of(fields, is_number_or_date)) {
        layout.row = std::move(fields);
        layout.first_row = next + 1;
        break;
      }
      unit_rows.push_back(std::move(fields));
    }
    ColumnNames names = columns_of_channels(lines_, layout.header);
    for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
      if (!options_.columns[role].empty()) names[role] = options_.columns[role];
    }
    auto columns = choose_columns(layout.header, names, layout.row);
    if (!columns) return columns.error();
    layout.columns = std::move(*columns);
    if (!layout.row.empty()) read_units(layout, unit_rows);
    read_preamble(layout, i);
    settle_clock(layout);
    return layout;
  }

  /// A file without a header. Further columns are ignored.
  Result<Layout, Failure> layout_of_names(std::size_t begin, std::vector<std::string> names) const {
    Layout layout;
    layout.delimiter = delimiter(lines_[begin]);
    layout.header = std::move(names);
    layout.row = fields_of(lines_[begin], layout.delimiter);
    layout.first_row = begin + 1;
    layout.may_rows_be_longer = true;
    auto columns = choose_columns(layout.header, options_.columns, layout.row);
    if (!columns) return columns.error();
    layout.columns = std::move(*columns);
    settle_clock(layout);
    return layout;
  }

  Result<Layout, Failure> layout_of_known(const KnownTable& table) const {
    if (table.first_row >= lines_.size()) return Failure{"has no row below its header"};
    auto layout = layout_of_names(table.first_row, table.header);
    if (!layout) return layout;
    layout->notes.push_back(fmt::format("written by {}", table.program));
    layout->columns.zone = zone_of_first_line(lines_);
    if (table.is_without_units) layout->without_units = table.program;
    return layout;
  }

  /// The fields of the rows that are among the first lines.
  template <class Take>
  void for_first_rows(const Layout& layout, Take take) const {
    for (std::size_t i = layout.first_row - 1; i < lines_.size(); ++i) {
      if (without_blanks(lines_[i]).empty() || is_comment(lines_[i])) continue;
      if (!take(fields_of(lines_[i], layout.delimiter))) return;
    }
  }

  /// Returns true if one of the first rows has numbers where times and winds are to stand.
  bool has_fitting_row(const Layout& layout) const {
    bool fits = false;
    for_first_rows(layout, [&](const std::vector<std::string>& fields) {
      const auto is_number = [&](Role role) {
        const auto& column = layout.columns.at(role);
        return column && column->index < fields.size() &&
               (parse_number(fields[column->index], dimension_of(role)) ||
                std::ranges::count(fields[column->index], ',') == 4);
      };
      const auto is_time = [&](const TimePart& part) {
        return part.column < fields.size() && fields[part.column].find_first_of("0123456789") != std::string::npos;
      };
      fits = std::ranges::all_of(layout.columns.time_parts, is_time) &&
             (is_number(Role::kSpeed) || (is_number(Role::kU) && is_number(Role::kV)));
      return !fits;
    });
    return fits;
  }

  /// The hour and the minute can be one number: the column has numbers above 24, and none of more than 59 minutes.
  void settle_clock(Layout& layout) const {
    auto& parts = layout.columns.time_parts;
    if (parts.size() < 2 || parts.size() > 4 || parts.back().form != TimePartForm::kText) return;
    bool are_hours_and_minutes = true;
    std::int64_t greatest = 0;
    for_first_rows(layout, [&](const std::vector<std::string>& fields) {
      if (parts.back().column >= fields.size()) return true;
      const std::string& text = fields[parts.back().column];
      const auto number = parse_decimal(text, 0);
      constexpr std::size_t kDigits = 4;
      constexpr std::int64_t kMinutes = 60;
      are_hours_and_minutes = number && text.size() <= kDigits && text.find('.') == std::string::npos && *number >= 0 &&
                              *number % 100 < kMinutes;
      if (number) greatest = std::max(greatest, *number);
      return are_hours_and_minutes;
    });
    constexpr std::int64_t kHours = 24;
    if (are_hours_and_minutes && greatest > kHours) parts.back().form = TimePartForm::kHoursAndMinutes;
  }

  /// A header over two lines: "Wind" above "Speed".
  std::optional<Layout> layout_of_two(std::size_t i) const {
    if (i == 0 || is_comment(lines_[i - 1])) return std::nullopt;
    const char delimiter_here = delimiter(lines_[i]);
    const std::vector<std::string> above = fields_of(lines_[i - 1], delimiter_here);
    std::vector<std::string> names = fields_of(lines_[i], delimiter_here);
    if (above.size() != names.size() || std::ranges::any_of(above, is_number_or_date)) return std::nullopt;
    for (std::size_t field = 0; field < names.size(); ++field) {
      names[field] = std::string(without_blanks(above[field] + " " + names[field]));
    }
    auto found = layout_at(i, std::move(names), false);
    if (!found) return std::nullopt;
    return std::move(*found);
  }

  /// Of rows of words between the header and the first row; a row is one of units if it has one at least.
  void read_units(Layout& layout, const std::vector<std::vector<std::string>>& rows) const {
    // Campbell's first line; its third one has the units.
    const bool are_units_first = lines_[0].starts_with("TOA5") || lines_[0].starts_with("\"TOA5\"");
    for (const auto& row : rows) {
      const bool is_first_of_toa5 = are_units_first && &row == &rows.front();
      if (!is_first_of_toa5 && !std::ranges::any_of(row, is_any_unit)) continue;
      for (std::size_t index = 0; index < kCsvRoleCount; ++index) {
        auto& column = layout.columns.by_role[index];
        const Dimension dimension = dimension_of(static_cast<Role>(index));
        if (!column || column->index >= row.size() || dimension == Dimension::kNone) continue;
        const std::string& word = row[column->index];
        if (const auto unit = find_unit(dimension, word)) {
          column->unit = unit;
          column->unit_source = "from the row of units";
        } else if (!column->unit && !words_of(word).empty()) {
          column->unknown_unit = word;
        }
      }
      return;
    }
  }

  void read_preamble(Layout& layout, std::size_t header) const {
    Preamble preamble;
    for (std::size_t i = 0; i < header; ++i) {
      const std::string_view line = uncommented(lines_[i], options_.comment);
      if (line.empty()) continue;
      // A table of one row: names above values.
      const char delimiter_here = delimiter(line);
      const std::vector<std::string> names = fields_of(line, delimiter_here);
      if (names.size() > 1 && i + 1 < header) {
        const std::vector<std::string> values = fields_of(lines_[i + 1], delimiter_here);
        for (std::size_t field = 0; field < names.size() && names.size() == values.size(); ++field) {
          read_key(preamble, names[field], values[field]);
        }
      }
      const auto end_of_key = line.find_first_of(":=;,\t");
      if (end_of_key == std::string_view::npos) continue;
      read_key(preamble, line.substr(0, end_of_key), line.substr(end_of_key + 1));
      read_legend(layout.columns, line.substr(0, end_of_key), line.substr(end_of_key + 1));
    }
    if (!layout.columns.zone) layout.columns.zone = preamble.zone;
    if (!layout.columns.zone) layout.columns.zone = zone_of_first_line(lines_);
    if (!preamble.speed_unit) return;
    for (const Role role : {Role::kSpeed, Role::kGust, Role::kU, Role::kV}) {
      auto& column = layout.columns.at(role);
      if (!column || column->unit) continue;
      column->unit = preamble.speed_unit;
      column->unit_source = "from the lines before the header";
    }
  }

  /// Of the line that looks most like a header: of those above a row of as many fields, or else of all, the first
  /// with the most names.
  Failure failure_of(std::size_t begin, const Failure& first) const {
    std::optional<std::size_t> best;
    std::pair<bool, std::size_t> most{false, 1};
    for (std::size_t i = begin; i < lines_.size(); i = next_line(i + 1, false)) {
      const std::vector<std::string> fields = fields_of(lines_[i], delimiter(lines_[i]));
      if (data_in(fields)) continue;
      const auto names =
          static_cast<std::size_t>(std::ranges::count_if(fields, [](const auto& text) { return !text.empty(); }));
      const std::pair<bool, std::size_t> here{is_above_a_row(i, fields.size()), names};
      if (here <= most) continue;
      best = i;
      most = here;
    }
    if (!best) {
      return Failure{first.message + "; if the file has no header, name the columns with --header NAMES"};
    }
    const auto tried = layout_at(*best, fields_of(lines_[*best], delimiter(lines_[*best])), false);
    return tried ? first : tried.error();
  }

  /// Rows of units may stand between them.
  bool is_above_a_row(std::size_t header, std::size_t count) const {
    constexpr std::size_t kMaxBetween = 3;
    std::size_t i = header;
    for (std::size_t between = 0; between <= kMaxBetween; ++between) {
      i = next_line(i + 1, false);
      if (i >= lines_.size()) return false;
      const std::vector<std::string> fields = fields_of(lines_[i], delimiter(lines_[header]));
      if (data_in(fields)) return count > 1 && fields.size() == count;
    }
    return false;
  }

  const std::vector<std::string>& lines_;
  const ImportOptions& options_;
};

}  // namespace

Result<Layout, Failure> find_layout(const std::vector<std::string>& lines, const ImportOptions& options) {
  return LayoutSearch(lines, options).find();
}

}  // namespace yuragi::daemon::tools::csv
