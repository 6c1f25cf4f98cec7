#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/tools/csv/csv_layout.hpp"
#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {

/// Why a row is not a reading.
struct RowRefusal {
  std::string reason = {};  ///< the same for all rows of its kind
  std::string text = {};    ///< what the row has instead; can be empty

  std::string message() const { return text.empty() ? reason : reason + ": " + text; }
};

/// The fields of a row that have a role.
struct Fields {
  std::array<std::optional<std::string_view>, kCsvRoleCount> by_role;  ///< none for a missing column
  std::string time;                                                    ///< all of its columns, with blanks between them
  const std::optional<std::string_view>& at(Role role) const { return by_role[static_cast<std::size_t>(role)]; }
};

/// Takes the rows of a file apart. Thread-safe: no.
class RowSplitter {
 public:
  /// Fails if a condition names a column that is missing.
  static Result<RowSplitter, Failure> make(const Layout& layout, const ImportOptions& options);

  /// The fields of a line, which is changed and must outlive them; false if a condition does not hold.
  Result<bool, RowRefusal> split(std::span<char> line, Fields& fields);

 private:
  RowSplitter(const Layout& layout) : layout_(layout) {}

  const Layout& layout_;
  std::vector<std::pair<std::size_t, std::string>> conditions_;  ///< column and text
  std::vector<std::string_view> all_fields_;
};

}  // namespace yuragi::daemon::tools::csv
