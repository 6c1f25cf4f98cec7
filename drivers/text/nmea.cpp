// Anemometers that send text, by themselves or on request: NMEA 0183 and its variants (drivers/SOURCES.md S4), and the
// formats of Gill, FT Technologies, Lufft and Vaisala, over a serial line, a TCP server, UDP datagrams, a file or a
// pipe. The formats are described with their decoders: drivers/decode/text. Requests:
//
//   format  request                   source
//   umb     "01TR4" CR                Lufft V200A-UMB manual V25, 20.5.4
//   ft      "$01,WV?*hh" CR LF        FT Technologies FT702LT manual, 5.3
//   wxt     "0r1Goe" CR LF            Vaisala WXT530 user's guide M211840EN, 7.2, polling with CRC
//   others  as configured (a WindSonic in polled mode M3 needs its node letter)
#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/decode/text/wxt.hpp"
#include "drivers/sensor/driver.hpp"
#include "drivers/sensor/serial_or_tcp.hpp"
#include "drivers/text/byte_port_parameters.hpp"
#include "drivers/text/nmea_sensor.hpp"
#include "engine/base/fields.hpp"

namespace yuragi::drivers::text {
namespace {

constexpr std::array<std::string_view, 6> kNmeaFormats = {"auto", "nmea", "gill", "ft", "umb", "wxt"};
constexpr std::array<std::string_view, 3> kMissingChecksum = {"auto", "accept", "refuse"};
constexpr std::array<std::string_view, 2> kMissingStatus = {"accept", "refuse"};
constexpr std::array<std::string_view, 6> kSentences = {"MWV", "MWD", "VWR", "VWT", "MDA", "XDR"};
constexpr Nanoseconds kUmbInterval = std::chrono::seconds(1);

struct NmeaKeys {
  NmeaSensorSettings settings;
  std::string sentences;
  std::string missing_checksum;
  std::string address;
};

auto of_nmea(auto member) {
  return member_of(&NmeaKeys::settings, member);
}

decode::WhenMissing when_missing(const std::string& word) {
  return word == "accept" ? decode::WhenMissing::kAccept : decode::WhenMissing::kRefuse;
}

const Fields<NmeaKeys> kNmeaFields = {
    {{.name = "format",
      .default_value = std::string("auto"),
      .help = "auto: detected for each line; ft, umb and wxt also send the requests of these devices",
      .choices = kNmeaFormats},
     of_nmea(&NmeaSensorSettings::format)},
    {{.name = "sentences",
      .default_value = std::string(""),
      .help = "nmea: accept only these, separated by commas: MWV, MWD, VWR, VWT, MDA, XDR; empty: all"},
     &NmeaKeys::sentences},
    {{.name = "talker",
      .default_value = std::string(""),
      .help = "accept only this talker: two characters before the sentence (WI), Gill's node letter (Q), a WXT's "
              "address (0); empty: any"},
     of_nmea(&NmeaSensorSettings::talker)},
    {{.name = "missing_checksum",
      .default_value = std::string("auto"),
      .help = "lines without a checksum; auto: NMEA sentences and those of a WXT are accepted over a network and from "
              "a file, and refused on a serial line, where nothing else detects a wrong bit; the other makers' own "
              "formats always have one. A wrong checksum is always refused",
      .choices = kMissingChecksum},
     &NmeaKeys::missing_checksum},
    {{.name = "missing_status",
      .default_value = std::string("accept"),
      .help = "lines without their status field; accepted ones are marked uncertain",
      .choices = kMissingStatus},
     of_nmea(&NmeaSensorSettings::status),
     when_missing},
    {{.name = "address",
      .default_value = std::string(""),
      .help = "ft, umb: address of the device, two characters (01 by default); wxt: one (0 by default)"},
     &NmeaKeys::address},
    {{"xdr_id", "", std::int64_t{0}, 0, 99, "nmea: number of the device in XDR sentences (Vaisala's address)"},
     of_nmea(&NmeaSensorSettings::xdr_first_id)},
    {{"speed_range", "m/s", 75.0, 1.0, 120.0, "umb: full scale in Lufft's ASCII mode; a VENTUS has 90"},
     of_nmea(&NmeaSensorSettings::speed_range_m_s)},
};

std::vector<Parameter> nmea_parameters() {
  std::vector<Parameter> own = together(kNmeaFields.parameters(), chosen_wind_parameters());
  std::ranges::find(own, "reference", &Parameter::name)->help =
      "which direction to use if a device sends several: from north (MWD, MDA), relative to its own mark (MWV R, "
      "VWR, "
      "XDR, Gill, FT, UMB, WXT), true (MWV T, VWT); auto: the first of these that it sends";
  return with_byte_port_parameters(own, 0.0);
}
const std::vector<Parameter> kNmeaParameters = nmea_parameters();

std::vector<std::string> sentences_of(const std::string& list) {
  std::vector<std::string> sentences;
  const decode::TextFields fields = decode::split_fields(list, ',');
  for (std::size_t i = 0; i < fields.count; ++i) {
    if (fields[i].empty()) continue;
    if (std::ranges::find(kSentences, fields[i]) == kSentences.end()) {
      throw std::runtime_error(fmt::format("sentences: no wind in \"{}\"; allowed: {}, separated by commas", fields[i],
                                           fmt::join(kSentences, ", ")));
    }
    sentences.emplace_back(fields[i]);
  }
  return sentences;
}

/// The request of the format's devices; empty if there is none.
std::string request_of(NmeaFormat format, const std::string& device) {
  if (format == NmeaFormat::kUmb) return device + "TR4\r";
  if (format == NmeaFormat::kFt)
    return fmt::format("${0},WV?*{1:02X}\r\n", device, decode::xor_checksum(device + ",WV?"));
  if (format == NmeaFormat::kWxt) return decode::text::wxt_wind_request(device.front());
  return "";
}

/// The address of the device to request from.
std::string device_of(NmeaFormat format, const std::string& given) {
  const bool is_wxt = format == NmeaFormat::kWxt;
  if (given.empty()) return is_wxt ? "0" : "01";
  if (given.size() != (is_wxt ? 1U : 2U)) {
    throw std::runtime_error(fmt::format("address: is \"{}\"; allowed: {}", given,
                                         is_wxt ? "one character, as in \"0\"" : "two characters, as in \"01\""));
  }
  return given;
}

/// The request and its interval, for a polled device.
void set_request(NmeaSensorSettings& settings, const std::string& address) {
  SensorSettings& text = settings.text;
  const bool can_be_polled =
      text.address.kind == bus::BytePortKind::kSerial || text.address.kind == bus::BytePortKind::kTcpClient;
  // A Lufft sends nothing without a request.
  if (settings.format == NmeaFormat::kUmb && text.poll_interval == Nanoseconds::zero() && can_be_polled) {
    text.poll_interval = kUmbInterval;
  }
  if (text.poll_interval == Nanoseconds::zero() || !text.request.empty()) return;
  text.request = request_of(settings.format, device_of(settings.format, address));
  if (text.request.empty()) {
    throw std::runtime_error("request: is missing; only formats ft, umb and wxt have a default request");
  }
}

}  // namespace

NmeaSensorSettings nmea_sensor_settings_of(const ParameterValues& values) {
  NmeaKeys keys = kNmeaFields.of(values);
  NmeaSensorSettings& settings = keys.settings;
  settings.text = text_sensor_settings_of(values);
  settings.sentences = sentences_of(keys.sentences);
  settings.wind = chosen_wind_settings_of(values);

  const std::string& checksum = keys.missing_checksum;
  const bool is_serial = settings.text.address.kind == bus::BytePortKind::kSerial;
  const bool accepts = checksum == "accept" || (checksum == "auto" && !is_serial);
  settings.checksum = accepts ? decode::WhenMissing::kAccept : decode::WhenMissing::kRefuse;
  settings.makers_checksum = when_missing(checksum);
  set_request(settings, keys.address);
  settings.wind.comes_in_bursts = settings.text.poll_interval == Nanoseconds::zero();
  return settings;
}

namespace {

/// A talker, sentences, a direction's reference and a number in XDR select among what comes through one port.
sensor::ValueSelection nmea_selection(const ParameterValues& values) {
  const NmeaSensorSettings settings = nmea_sensor_settings_of(values);
  return text_selection(settings.text, {{.key = "talker", .value = settings.talker},
                                        {.key = "sentences",
                                         .value = fmt::format("{}", fmt::join(settings.sentences, ",")),
                                         .covers = sensor::list_covers},
                                        reference_part(settings.wind),
                                        {.key = "xdr_id", .value = std::to_string(settings.xdr_first_id)}});
}

/// A WXT's "Sm" is the mean of its averaging time. Of the other formats it depends on the device. Source:
/// drivers/SOURCES.md S4.7.
std::optional<sensor::StatedValue> nmea_value(const ParameterValues& values) {
  if (kNmeaFields.of(values).settings.format != NmeaFormat::kWxt) return std::nullopt;
  return sensor::StatedValue{.value = wind::ReadingValue::kMean, .source = "Vaisala M211840EN: Sm"};
}

/// The formats for yuragi-sim, for a sensor's formats and sentences.
std::string simulated_formats(const ParameterValues& values) {
  const std::string& format = values.text("format");
  if (format != "auto" && format != "nmea") return format;
  std::string sentences;
  for (const char c : values.text("sentences")) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0)
      sentences += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (!sentences.empty()) return sentences;
  if (values.text("reference") == "north") return "mwd";
  return values.text("reference") == "true" ? "vwt" : "mwv";
}

Result<sensor::SimulatedDevice, Failure> nmea_simulated(const ParameterValues& values) {
  const std::string formats = simulated_formats(values);
  const std::string& reference = values.text("reference");
  sensor::SimulatedDevice simulated = sensor::simulated_by_tcp("nmea", values, {"--format", formats});
  // The simulator's own names, which are no fault of the configuration.
  simulated.values.set("talker", std::string());
  simulated.values.set("address", std::string("01"));
  simulated.values.set("xdr_id", std::int64_t{0});
  const bool reports_north = formats.find("mwd") != std::string::npos || formats.find("mda") != std::string::npos;
  if (!reports_north || (reference != "north" && reference != "auto"))
    simulated.north_offset_deg = values.number("north_offset");
  return simulated;
}

}  // namespace

extern const sensor::DriverDescription kNmeaDriver;
const sensor::DriverDescription kNmeaDriver{
    .name = "nmea",
    .summary = "anemometers that send NMEA 0183, or the text of Gill, FT Technologies, Lufft or Vaisala",
    .parameters = kNmeaParameters,
    .open = [](const ParameterValues& values) -> std::unique_ptr<sensor::Sensor> {
      const NmeaSensorSettings settings = nmea_sensor_settings_of(values);
      return std::make_unique<NmeaSensor>(settings, bus::make_byte_port(settings.text.address));
    },
    .find =
        [] {
          return sensor::find_behind_serial_ports("transport = \"serial\"\n",
                                                  "\nbaud = 4800  # or 9600, 19200: as the anemometer is set");
        },
    .endpoints = byte_port_endpoints,
    .selection = nmea_selection,
    .stated_value = nmea_value,
    .simulated = nmea_simulated,
    .formats = "nmea gill umb ft wxt"};

}  // namespace yuragi::drivers::text
