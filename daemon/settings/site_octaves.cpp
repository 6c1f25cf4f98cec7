#include "daemon/settings/site_octaves.hpp"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "engine/wind/turbulence/site_spectrum.hpp"

namespace yuragi::daemon::settings {

Result<std::vector<double>, Failure> parse_site_octaves(std::string_view text) {
  const Failure failure{
      fmt::format("\"{}\" is not a list of octaves; allowed: up to {} numbers from {:g} to {:g} dB, such as "
                  "\"+1.2 +0.8 -0.5 -1.1\"",
                  text, wind::turbulence::SiteSpectrum::kOctaves, -wind::turbulence::SiteSpectrum::kMost_db,
                  wind::turbulence::SiteSpectrum::kMost_db)};
  std::vector<double> octaves_db;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    if (text.empty()) return octaves_db;
    std::string_view word = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(word.size());
    if (word.starts_with('+') && word.size() > 1 && word[1] != '-') word.remove_prefix(1);
    double level_db = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), level_db);
    const bool is_number = error == std::errc{} && end == word.data() + word.size();
    if (!is_number || !(std::abs(level_db) <= wind::turbulence::SiteSpectrum::kMost_db)) return failure;
    if (octaves_db.size() == wind::turbulence::SiteSpectrum::kOctaves) return failure;
    octaves_db.push_back(level_db);
  }
}

std::string site_octaves_text(std::span<const double> octaves_db) {
  std::string text;
  for (const double level_db : octaves_db) text += fmt::format("{}{:+.1f}", text.empty() ? "" : " ", level_db);
  return text;
}

}  // namespace yuragi::daemon::settings
