#pragma once

#include <string>
#include <vector>

#include "daemon/tools/csv/csv_layout.hpp"
#include "daemon/tools/csv/csv_options.hpp"

namespace yuragi::daemon::tools::csv {

/// Gives each column of numbers its unit, and records its source: the options, its own name, the row of units, the
/// lines before the header, what is known of whose file it is (weewx, Meteostat, KNMI ...), the column of the speed for
/// a gust, or else the dimension's own unit, as an assumption (`unit_source` is then kAssumed). Thread-safe: yes.
void choose_units(Layout& layout, const ImportOptions& options);

inline constexpr const char* kAssumedUnit = "assumed: the file does not give its unit";

}  // namespace yuragi::daemon::tools::csv
