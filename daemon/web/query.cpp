#include "daemon/web/query.hpp"

#include <charconv>

#include <fmt/format.h>

namespace yuragi::daemon::web {

Result<unsigned, Failure> number_in_query(std::string_view query, const QueryNumber& number) {
  if (query.empty()) return number.otherwise;
  const std::size_t equals = query.find('=');
  if (equals != std::string_view::npos && query.substr(0, equals) == number.name) {
    const std::string_view digits = query.substr(equals + 1);
    const char* const end = digits.data() + digits.size();
    unsigned value = 0;
    const auto read = std::from_chars(digits.data(), end, value);
    if (read.ec == std::errc() && read.ptr == end && value >= number.least && value <= number.most) return value;
  }
  return Failure{fmt::format("the query must be {}=N, with N from {} to {}", number.name, number.least, number.most)};
}

}  // namespace yuragi::daemon::web
