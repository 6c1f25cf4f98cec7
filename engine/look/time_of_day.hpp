#pragma once

#include <optional>
#include <string_view>

namespace yuragi::look {

/// A time of the day in hours, 0 to 24, of the text "06:30"; nothing if it is none.
std::optional<double> time_of_day_h(std::string_view text) noexcept;

}  // namespace yuragi::look
