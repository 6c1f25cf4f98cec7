#include "daemon/tools/csv/csv_import.hpp"

#include <algorithm>
#include <istream>
#include <utility>

#include "daemon/tools/csv/csv_layout.hpp"
#include "daemon/tools/csv/csv_lines.hpp"
#include "daemon/tools/csv/csv_row.hpp"
#include "daemon/tools/csv/csv_survey.hpp"
#include "daemon/tools/csv/csv_unit_choice.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

/// One import, once the columns and units are known.
class Import {
 public:
  Import(const std::string& name, const ImportOptions& options, const Sinks& sinks, RowSplitter splitter,
         RowReader rows)
      : name_(name), options_(options), sinks_(sinks), splitter_(std::move(splitter)), rows_(std::move(rows)) {}

  Result<ImportReport, Failure> run(Lines& lines) {
    while (lines.next()) {
      if (const auto done = take_line(lines); !done) return done.error();
    }
    if (lines.is_too_long()) return too_long_line(name_, lines.number() + 1);
    return finish();
  }

  /// The same from the last line to the first.
  Result<ImportReport, Failure> run_backward(Lines& lines) {
    struct Place {
      std::streamoff offset;
      std::size_t number_before;
    };
    constexpr std::size_t kMaxPlaces = 10'000'000;
    std::vector<Place> places;
    for (;;) {
      const Place place{lines.place(), lines.number()};
      if (!lines.next()) break;
      if (places.size() == kMaxPlaces) {
        return Failure{name_ + ": its newest row comes first, and it is too long to be reversed; sort it by time"};
      }
      places.push_back(place);
    }
    if (lines.is_too_long()) return too_long_line(name_, lines.number() + 1);
    for (auto place = places.rbegin(); place != places.rend(); ++place) {
      lines.go_to(place->offset, place->number_before);
      if (!lines.next()) break;
      if (const auto done = take_line(lines); !done) return done.error();
    }
    report_.notes.emplace_back("the newest row comes first: read from the end");
    return finish();
  }

 private:
  Result<void, Failure> take_line(Lines& lines) {
    const std::span<char> line = lines.line();
    const bool is_again = std::ranges::equal(line, last_line_);
    last_line_.assign(line.begin(), line.end());
    const auto is_row = splitter_.split(line, fields_);
    if (is_row && !*is_row) return {};
    ++report_.rows;
    const auto taken = [&]() -> Result<void, RowRefusal> {
      if (!is_row) return is_row.error();
      if (is_again) {
        ++repeated_;
        return RowRefusal{"the same row as the one before"};
      }
      return take_row();
    }();
    if (taken) return {};
    report_.refuse(name_, lines.number(), taken.error());
    if (options_.strict) return Failure{report_.first_refusals.front()};
    return {};
  }

  Result<void, RowRefusal> take_row() {
    const auto row = rows_.read(fields_);
    if (!row) return row.error();
    const std::string_view sensor = fields_.at(Role::kSensor).value_or(options_.sensor);
    sinks_.reading(sensor, row->reading);
    ++report_.taken;
    if (!row->quantities) return {};
    ++report_.quantities;
    if (sinks_.quantities) sinks_.quantities(sensor, *row->quantities);
    return {};
  }

  ImportReport finish() {
    report_.columns = rows_.describe();
    for (std::string& note : rows_.notes()) report_.notes.push_back(std::move(note));
    if (repeated_ > 0)
      report_.notes.push_back("the same row as the one before: left out, " + count_text(repeated_, "row"));
    return std::move(report_);
  }

  const std::string& name_;
  const ImportOptions& options_;
  const Sinks& sinks_;
  RowSplitter splitter_;
  RowReader rows_;
  Fields fields_;
  std::string last_line_;
  std::size_t repeated_ = 0;
  ImportReport report_;
};

}  // namespace

void ImportReport::refuse(const std::string& file, std::size_t line, const RowRefusal& why) {
  ++refusals[why.reason];
  if (first_refusals.size() < kMaxRefusalsListed)
    first_refusals.push_back(file + ":" + std::to_string(line) + ": " + why.message());
}

Result<ImportReport, Failure> import_csv(std::istream& in, const std::string& name, const ImportOptions& options,
                                         const Sinks& sinks) {
  Input input(in);
  return import_csv(input, name, options, sinks);
}

Result<ImportReport, Failure> import_csv(Input& input, const std::string& name, const ImportOptions& options,
                                         const Sinks& sinks) {
  const auto failed = [&name](const Failure& failure) { return Failure{name + ": " + failure.message, failure.kind}; };
  const auto head = first_lines(input, name);
  if (!head) return head.error();
  auto layout = find_layout(*head, options);
  if (!layout) return failed(layout.error());
  if (const auto known = choose_units(*layout, options); !known) return failed(known.error());
  auto survey = survey_rows(input.first_pass(), *layout, options);
  if (!survey) return failed(survey.error());
  if (!input.is_whole()) {
    survey->notes.push_back(
        "formats and marks were found in the first 32 MiB only: standard input cannot be read twice; a file can");
    if (survey->is_newest_first) {
      return failed(
          {"the newest row comes first: give the name of the file, because standard input cannot be read twice"});
    }
  }

  auto splitter = RowSplitter::make(*layout, options);
  if (!splitter) return failed(splitter.error());
  auto rows = RowReader::make(*layout, *survey, options);
  if (!rows) return failed(rows.error());
  Lines lines(input.second_pass(), options.comment);
  lines.begin_at(layout->first_row);
  Import import(name, options, sinks, std::move(*splitter), std::move(*rows));
  auto report = survey->is_newest_first ? import.run_backward(lines) : import.run(lines);
  if (!report) return report;
  report->notes.insert(report->notes.begin(), survey->notes.begin(), survey->notes.end());
  report->notes.insert(report->notes.begin(), layout->notes.begin(), layout->notes.end());
  report->is_own_export = layout->columns.at(Role::kElapsed).has_value();
  return report;
}

}  // namespace yuragi::daemon::tools::csv
