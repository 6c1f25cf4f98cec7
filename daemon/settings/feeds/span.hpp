#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/values/moment.hpp"
#include "daemon/values/quantity.hpp"
#include "daemon/values/reference.hpp"
#include "engine/base/fields.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::settings::feeds {

/// Two numbers, and what lies between them.
struct Span {
  double from = 0.0, to = 1.0;
  friend bool operator==(const Span&, const Span&) = default;

  /// How far a value is on the way from one end to the other, 0 to 1.
  double part_of(double value) const noexcept;
  /// The value there.
  double at(double part) const noexcept { return from + (to - from) * part; }
};

/// "0 12": two different numbers.
Result<Span, Failure> span_of(std::string_view text);

/// The usual range of a value.
inline Span range_of(const values::QuantityDescription& value) {
  return {value.min, value.max};
}

/// The value that the key `value` names; an error if the installation does not have it.
Result<values::Reference, ParameterError> value_named(const std::string& text, const values::Names& names);

/// The settings of values whose conversions may refuse one.
template <class Made>
Result<Made, ParameterError> made_of(const Fields<Made>& fields, const ParameterValues& values) {
  Made made{};
  const std::vector<ParameterError> errors = fields.fill(made, values.all());
  if (!errors.empty()) return errors.front();
  return {boost::system::in_place_value, std::move(made)};
}

}  // namespace yuragi::daemon::settings::feeds
