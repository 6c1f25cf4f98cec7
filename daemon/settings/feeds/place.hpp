#pragma once

#include <span>
#include <string>

#include "daemon/values/moment_maker.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::daemon::settings::feeds {

/// The keys of a [[place]], except for its name.
std::span<const Parameter> place_parameters();

/// From values of place_parameters().
values::Place place_of(std::string name, const ParameterValues& values);

}  // namespace yuragi::daemon::settings::feeds
