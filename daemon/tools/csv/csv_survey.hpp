#pragma once

#include <array>
#include <chrono>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/csv/csv_layout.hpp"
#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {

/// Findings from all rows together.
struct Survey {
  TimeFormat time_format = TimeFormat::kIso;
  bool is_newest_first = false;
  std::optional<std::chrono::year> typical_year;                  ///< months of different years are put on it
  std::array<std::optional<double>, kCsvRoleCount> missing_mark;  ///< a number that stands for no value
  std::vector<std::string> notes;                                 ///< what was settled, for people
};

/// Reads all rows of `in` to settle the format of times (which of 3/4/2023 is the day?), marks for missing values, and
/// whether the units can be right. Fails, with the option that helps, if they cannot be settled. Thread-safe: yes,
/// with separate streams.
Result<Survey, Failure> survey_rows(std::istream& in, const Layout& layout, const ImportOptions& options);

}  // namespace yuragi::daemon::tools::csv
