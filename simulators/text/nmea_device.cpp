// The messages of anemometers. Their formats are written here, independently of the drivers' decoders, so that a
// mistake on either side shows.
//
// clang-format off
//   mwv      $WIMWV,230.6,R,3.42,M,A*hh                       angle from the mark, m/s; A: good
//   mwd      $WIMWD,230.6,T,,M,6.65,N,3.42,M*hh               from north; knots, m/s
//   vwr vwt  $WIVWR,129.4,L,6.65,N,3.42,M,12.31,K*hh          from the bow to the left or right
//   mda      $WIMDA,29.9200,I,1.0132,B,12.5,C,,,55.0,,3.7,C,230.6,T,,M,6.65,N,3.42,M*hh
//   xdr      $WIXDR,A,226,D,0,A,231,D,1,A,236,D,2,S,3.1,M,0,S,3.4,M,1,S,3.8,M,2*hh    Vaisala WXT: least, mean, greatest
//   gill     <STX>Q,231,003.42,M,00,<ETX>hh                   WindSonic; without a direction below 0.05 m/s
//   gill-uv  <STX>Q,+002.17,-002.64,M,00,<ETX>hh              +U blows to north, +V to west
//   ft       $WI,WVP=003.4,231,0*hh                           FT7xx; unasked, and on the request "$01,WV?*hh"
//   umb      $WIMWV,230.6,R,003.4,M,A*hh                      Lufft; only on the request "01TR4"
//   wxt      0r1,Dn=226D,Dm=231D,Dx=236D,Sn=3.1M,Sm=3.4M,Sx=3.8Mccc    Vaisala WXT; unasked, and on the request "0r1Goe"
// clang-format on
//
// hh: the exclusive or of the bytes between '$' and '*', or STX and ETX, in hexadecimal. CR LF ends each; ccc: its
// CRC-16 (M211840EN, appendix C). Sources: gpsd www/NMEA.adoc; Vaisala WXT520 user's guide (M210906EN), NMEA 0183 v3.0
// query messages; Gill WindSonic manual 1405-PS-0019; FT Technologies FT702LT manual 5.3; Lufft V200A-UMB manual
// V25 20.5.4.
#include "simulators/text/nmea_device.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "engine/base/units.hpp"

namespace yuragi::simulators::text {
namespace {

constexpr double kKnotsOfAMetrePerSecond = 3600.0 / 1852.0;
constexpr double kKmhOfAMetrePerSecond = 3.6;
constexpr double kGillCalm_m_s = 0.05;

/// How a fault changes a message.
struct Style {
  std::string_view talker = "WI";
  char node = 'Q';
  char address = '0';
  unsigned checksum_error = 0;
};

std::string with_checksum(std::string_view start, std::string_view body, std::string_view end, const Style& style) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return fmt::format("{}{}{}{:02X}\r\n", start, body, end, sum ^ style.checksum_error);
}

std::string sentence(const std::string& body, const Style& style) {
  return with_checksum("$", body, "*", style);
}

std::string gill_frame(const std::string& body, const Style& style) {
  return with_checksum("\x02", body, "\x03", style);
}

/// Whole degrees, 0 to 359.
int whole_deg(double direction_deg) {
  return static_cast<int>(std::lround(direction_deg) % 360);
}

std::string mwv(const core::PlayedMoment& now, const Style& style) {
  return sentence(fmt::format("{}MWV,{:.1f},R,{:.2f},M,A", style.talker, now.direction_deg, now.speed_m_s), style);
}

/// The eight fields that end MWD and MDA.
std::string from_north(const core::PlayedMoment& now) {
  return fmt::format("{:.1f},T,,M,{:.2f},N,{:.2f},M", now.direction_deg, now.speed_m_s * kKnotsOfAMetrePerSecond,
                     now.speed_m_s);
}

std::string mwd(const core::PlayedMoment& now, const Style& style) {
  return sentence(fmt::format("{}MWD,{}", style.talker, from_north(now)), style);
}

std::string mda(const core::PlayedMoment& now, const Style& style) {
  constexpr std::string_view kWeather = "29.9200,I,1.0132,B,12.5,C,,,55.0,,3.7,C";
  return sentence(fmt::format("{}MDA,{},{}", style.talker, kWeather, from_north(now)), style);
}

std::string from_bow(std::string_view name, const core::PlayedMoment& now, const Style& style) {
  const bool is_left = now.direction_deg > 180.0;
  return sentence(
      fmt::format("{}{},{:.1f},{},{:.2f},N,{:.2f},M,{:.2f},K", style.talker, name,
                  is_left ? 360.0 - now.direction_deg : now.direction_deg, is_left ? 'L' : 'R',
                  now.speed_m_s * kKnotsOfAMetrePerSecond, now.speed_m_s, now.speed_m_s * kKmhOfAMetrePerSecond),
      style);
}
std::string vwr(const core::PlayedMoment& now, const Style& style) {
  return from_bow("VWR", now, style);
}
std::string vwt(const core::PlayedMoment& now, const Style& style) {
  return from_bow("VWT", now, style);
}

std::string xdr(const core::PlayedMoment& now, const Style& style) {
  const auto turned = [&](double by_deg) { return whole_deg(now.direction_deg + by_deg + 360.0); };
  return sentence(
      fmt::format("{}XDR,A,{},D,0,A,{},D,1,A,{},D,2,S,{:.1f},M,0,S,{:.1f},M,1,S,{:.1f},M,2", style.talker, turned(-5.0),
                  turned(0.0), turned(5.0), 0.9 * now.speed_m_s, now.speed_m_s, 1.1 * now.speed_m_s),
      style);
}

std::string gill(const core::PlayedMoment& now, const Style& style) {
  const std::string direction = now.speed_m_s < kGillCalm_m_s ? "" : fmt::format("{:03}", whole_deg(now.direction_deg));
  return gill_frame(fmt::format("{},{},{:06.2f},M,00,", style.node, direction, now.speed_m_s), style);
}

std::string gill_uv(const core::PlayedMoment& now, const Style& style) {
  const double from_rad = now.direction_deg * kRadPerDeg;
  return gill_frame(fmt::format("{},{:+07.2f},{:+07.2f},M,00,", style.node, -now.speed_m_s * std::cos(from_rad),
                                now.speed_m_s * std::sin(from_rad)),
                    style);
}

std::string ft(const core::PlayedMoment& now, const Style& style) {
  return sentence(fmt::format("{},WVP={:05.1f},{:03},0", style.talker, now.speed_m_s, whole_deg(now.direction_deg)),
                  style);
}

std::string umb(const core::PlayedMoment& now, const Style& style) {
  return sentence(fmt::format("{}MWV,{:05.1f},R,{:05.1f},M,A", style.talker, now.direction_deg, now.speed_m_s), style);
}

/// CRC-16/ARC as three characters.
std::string wxt_characters(std::string_view text) {
  unsigned crc = 0;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int i = 0; i < 8; ++i) crc = crc % 2 == 1 ? (crc / 2) ^ 0xA001U : crc / 2;
  }
  return {static_cast<char>('@' + crc / 4096), static_cast<char>('@' + crc / 64 % 64),
          static_cast<char>('@' + crc % 64)};
}

