#include "drivers/text/driver_of_line.hpp"

#include "drivers/decode/marine/bus_line.hpp"
#include "drivers/decode/marine/signalk.hpp"
#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/gill.hpp"
#include "drivers/decode/text/line.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "drivers/decode/text/umb.hpp"
#include "drivers/decode/text/wxt.hpp"

namespace yuragi::drivers::text {
namespace {

using decode::Refusal;
using decode::WhenMissing;

bool is_of_nmea(std::string_view line) {
  using namespace decode::text;
  return decode_nmea({.checksum = WhenMissing::kAccept, .status = WhenMissing::kAccept}, line) ||
         decode_gill({.checksum = WhenMissing::kAccept, .status = WhenMissing::kAccept, .node = std::nullopt}, line) ||
         decode_ft({}, line) || decode_umb({}, line) || decode_wxt({.checksum = WhenMissing::kAccept}, line);
}

bool is_of_nmea2000(std::string_view line) {
  if (!decode::marine::bus_line_format_of(line)) return false;
  decode::marine::BusLineDecoder decoder({});
  const auto decoded = decoder.decode(line);
  return decoded || (decoded.error() != Refusal::kMalformed && decoded.error() != Refusal::kTooShort);
}

bool is_of_keys(std::string_view line) {
  decode::text::LineOptions options;
  options.format = line.starts_with('{') ? decode::text::LineFormat::kJson : decode::text::LineFormat::kKeys;
  const auto decoded = decode::text::decode_line(options, line);
  return decoded && decoded->speed_m_s;
}

}  // namespace

std::optional<std::string_view> driver_of_line(std::string_view line) {
  if (is_of_nmea(line)) return "nmea";
  if (decode::marine::decode_signalk(line) || decode::marine::signalk_hello(line)) return "signalk";
  if (is_of_nmea2000(line)) return "nmea2000";
  if (is_of_keys(line)) return "line";
  return std::nullopt;
}

}  // namespace yuragi::drivers::text
