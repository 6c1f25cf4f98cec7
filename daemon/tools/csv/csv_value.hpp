#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/csv/csv_role.hpp"

namespace yuragi::daemon::tools::csv {

/// A number in a field, with its unit if the field itself names one ("5.4 mph").
struct Number {
  double value = 0.0;
  std::optional<Unit> unit;
};

/// A finite number, with a point or a comma; nullopt for anything else.
std::optional<Number> parse_number(std::string_view text, Dimension dimension);

/// Usual words for a missing value: nothing, "NaN", "NA", "null", "-", "---", "M", "MM", "VRB", "unavailable" ...
bool is_missing_word(std::string_view text);

/// Returns true if the number stands for no value by convention: -99, -999, -9999 (and with decimals of 9), 999 and
/// more nines, Campbell's 7999 and 6999, 990 for a direction. `base`: the same in the base unit of the column; what can
/// be is no mark (-99 in tenths of a degree Celsius, 999 in cm/s).
bool is_missing_number(Role role, double value, double base);

/// Returns true if the number can stand for no value when it is far above all others and repeated: 99, 99.9, 327.67.
bool is_possible_mark(Role role, double value);

}  // namespace yuragi::daemon::tools::csv