std::string wxt(const core::PlayedMoment& now, const Style& style) {
  const auto turned = [&](double by_deg) { return whole_deg(now.direction_deg + by_deg + 360.0); };
  const std::string body =
      fmt::format("{}r1,Dn={:03}D,Dm={:03}D,Dx={:03}D,Sn={:.1f}M,Sm={:.1f}M,Sx={:.1f}M", style.address, turned(-5.0),
                  turned(0.0), turned(5.0), 0.9 * now.speed_m_s, now.speed_m_s, 1.1 * now.speed_m_s);
  return body + wxt_characters(body + std::string(style.checksum_error, '?')) + "\r\n";
}

bool is_ft_request(std::string_view line) {
  return line.starts_with("$01,WV?*");
}
bool is_umb_request(std::string_view line) {
  return line == "01TR4";
}
bool is_wxt_request(std::string_view line) {
  return line == "0r1Goe";
}

struct Format {
  std::string_view name;
  std::string (*send_messages)(const core::PlayedMoment& now, const Style& style);
  bool (*is_request)(std::string_view line) = nullptr;
};
constexpr std::array<Format, 11> kFormats = {{{"mwv", mwv},
                                              {"mwd", mwd},
                                              {"vwr", vwr},
                                              {"vwt", vwt},
                                              {"mda", mda},
                                              {"xdr", xdr},
                                              {"gill", gill},
                                              {"gill-uv", gill_uv},
                                              {"ft", ft, is_ft_request},
                                              {"umb", umb, is_umb_request},
                                              {"wxt", wxt, is_wxt_request}}};

class NmeaDevice final : public Device {
 public:
  explicit NmeaDevice(std::vector<Format> formats) : formats_(std::move(formats)) {}

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kBadChecksum, core::FaultKind::kWrongId};
    return kKnown;
  }

  std::vector<std::string> send_messages(const core::PlayedMoment& moment,
                                         std::optional<core::FaultKind> fault) override {
    Style style;
    if (fault == core::FaultKind::kBadChecksum) style.checksum_error = 1;
    if (fault == core::FaultKind::kWrongId) {
      style.talker = "II";
      style.node = 'R';
      style.address = '1';
    }
    std::vector<std::string> messages;
    messages.reserve(formats_.size());
    for (const Format& format : formats_) messages.push_back(format.send_messages(moment, style));
    return messages;
  }

  bool is_request(std::string_view line) const override {
    return std::ranges::any_of(formats_,
                               [&](const Format& format) { return format.is_request && format.is_request(line); });
  }

 private:
  std::vector<Format> formats_;
};

}  // namespace

std::vector<std::string> nmea_format_names() {
  std::vector<std::string> names;
  names.reserve(kFormats.size());
  for (const Format& format : kFormats) names.emplace_back(format.name);
  return names;
}

std::unique_ptr<Device> make_nmea_device(const std::vector<std::string>& formats) {
  std::vector<Format> chosen;
  for (const std::string& name : formats) {
    const auto found = std::ranges::find(kFormats, name, &Format::name);
    if (found == kFormats.end()) {
      throw std::runtime_error(
          fmt::format("no simulated format \"{}\"; known: {}", name, fmt::join(nmea_format_names(), ", ")));
    }
    chosen.push_back(*found);
  }
  return std::make_unique<NmeaDevice>(std::move(chosen));
}

bool is_only_polled(std::string_view nmea_format) {
  return nmea_format == "umb";
}

}  // namespace yuragi::simulators::text
