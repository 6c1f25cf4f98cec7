#pragma once

#include <cstddef>
#include <istream>
#include <memory>
#include <streambuf>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {

/// A stream that is read twice: first to examine it, then for its rows. Of one that cannot go back (a pipe) the first
/// kMaxKept bytes are kept and examined. Thread-safe: no.
class Input {
 public:
  static constexpr std::size_t kMaxKept = std::size_t{32} << 20;

  /// `in` must outlive this.
  explicit Input(std::istream& in);

  /// The stream from its beginning: all of it, or, for a pipe, its first whole lines.
  std::istream& first_pass();
  /// The whole stream from its beginning.
  std::istream& second_pass();
  /// Returns true if the first pass has all of it.
  bool is_whole() const { return is_whole_; }

 private:
  std::istream& in_;
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
