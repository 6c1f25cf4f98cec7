#include "daemon/tools/csv/csv_import.hpp"

#define CSV_IO_NO_THREAD
#include <algorithm>
#include <cstring>
#include <istream>
#include <memory>

#include <libfccp/csv.h>

#include "daemon/tools/csv/csv_row.hpp"

namespace yuragi {
namespace {

/// Gives the library the bytes that were read ahead for the header, then the rest of the stream; ends with a line's
/// end, which the library counts on.
class CsvByteSource final : public io::ByteSourceBase {
 public:
  CsvByteSource(std::string head, std::istream& in) : head_(std::move(head)), in_(in) {}

  int read(char* buffer, int size) override {
    const auto wanted = static_cast<std::size_t>(size);
    const std::size_t from_head = std::min(wanted, head_.size() - head_used_);
    std::memcpy(buffer, head_.data() + head_used_, from_head);
    head_used_ += from_head;
    in_.read(buffer + from_head, static_cast<std::streamsize>(wanted - from_head));
    std::size_t count = from_head + static_cast<std::size_t>(in_.gcount());

    if (count > 0) ends_line_ = buffer[count - 1] == '\n';
    if (count < wanted && !ends_line_) {
      buffer[count++] = '\n';
      ends_line_ = true;
    }
    return static_cast<int>(count);
  }

 private:
  std::string head_;
  std::istream& in_;
  std::size_t head_used_ = 0;
  bool ends_line_ = true;
};

/// Which lines the library passes over: empty ones, and those that begin with the import's own sign. The library asks
/// for a type, so the sign stands beside it, one a thread.
struct PassedOver {
  static thread_local char comment;
  static bool is_comment(const char* line) {
    return (comment != 0 && *line == comment) || io::empty_line_comment::is_comment(line);
  }
};
thread_local char PassedOver::comment = 0;

/// What was read to find the header, and the header.
struct Head {
  std::string bytes;
  std::string header;
};

Result<Head, Failure> read_head(std::istream& in, const std::string& name) {
  constexpr std::size_t kBlock = 4096;
  constexpr std::size_t kMaxHead = 1 << 20;
  Head head;
  std::size_t line_begin = 0;
  while (head.bytes.size() < kMaxHead) {
    const std::size_t before = head.bytes.size();
    head.bytes.resize(before + kBlock);
    in.read(head.bytes.data() + before, kBlock);
    head.bytes.resize(before + static_cast<std::size_t>(in.gcount()));
    const bool is_end = head.bytes.size() < before + kBlock;
    if (before == 0 && head.bytes.starts_with("\xEF\xBB\xBF")) line_begin = 3;

    // Whole lines, and at the end what is left.
    while (line_begin < head.bytes.size()) {
      std::size_t line_end = head.bytes.find('\n', line_begin);
      if (line_end == std::string::npos && !is_end) break;
      line_end = std::min(line_end, head.bytes.size());
      std::string line = head.bytes.substr(line_begin, line_end - line_begin);
      line_begin = line_end + 1;
      if (line.ends_with('\r')) line.pop_back();
      if (PassedOver::is_comment(line.c_str())) continue;
      head.header = std::move(line);
      return head;
    }
    if (is_end) return Failure{name + ": has no header line"};
  }
  return Failure{name + ": has no header in its first megabyte; is it a CSV file?"};
}

char delimiter_of(const std::string& header) {
  char best = ',';
  for (const char candidate : {';', '\t'}) {
    if (std::count(header.begin(), header.end(), candidate) > std::count(header.begin(), header.end(), best))
      best = candidate;
  }
  return best;
}

/// One import, once the header is known.
class Import {
 public:
  Import(const std::string& name, const CsvImportOptions& options, const CsvColumns& columns,
         const CsvReadingSink& sink)
      : name_(name), options_(options), columns_(columns), sink_(sink), rows_(columns, options) {}

