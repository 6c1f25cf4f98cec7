// Protocols whose messages are lines of text, but for JSON. A line comes with its end, which may be hurt too.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "drivers/decode/marine/actisense.hpp"
#include "drivers/decode/marine/canboat_plain.hpp"
#include "drivers/decode/marine/candump.hpp"
#include "drivers/decode/marine/yacht_devices.hpp"
#include "drivers/decode/modbus/modbus.hpp"
#include "drivers/decode/network/station_push.hpp"
#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/gill.hpp"
#include "drivers/decode/text/line.hpp"
#include "drivers/decode/text/line_assembler.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "drivers/decode/text/umb.hpp"
#include "drivers/decode/text/wxt.hpp"
#include "engine/base/units.hpp"
#include "tests/hurt/protocol.hpp"

namespace yuragi::hurt {
namespace {

namespace text = drivers::decode::text;
using drivers::decode::WhenMissing;
using drivers::decode::xor_checksum;
using LineWinds = std::vector<DecodedWind>;

/// The winds in lines, one after another, as they are assembled and decoded.
template <class Decode>
LineWinds winds_in_lines(std::string_view bytes, Decode decode) {
  text::LineAssembler assembler;
  LineWinds winds;
  std::span rest(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  while (!rest.empty()) {
    const auto line = assembler.next(rest);
    if (!line || !*line) continue;
    if (const auto wind = decode(**line)) winds.push_back(*wind);
  }
  return winds;
}

/// A wind in tenths, as lines print it.
struct PrintedWind {
  int speed_tenths;
  int direction_deg;

  explicit PrintedWind(Chance& chance) : speed_tenths(chance.between(1, 600)), direction_deg(chance.between(0, 359)) {}
  double speed() const { return speed_tenths / 10.0; }
};

// --- NMEA 0183

std::string sentence(const std::string& body) {
  return fmt::format("${}*{:02X}\r\n", body, xor_checksum(body));
}

Message make_mwv(Chance& chance) {
  const PrintedWind wind(chance);
  const bool is_knots = chance.below(2) == 0;
  return {sentence(fmt::format("WIMWV,{:03},R,{:.1f},{},A", wind.direction_deg, wind.speed(), is_knots ? 'N' : 'M')),
          wind_of(wind.speed() * (is_knots ? kMetresPerSecondPerKnot : 1.0), wind.direction_deg)};
}
Message make_mwd(Chance& chance) {
  const PrintedWind wind(chance);
  return {sentence(fmt::format("WIMWD,{0}.0,T,{1}.0,M,{2:.1f},N,{3:.1f},M", wind.direction_deg,
                               (wind.direction_deg + 357) % 360, wind.speed() / kMetresPerSecondPerKnot, wind.speed())),
          wind_of(wind.speed(), wind.direction_deg)};
}
Message make_vwr(Chance& chance) {
  const PrintedWind wind(chance);
  const int angle_deg = wind.direction_deg % 180;
  return {sentence(fmt::format("IIVWR,{:03},L,{:.1f},N,{:.1f},M,{:.1f},K", angle_deg,
                               wind.speed() / kMetresPerSecondPerKnot, wind.speed(),
                               wind.speed() / kMetresPerSecondPerKmh)),
          wind_of(wind.speed(), std::fmod(360.0 - angle_deg, 360.0))};
}
Message make_xdr(Chance& chance) {
  const PrintedWind least(chance);
  const PrintedWind mean(chance);
  const PrintedWind greatest(chance);
  std::array speeds = {least.speed(), mean.speed(), greatest.speed()};
  std::ranges::sort(speeds);
  return {sentence(fmt::format("WIXDR,A,{:03},D,0,A,{:03},D,1,A,{:03},D,2,S,{:.1f},M,0,S,{:.1f},M,1,S,{:.1f},M,2",
                               least.direction_deg, mean.direction_deg, greatest.direction_deg, speeds[0], speeds[1],
                               speeds[2])),
          wind_of(speeds[1], mean.direction_deg, speeds[2])};
}
LineWinds nmea_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) { return text::decode_nmea({}, line); });
}
/// As devices say it that have no checksum.
Message make_unchecked_mwv(Chance& chance) {
  Message message = make_mwv(chance);
  message.bytes = message.bytes.substr(0, message.bytes.find('*')) + "\r\n";
  return message;
}
LineWinds unchecked_nmea_winds(std::string_view bytes) {
  return winds_in_lines(
      bytes, [](std::string_view line) { return text::decode_nmea({.checksum = WhenMissing::kAccept}, line); });
}

