#pragma once

#include <cstddef>
#include <ios>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::daemon::tools::csv {

/// Reads the lines of a CSV file one by one: skips empty ones and comments, and removes line ends ("\n" or "\r\n") and
/// byte order mark. Thread-safe: no.
class Lines {
 public:
  static constexpr std::size_t kMaxLine = 1 << 20;

  /// `in` must outlive this. `comment`: what comment lines begin with; 0: there are none.
  Lines(std::istream& in, char comment);

  /// Goes to the next line; false if there is none, or if it is longer than kMaxLine.
  bool next();
  /// The line that next() read; valid until the next call, and may be modified (split_csv_line).
  std::span<char> line() { return {buffer_.data(), size_}; }
  /// Of the file, from 1.
  std::size_t number() const { return number_; }
  /// Lines before this one are passed over from now on.
  void begin_at(std::size_t number) { first_ = number; }
  /// Goes to a line of which place and number are known: its beginning, and the number of the line before it.
  void go_to(std::streamoff place, std::size_t number_before);
  /// Where the next line begins.
  std::streamoff place() const;
  bool is_too_long() const { return is_too_long_; }

 private:
  std::istream& in_;
  char comment_;
  std::vector<char> buffer_;
  std::size_t size_ = 0;
  std::size_t number_ = 0;
  std::size_t first_ = 1;
  bool is_too_long_ = false;
};

/// Splits a line into fields: a delimiter of ' ' stands for any number of blanks and tabs. The fields are without
/// spaces around them and without enclosing quotes (RFC 4180: a delimiter within quotes is text, and a quote within
/// them is doubled). False if a quote is not closed. Works in place: `fields` point into the line.
bool split_csv_line(std::span<char> line, char delimiter, std::vector<std::string_view>& fields);

/// The same fields as texts of their own; none if a quote is not closed.
std::vector<std::string> fields_of(std::string_view line, char delimiter);

}  // namespace yuragi::daemon::tools::csv
