#include "daemon/tools/csv/csv_import.hpp"

#include <algorithm>
#include <istream>

#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/csv_row.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

char delimiter_of(std::string_view header) {
  char best = ',';
  for (const char candidate : {';', '\t'}) {
    if (std::count(header.begin(), header.end(), candidate) > std::count(header.begin(), header.end(), best))
      best = candidate;
  }
  return best;
}

Failure too_long(const std::string& name, const CsvLines& lines) {
  return {name + ":" + std::to_string(lines.number() + 1) + ": a line is longer than a megabyte; is it a CSV file?"};
}

/// One import, once the header is known.
class Import {
 public:
  Import(const std::string& name, const CsvImportOptions& options, const CsvColumns& columns, std::size_t column_count,
         const CsvReadingSink& sink)
      : name_(name),
        options_(options),
        columns_(columns),
        column_count_(column_count),
        sink_(sink),
        rows_(columns, options) {}

  Result<CsvImportReport, Failure> run(CsvLines& lines, char delimiter) {
    while (lines.next()) {
      ++report_.rows;
      if (const auto taken = take(lines.line(), delimiter); !taken) refuse(lines.number(), taken.error().message);
      if (report_.refused() > 0 && options_.strict) return Failure{report_.first_refusals.front()};
    }
    if (lines.is_too_long()) return too_long(name_, lines);
    report_.columns = rows_.describe();
    return report_;
  }

 private:
  Result<void, Failure> take(std::span<char> line, char delimiter) {
    if (!split_csv_line(line, delimiter, all_fields_)) return Failure{"a quote that is not closed"};
    if (all_fields_.size() < column_count_) return Failure{"fewer fields than the header"};
    if (all_fields_.size() > column_count_) return Failure{"more fields than the header"};
    CsvFields fields;
    for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
      if (columns_[role]) fields[role] = all_fields_[columns_[role]->index];
    }
    const auto reading = rows_.read(fields);
    if (!reading) return reading.error();
    sink_(fields[static_cast<std::size_t>(CsvRole::kSensor)].value_or(options_.sensor), *reading);
    ++report_.taken;
    return {};
  }

  void refuse(std::size_t line, const std::string& why) {
    if (report_.first_refusals.size() >= CsvImportReport::kMaxRefusalsListed) return;
    report_.first_refusals.push_back(name_ + ":" + std::to_string(line) + ": " + why);
  }

  const std::string& name_;
  const CsvImportOptions& options_;
  const CsvColumns& columns_;
  std::size_t column_count_;
  const CsvReadingSink& sink_;
  CsvRowReader rows_;
  std::vector<std::string_view> all_fields_;
  CsvImportReport report_;
};

}  // namespace

Result<CsvImportReport, Failure> import_csv(std::istream& in, const std::string& name, const CsvImportOptions& options,
                                            const CsvReadingSink& sink) {
  CsvLines lines(in, options.comment);
  if (!lines.next()) {
    return lines.is_too_long() ? too_long(name, lines) : Failure{name + ": has no header line"};
  }
  const std::span<char> header = lines.line();
  const char delimiter = options.delimiter == 0 ? delimiter_of({header.data(), header.size()}) : options.delimiter;
  std::vector<std::string_view> names;
  if (!split_csv_line(header, delimiter, names)) return Failure{name + ": the header has a quote that is not closed"};
  const auto columns = choose_columns({names.begin(), names.end()}, options.columns);
  if (!columns) return Failure{name + ": " + columns.error().message};
  return Import(name, options, *columns, names.size(), sink).run(lines, delimiter);
}

}  // namespace yuragi::daemon::tools::csv
