#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/values/moment.hpp"

namespace yuragi::daemon::feeds {

/// How often a value is worth sending.
enum class OscPace : std::uint8_t { kEachTick, kTenTimesASecond, kOnChange };
inline constexpr double kOscTenth_s = 0.1;  ///< of kTenTimesASecond

/// A number of a message: its unit (empty: none) and its range, for programs that draw a slider.
struct OscNumber {
  std::string_view unit = {};
  double min = 0.0, max = 1.0;
};

/// The arguments of a message: some numbers, or one text.
using OscArguments = std::variant<std::vector<float>, std::string>;

/// An address of the daemon's OSC namespace, and how its value is read.
struct OscAddress {
  std::string_view part = {};  ///< one of settings::feeds::kOscParts
  OscPace pace = OscPace::kEachTick;
  std::string path = {};                     ///< "/place/door/gust_norm"
  std::string help = {};                     ///< what the value is
  std::vector<OscNumber> numbers = {};       ///< empty: it is a text
  std::vector<std::string_view> texts = {};  ///< all that a text can be
  /// The value of a moment; nullopt: there is none.
  std::function<std::optional<OscArguments>(const values::Moment& moment, values::Wind wind)> read = {};

  /// The message with the value; nullopt: there is none.
  std::optional<std::vector<std::uint8_t>> message(const values::Moment& moment, values::Wind wind,
                                                   const std::string& prefix = {}) const;
};

/// All addresses of an installation with these names:
///
///   /wind ff speed direction; /wind/NAME f for each Quantity; /wind/state s
///   /sensor/NAME/speed f, /direction f, /age f, /state s
///   /place/NAME ff speed direction; /place/NAME/QUANTITY f
///   /scene/NAME/opacity f
///
/// In names each character other than A-Z a-z 0-9 _ - becomes _; a second "roof" is "roof_2".
std::vector<OscAddress> osc_addresses_of(const values::Names& names);

/// A name (UTF-8) as a part of an address.
std::string osc_part_of(std::string_view name);

/// Names as parts of addresses, no two alike.
std::vector<std::string> osc_parts_of(const std::vector<std::string>& names);

}  // namespace yuragi::daemon::feeds
