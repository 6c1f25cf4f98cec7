#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings {

/// A table of the configuration that occurs once in its owner: the file, or a [[sensor]].
template <class Owner>
struct TableOf {
  std::string_view name;
  std::string_view summary;
  std::span<const Parameter> parameters;
  KeyChange change;  ///< effect of a new value of a key that does not state it
  /// Makes the owner's members from the values. Members of earlier tables are already set. Returns the contradictions,
  /// with the keys.
  std::vector<ParameterError> (*fill)(Owner& owner, const ParameterValues& values);
};

/// The values of such tables by their names.
using TablesByName = std::map<std::string_view, ParameterValues>;

}  // namespace yuragi::daemon::settings