// --- Anemometers' own formats

Message make_gill(Chance& chance) {
  const PrintedWind wind(chance);
  const std::string body = fmt::format("Q,{:03},{:06.2f},M,00,", wind.direction_deg, wind.speed());
  return {fmt::format("\x02{}\x03{:02X}\r\n", body, xor_checksum(body)), wind_of(wind.speed(), wind.direction_deg)};
}
LineWinds gill_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) { return text::decode_gill({}, line); });
}

Message make_ft(Chance& chance) {
  const PrintedWind wind(chance);
  return {sentence(fmt::format("WI,WVP={:05.1f},{:03},0", wind.speed(), wind.direction_deg)),
          wind_of(wind.speed(), wind.direction_deg)};
}
LineWinds ft_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) { return text::decode_ft({}, line); });
}

Message make_umb_ascii(Chance& chance) {
  const int raw = chance.between(0, 65520);
  return {fmt::format("$ 28673 M 00400 {:05}\r\n", raw), wind_of(raw / 65520.0 * 75.0)};
}
LineWinds umb_ascii_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) { return text::decode_umb({.device = 28673}, line); });
}

/// A message that begins so, without its end.
Message make_wxt(std::string_view head, Chance& chance) {
  const PrintedWind wind(chance);
  const double gust = chance.between(wind.speed_tenths, 650) / 10.0;
  return {fmt::format("{},Dn=236D,Dm={:03}D,Dx=031D,Sn=0.0M,Sm={:.1f}M,Sx={:.1f}M", head, wind.direction_deg,
                      wind.speed(), gust),
          wind_of(wind.speed(), wind.direction_deg, gust)};
}
std::uint16_t wxt_crc_of(std::string_view text) {
  unsigned crc = 0;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0xA001U : crc >> 1U;
  }
  return static_cast<std::uint16_t>(crc);
}
Message make_checked_wxt(Chance& chance) {
  Message message = make_wxt("0r1", chance);
  const unsigned crc = wxt_crc_of(message.bytes);
  for (const unsigned bits : {crc >> 12U, (crc >> 6U) & 0x3FU, crc & 0x3FU})
    message.bytes += static_cast<char>(0x40U | bits);
  message.bytes += "\r\n";
  return message;
}
LineWinds checked_wxt_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) { return text::decode_wxt({}, line); });
}
Message make_plain_wxt(Chance& chance) {
  Message message = make_wxt("0R1", chance);
  message.bytes += "\r\n";
  return message;
}
LineWinds plain_wxt_winds(std::string_view bytes) {
  return winds_in_lines(
      bytes, [](std::string_view line) { return text::decode_wxt({.checksum = WhenMissing::kAccept}, line); });
}

// --- Lines without a standard, and frames of NMEA 2000

Message make_columns(Chance& chance) {
  const PrintedWind wind(chance);
  return {fmt::format("{:.1f},{}\r\n", wind.speed(), wind.direction_deg), wind_of(wind.speed(), wind.direction_deg)};
}
Message make_keys(Chance& chance) {
  const PrintedWind wind(chance);
  return {fmt::format("speed={:.1f} direction={}\r\n", wind.speed(), wind.direction_deg),
          wind_of(wind.speed(), wind.direction_deg)};
}
LineWinds line_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) { return text::decode_line({}, line); });
}

