#include "daemon/feeds/nmea_sentences.hpp"

#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace yuragi::daemon::feeds {
namespace {

constexpr double kKnotsPerM_s = 3600.0 / 1852.0;

/// Behind the dollar: the exclusive or of it all.
std::string sentence_of(std::string_view content) {
  unsigned sum = 0;
  for (const char c : content) sum ^= static_cast<unsigned char>(c);
  return fmt::format("${}*{:02X}\r\n", content, sum);
}

/// From 000.0 to 359.9.
std::string angle_text(double degrees) {
  const double tenths = std::fmod(std::round(degrees * 10.0), 3600.0);
  return fmt::format("{:05.1f}", (tenths < 0.0 ? tenths + 3600.0 : tenths) / 10.0);
}

}  // namespace

std::string mwv_sentence(const NmeaWind& wind) {
  return sentence_of(
      fmt::format("WIMWV,{},T,{:.2f},M,{}", angle_text(wind.direction_deg), wind.speed_m_s, wind.is_valid ? 'A' : 'V'));
}

std::string mwd_sentence(const NmeaWind& wind) {
  if (!wind.is_valid) return sentence_of("WIMWD,,T,,M,,N,,M");
  return sentence_of(fmt::format("WIMWD,{},T,,M,{:.2f},N,{:.2f},M", angle_text(wind.direction_deg),
                                 wind.speed_m_s * kKnotsPerM_s, wind.speed_m_s));
}

}  // namespace yuragi::daemon::feeds
