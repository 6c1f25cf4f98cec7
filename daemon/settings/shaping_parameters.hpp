#pragma once

#include <span>
#include <vector>

#include "engine/base/parameter.hpp"

namespace yuragi {

/// What the table [shaping] may hold.
std::span<const Parameter> shaping_parameters();

/// What does not fit together in it, and hours that are none: each with the key that it is about.
std::vector<ParameterError> shaping_mistakes(const ParameterValues& shaping);

}  // namespace yuragi