Message make_yacht_devices(Chance& chance) {
  const int speed_cm_s = chance.between(0, 6000);
  const int angle = chance.between(0, 62831);
  return {fmt::format("17:33:21.179 R 09FD0205 64 {:02X} {:02X} {:02X} {:02X} FA FF FF\r\n", speed_cm_s & 0xFF,
                      speed_cm_s >> 8, angle & 0xFF, angle >> 8),
          wind_of(speed_cm_s / 100.0, angle / 10'000.0 / kRadPerDeg)};
}
LineWinds yacht_devices_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) -> std::optional<DecodedWind> {
    const auto said = drivers::decode::marine::decode_yacht_devices(line);
    return said ? std::optional(said->wind) : std::nullopt;
  });
}

/// As a CAN interface's frames are handed on, and as a log of candump has them.
Message make_candump(Chance& chance) {
  const int speed_cm_s = chance.between(0, 6000);
  const int angle = chance.between(0, 62831);
  return {fmt::format("(1436509052.249713) can0 09FD0205#64{:02X}{:02X}{:02X}{:02X}FAFFFF\n", speed_cm_s & 0xFF,
                      speed_cm_s >> 8, angle & 0xFF, angle >> 8),
          wind_of(speed_cm_s / 100.0, angle / 10'000.0 / kRadPerDeg)};
}
LineWinds candump_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) -> std::optional<DecodedWind> {
    const auto said = drivers::decode::marine::decode_candump(line);
    return said ? std::optional(said->wind) : std::nullopt;
  });
}

Message make_canboat_plain(Chance& chance) {
  const int speed_cm_s = chance.between(0, 6000);
  const int angle = chance.between(0, 62831);
  return {fmt::format("2018-02-14T15:55:07.944Z,2,130306,5,255,8,64,{:02x},{:02x},{:02x},{:02x},fa,ff,ff\n",
                      speed_cm_s & 0xFF, speed_cm_s >> 8, angle & 0xFF, angle >> 8),
          wind_of(speed_cm_s / 100.0, angle / 10'000.0 / kRadPerDeg)};
}
LineWinds canboat_plain_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) -> std::optional<DecodedWind> {
    const auto said = drivers::decode::marine::decode_canboat_plain(line);
    return said ? std::optional(said->wind) : std::nullopt;
  });
}

