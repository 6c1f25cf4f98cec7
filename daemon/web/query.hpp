#pragma once

#include <optional>
#include <string>
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

/// A path, or a part of one, with its %XX decoded (RFC 3986, 2.1); nullopt: there is a damaged one, or one of a zero.
/// Pure.
std::optional<std::string> path_decoded(std::string_view path);

}  // namespace yuragi::daemon::web
