#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/csv/csv_encoding.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {

/// A stream that is read twice, in UTF-8: first to examine it, then for its rows. Text in another encoding is
/// converted. Of a stream that cannot go back (a pipe) the first kMaxKept bytes are kept and examined. Thread-safe: no.
class Input {
 public:
  static constexpr std::size_t kMaxKept = std::size_t{32} << 20;

  /// `in` must outlive this. Throws FailureError if converted text cannot be written to a temporary file.
  explicit Input(std::istream& in);

  /// The stream from its beginning: all of it, or, for a pipe, its first whole lines.
  std::istream& first_pass();
  /// The whole stream from its beginning.
  std::istream& second_pass();
  /// Returns true if the first pass has all of it.
  bool is_whole() const { return is_whole_; }
  /// Of the text as it was.
  Encoding encoding() const { return encoding_; }
  /// What it is, if it is no text (foreign_kind).
  std::optional<std::string_view> foreign() const { return foreign_; }

 private:
  void examine(std::string_view beginning);
  void keep();
  void join();

  std::istream* in_;
  Encoding encoding_ = Encoding::kUtf8;
  std::optional<std::string_view> foreign_;
  std::unique_ptr<std::istream> converted_;
  std::streampos begin_{0};
  bool is_whole_ = true;
  std::string kept_;                             ///< what was read of a pipe
  std::unique_ptr<std::streambuf> kept_buffer_;  ///< over kept_
  std::unique_ptr<std::streambuf> joined_;       ///< kept_, and what follows
  std::unique_ptr<std::istream> stream_;         ///< over one of them
};

/// The first lines of an input, comments and empty ones too, as many as a header is looked for in. Fails if one of
/// them is too long.
Result<std::vector<std::string>, Failure> first_lines(Input& input, const std::string& name);

/// The failure of a file with a line that is too long.
Failure too_long_line(const std::string& name, std::size_t number);

}  // namespace yuragi::daemon::tools::csv