Message make_actisense(Chance& chance) {
  const int speed_cm_s = chance.between(0, 6000);
  const int angle = chance.between(0, 62831);
  return {fmt::format("A173321.107 05FF2 1FD02 64{:02X}{:02X}{:02X}{:02X}FAFFFF\r\n", speed_cm_s & 0xFF,
                      speed_cm_s >> 8, angle & 0xFF, angle >> 8),
          wind_of(speed_cm_s / 100.0, angle / 10'000.0 / kRadPerDeg)};
}
LineWinds actisense_winds(std::string_view bytes) {
  return winds_in_lines(bytes, [](std::string_view line) -> std::optional<DecodedWind> {
    const auto said = drivers::decode::marine::decode_actisense(line);
    return said ? std::optional(said->wind) : std::nullopt;
  });
}

/// A form as a gateway pushes it: miles per hour.
Message make_station_push(Chance& chance) {
  const int speed = chance.between(0, 10'000);
  const int gust = chance.between(speed, 12'000);
  const int direction_deg = chance.between(0, 359);
  return {fmt::format("PASSKEY=0123456789ABCDEF0123456789ABCDEF&stationtype=GW2000A_V2.1.5&dateutc=2026-11-23+12:00:00&"
                      "tempf=63.5&humidity=71&winddir={}&windspeedmph={:.2f}&windgustmph={:.2f}&baromabsin=29.9",
                      direction_deg, speed / 100.0, gust / 100.0),
          wind_of(speed / 100.0 * kMetresPerSecondPerMph, direction_deg, gust / 100.0 * kMetresPerSecondPerMph)};
}
/// A form of WSLink: metres per second.
Message make_ws_link_push(Chance& chance) {
  const int speed = chance.between(0, 500);
  const int gust = chance.between(speed, 600);
  const int direction_deg = chance.between(0, 359);
  return {
      fmt::format("wsid=home&wspw=hidden&t1cn=1&t1tem=18.4&t1hum=65&t1wdir={}&t1ws={:.1f}&t1wgust={:.1f}&rbar=1013.2",
                  direction_deg, speed / 10.0, gust / 10.0),
      wind_of(speed / 10.0, direction_deg, gust / 10.0)};
}
LineWinds station_push_winds(std::string_view bytes) {
  const auto push = drivers::decode::network::decode_station_push(bytes);
  if (!push || !push->wind) return {};
  return {*push->wind};
}

constexpr std::array kTextProtocols = {
    Protocol{.name = "NMEA MWV",
             .checksum = Checksum::kXor8,
             .is_stream = true,
             .most_false_of_a_million = 3'800,
             .make = make_mwv,
             .winds_in = nmea_winds},
    Protocol{.name = "NMEA MWD",
             .checksum = Checksum::kXor8,
             .is_stream = true,
             .most_false_of_a_million = 5'100,
             .make = make_mwd,
             .winds_in = nmea_winds},
    Protocol{.name = "NMEA VWR",
             .checksum = Checksum::kXor8,
             .is_stream = true,
             .most_false_of_a_million = 3'900,
             .make = make_vwr,
             .winds_in = nmea_winds},
    Protocol{.name = "NMEA XDR",
             .checksum = Checksum::kXor8,
             .is_stream = true,
             .most_false_of_a_million = 4'800,
             .make = make_xdr,
             .winds_in = nmea_winds},
    Protocol{.name = "NMEA MWV, without",
             .is_stream = true,
             .most_false_of_a_million = 90'000,
             .make = make_unchecked_mwv,
             .winds_in = unchecked_nmea_winds},
    Protocol{.name = "Gill",
             .checksum = Checksum::kXor8,
             .is_stream = true,
             .most_false_of_a_million = 3'900,
             .make = make_gill,
             .winds_in = gill_winds},
    Protocol{.name = "FT",
             .checksum = Checksum::kXor8,
             .is_stream = true,
             .most_false_of_a_million = 3'100,
             .make = make_ft,
             .winds_in = ft_winds},
    Protocol{.name = "UMB-ASCII",
             .is_stream = true,
             .most_false_of_a_million = 26'000,
             .make = make_umb_ascii,
             .winds_in = umb_ascii_winds},
    Protocol{.name = "WXT, with checksum",
             .checksum = Checksum::kCrc16,
             .is_stream = true,
             .most_false_of_a_million = 15,
             .make = make_checked_wxt,
             .winds_in = checked_wxt_winds},
    Protocol{.name = "WXT, without",
             .is_stream = true,
             .most_false_of_a_million = 110'000,
             .make = make_plain_wxt,
             .winds_in = plain_wxt_winds},
    Protocol{.name = "line, columns",
             .is_stream = true,
             .most_false_of_a_million = 240'000,
             .make = make_columns,
             .winds_in = line_winds},
    Protocol{.name = "line, keys",
             .is_stream = true,
             .most_false_of_a_million = 180'000,
             .make = make_keys,
             .winds_in = line_winds},
    Protocol{.name = "Yacht Devices RAW",
             .is_stream = true,
             .most_false_of_a_million = 31'000,
             .make = make_yacht_devices,
             .winds_in = yacht_devices_winds},
    Protocol{.name = "candump",
             .is_stream = true,
             .most_false_of_a_million = 30'000,
             .make = make_candump,
             .winds_in = candump_winds},
    Protocol{.name = "canboat, plain",
             .is_stream = true,
             .most_false_of_a_million = 23'000,
             .make = make_canboat_plain,
             .winds_in = canboat_plain_winds},
    Protocol{.name = "Actisense N2K ASCII",
             .is_stream = true,
             .most_false_of_a_million = 30'000,
             .make = make_actisense,
             .winds_in = actisense_winds},
    Protocol{.name = "Ecowitt push",
             .most_false_of_a_million = 42'000,
             .make = make_station_push,
             .winds_in = station_push_winds},
    Protocol{.name = "WSLink push",
             .most_false_of_a_million = 53'000,
             .make = make_ws_link_push,
             .winds_in = station_push_winds},
};

}  // namespace

std::span<const Protocol> text_protocols() {
  return kTextProtocols;
}

}  // namespace yuragi::hurt
