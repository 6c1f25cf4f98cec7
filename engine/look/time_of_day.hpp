#pragma once

#include <optional>
#include <string_view>

namespace yuragi::look {

/// The hours, 0 to 24, of the text "06:30"; nullopt if it is not a time.
std::optional<double> time_of_day_h(std::string_view text) noexcept;

}  // namespace yuragi::look
