#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace yuragi::daemon::tools::csv {

// Text as people write it in headers and fields.

/// The words of a name in lower case: "Wind Speed (km/h)" and "windSpeed_km_h" have wind, speed, km, h. Umlauts are
/// written out, accents left off, and the Japan Meteorological Agency's names translated; other signs beyond ASCII
/// separate words.
std::vector<std::string> words_of(std::string_view name);

/// Words without anything between them.
std::string joined(std::span<const std::string> words);

/// In lower case, as far as it is ASCII.
std::string lower(std::string_view text);

/// Without blanks and tabs around it.
std::string_view without_blanks(std::string_view text);

}  // namespace yuragi::daemon::tools::csv
