#pragma once

#include <string_view>

#include "engine/base/result.hpp"

namespace yuragi::daemon::web {

/// A whole number that may stand in a query, and its default.
struct QueryNumber {
  std::string_view name;
  unsigned least = 0, most = 0, otherwise = 0;
};

/// The number of a query that is empty or "NAME=DIGITS". Fails with what is allowed. Pure.
Result<unsigned, Failure> number_in_query(std::string_view query, const QueryNumber& number);

}  // namespace yuragi::daemon::web
