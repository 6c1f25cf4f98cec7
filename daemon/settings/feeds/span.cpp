#include "daemon/settings/feeds/span.hpp"

#include <algorithm>
#include <locale>
#include <sstream>
#include <string>

#include <fmt/format.h>

namespace yuragi::daemon::settings::feeds {

double Span::part_of(double value) const noexcept {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

Result<Span, Failure> span_of(std::string_view text) {
  std::istringstream in{std::string(text)};
  in.imbue(std::locale::classic());
  Span span;
  std::string more;
  if (in >> span.from >> span.to && !(in >> more) && span.from != span.to) return span;
  return Failure{fmt::format("is \"{}\"; give two different numbers: \"0 12\"", text)};
}

Result<values::Reference, ParameterError> value_named(const std::string& text, const values::Names& names) {
  auto value = values::Reference::parse(text);
  if (!value) return ParameterError{"value", value.error().message};
  if (auto missing = value->missing_in(names)) return ParameterError{"value", std::move(*missing)};
  return {boost::system::in_place_value, std::move(*value)};
}

}  // namespace yuragi::daemon::settings::feeds
