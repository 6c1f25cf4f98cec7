#pragma once

#include <string>
#include <vector>

#include "daemon/tools/csv/csv_layout.hpp"
#include "daemon/tools/csv/csv_options.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::tools::csv {

/// Gives each column of numbers its unit, and records its source: the options, its own name, the row of units, the
/// lines before the header, what is known of whose file it is (weewx, Meteostat, KNMI ...), the column of the speed for
/// a gust, or else the dimension's own unit, as an assumption (`unit_source` is then kAssumed). Fails, with the option
/// that helps, if a speed or a direction has a word for its unit that is not known, or comes from a program whose
/// files never give it. Thread-safe: yes.
Result<void, Failure> choose_units(Layout& layout, const ImportOptions& options);

inline constexpr const char* kAssumedUnit = "assumed: the file does not give its unit";

}  // namespace yuragi::daemon::tools::csv
