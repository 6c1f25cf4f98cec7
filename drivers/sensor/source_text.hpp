#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "engine/base/parameter.hpp"

namespace yuragi::drivers::sensor {

/// Returns what a sensor reads, as text: the values of the keys that choose it, without those that are empty:
/// `host = 10.0.0.5, port = 502`. Keys that there are not are left out. Pure.
std::string source_text(const ParameterValues& values, std::initializer_list<std::string_view> keys);

}  // namespace yuragi::drivers::sensor
