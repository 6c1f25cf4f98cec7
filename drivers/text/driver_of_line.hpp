#pragma once

#include <optional>
#include <string_view>

namespace yuragi::drivers::text {

/// The driver of this room that reads a wind, or a message without one, in such a line: "nmea2000" for canboat's
/// "2018-02-14T15:55:07.944Z,2,130306,3,255,8,09,44,...". Nullopt if it has the form of none. Not for columns of
/// numbers, which can be anything. Thread-safe: yes.
std::optional<std::string_view> driver_of_line(std::string_view line);

}  // namespace yuragi::drivers::text
