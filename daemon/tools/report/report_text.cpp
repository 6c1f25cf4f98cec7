#include "daemon/tools/report/report_text.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>

#include <fmt/format.h>

#include "engine/base/compass.hpp"

namespace yuragi::daemon::tools::report {
namespace {

constexpr std::size_t kMaxBytes = 200;
constexpr std::string_view kReplacement = "\xef\xbf\xbd";

/// How many bytes the UTF-8 sequence at the beginning has; 0 if there is none that is valid.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  std::size_t length = 0;
  std::uint32_t code = 0;
  if (first >= 0xc2 && first <= 0xdf) length = 2, code = first & 0x1fU;
  if (first >= 0xe0 && first <= 0xef) length = 3, code = first & 0x0fU;
  if (first >= 0xf0 && first <= 0xf4) length = 4, code = first & 0x07U;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
    code = code << 6U | (byte(i) & 0x3fU);
  }
  // Longer than needed, half of a pair, no character at all, or beyond the last one.
  const bool is_overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool is_no_character = (code >= 0xd800 && code <= 0xdfff) || (code & 0xfffeU) == 0xfffeU || code > 0x10ffff ||
                               (code >= 0x80 && code < 0xa0);
  return is_overlong || is_no_character ? 0 : length;
}

std::tm calendar(UtcTime moment, bool is_local) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(moment);
  const std::time_t since_epoch_s = whole.time_since_epoch().count();
  std::tm parts{};
  if (is_local) {
    localtime_r(&since_epoch_s, &parts);
  } else {
    gmtime_r(&since_epoch_s, &parts);
  }
  return parts;
}

std::string calendar_text(const std::tm& parts, const char* format) {
  std::array<char, 80> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &parts)};
}

}  // namespace

std::string page_text(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (i >= kMaxBytes) return result + "…";
    const std::size_t length = sequence_length(text.substr(i));
    const char c = text[i];
    if (length == 1 && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)) {
      result += kReplacement;
    } else if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '"') {
      result += "&quot;";
    } else if (c == '\'') {
      result += "&#39;";
    } else {
      result += length == 0 ? kReplacement : text.substr(i, length);
    }
    i += length == 0 ? 1 : length;
  }
  return result;
}

std::string utc_text(UtcTime moment) {
  return calendar_text(calendar(moment, false), "%Y-%m-%d %H:%M:%S UTC");
}

std::string local_text(UtcTime moment) {
  return calendar_text(calendar(moment, true), "%Y-%m-%d %H:%M:%S %Z");
}

Nanoseconds local_offset(UtcTime moment) {
  return std::chrono::seconds(calendar(moment, true).tm_gmtoff);
}

std::string compass_text(double direction_deg) {
  std::string text;
  for (const char letter : nearest_compass_point(direction_deg)) {
    if (!text.empty()) text += '-';
    text += letter == 'N' ? "north" : letter == 'E' ? "east" : letter == 'S' ? "south" : "west";
  }
  return text;
}

}  // namespace yuragi::daemon::tools::report