  template <char kDelimiter>
  Result<CsvImportReport, Failure> run(std::string head, std::istream& in) {
    using Reader = io::CSVReader<kCsvRoleCount, io::trim_chars<' ', '\t'>, io::double_quote_escape<kDelimiter, '"'>,
                                 io::throw_on_overflow, PassedOver>;
    try {
      Reader reader(name_, std::unique_ptr<io::ByteSourceBase>(new CsvByteSource(std::move(head), in)));
      reader.read_header(io::ignore_extra_column | io::ignore_missing_column, title(0), title(1), title(2), title(3),
                         title(4), title(5), title(6), title(7), title(8));
      for (std::size_t role = 0; role < kCsvRoleCount; ++role) {
        if (columns_[role] && !reader.has_column(title(role))) {
          return Failure{name_ + ": the name of the column \"" + title(role) + "\" cannot be parsed"};
        }
      }
      while (const auto more = next_row(reader)) {
        if (report_.refused() > 0 && options_.strict) return Failure{report_.first_refusals.front()};
      }
    } catch (const io::error::base& error) {
      return Failure{error.what()};
    }
    report_.columns = rows_.describe();
    return report_;
  }

 private:
  /// The name of a role's column; one that no file has where there is none.
  std::string title(std::size_t role) const {
    return columns_[role] ? columns_[role]->name : std::string("\n") + static_cast<char>('0' + role);
  }

  /// Reads a row; false at the end of the file.
  template <class Reader>
  bool next_row(Reader& reader) {
    std::array<char*, kCsvRoleCount> f{};
    try {
      if (!reader.read_row(f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8])) return false;
    } catch (const io::error::too_few_columns&) {
      refuse(reader.get_file_line(), "fewer fields than the header");
      return true;
    } catch (const io::error::too_many_columns&) {
      refuse(reader.get_file_line(), "more fields than the header");
      return true;
    } catch (const io::error::escaped_string_not_closed&) {
      refuse(reader.get_file_line(), "a quote that is not closed");
      return true;
    }
    CsvFields fields{};
    std::copy(f.begin(), f.end(), fields.begin());
    const auto reading = rows_.read(fields);
    if (!reading) {
      refuse(reader.get_file_line(), reading.error().message);
      return true;
    }
    const char* sensor = fields[static_cast<std::size_t>(CsvRole::kSensor)];
    sink_(sensor == nullptr ? std::string_view(options_.sensor) : std::string_view(sensor), *reading);
    ++report_.rows;
    ++report_.taken;
    return true;
  }

  void refuse(unsigned line, const std::string& why) {
    ++report_.rows;
    if (report_.first_refusals.size() >= CsvImportReport::kMaxRefusalsTold) return;
    report_.first_refusals.push_back(name_ + ":" + std::to_string(line) + ": " + why);
  }

  const std::string& name_;
  const CsvImportOptions& options_;
  const CsvColumns& columns_;
  const CsvReadingSink& sink_;
  CsvRowReader rows_;
  CsvImportReport report_;
};

}  // namespace

Result<CsvImportReport, Failure> import_csv(std::istream& in, const std::string& name, const CsvImportOptions& options,
                                            const CsvReadingSink& sink) {
  PassedOver::comment = options.comment;
  auto head = read_head(in, name);
  if (!head) return head.error();

  const char delimiter = options.delimiter == 0 ? delimiter_of(head->header) : options.delimiter;
  const auto columns = choose_columns(split_csv_line(head->header, delimiter), options.columns);
  if (!columns) return Failure{name + ": " + columns.error().message};

  Import import(name, options, *columns, sink);
  switch (delimiter) {
    case ',':
      return import.run<','>(std::move(head->bytes), in);
    case ';':
      return import.run<';'>(std::move(head->bytes), in);
    case '\t':
      return import.run<'\t'>(std::move(head->bytes), in);
    default:
      return Failure{name + ": fields can be separated by a comma, a semicolon or a tab"};
  }
}

}  // namespace yuragi
