#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace yuragi::daemon::settings {

/// [wind] site_octaves: decibels separated by blanks, at most as many as a SiteSpectrum has octaves, each within
/// kMost_db; an empty text is none. The failure names what is allowed.
Result<std::vector<double>, Failure> parse_site_octaves(std::string_view text);

/// The reverse: "+1.2 -0.4 ...".
std::string site_octaves_text(std::span<const double> octaves_db);

}  // namespace yuragi::daemon::settings
