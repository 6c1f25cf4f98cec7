#include "daemon/web/query.hpp"

#include <charconv>
#include <system_error>

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

std::optional<std::string> path_decoded(std::string_view path) {
  std::string text;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] != '%') {
      text += path[i];
      continue;
    }
    unsigned byte = 0;
    const std::string_view digits = path.substr(i + 1, 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() != 2 || error != std::errc() || end != digits.data() + 2 || byte == 0) return std::nullopt;
    text += static_cast<char>(byte);
    i += 2;
  }
  return text;
}

}  // namespace yuragi::daemon::web
