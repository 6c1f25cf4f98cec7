#include "daemon/tools/decode/decode_formats.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "drivers/decode/hid/fineoffset.hpp"
#include "drivers/decode/hid/te923.hpp"
#include "drivers/decode/hid/wmr100.hpp"
#include "drivers/decode/lufft/umb.hpp"
#include "drivers/decode/marine/signalk.hpp"
#include "drivers/decode/network/ecowitt.hpp"
#include "drivers/decode/network/station_push.hpp"
#include "drivers/decode/network/tempest.hpp"
#include "drivers/decode/text/ft.hpp"
#include "drivers/decode/text/gill.hpp"
#include "drivers/decode/text/nmea.hpp"
#include "drivers/decode/text/umb.hpp"
#include "drivers/decode/text/wxt.hpp"
#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

/// A format in which every message is decoded by itself.
class StatelessDecoder final : public UnitDecoder {
 public:
  using Decode =
      std::function<Result<drivers::decode::DecodedWind, drivers::decode::Refusal>(drivers::decode::ByteSpan message)>;
  explicit StatelessDecoder(Decode decode) : decode_(std::move(decode)) {}

  void take(const RawUnit& unit, const Sink& sink) override { sink(outcome_of(decode_(unit.bytes))); }

 private:
  Decode decode_;
};

/// The bytes of a WMR100's reports, whose frames are not aligned to reports.
class Wmr100Decoder final : public UnitDecoder {
 public:
  void take(const RawUnit& unit, const Sink& sink) override {
    for (const std::uint8_t byte : unit.bytes) {
      if (const auto ended = drivers::decode::hid::take_wmr100_byte(stream_, byte)) sink(outcome_of(*ended));
    }
  }
  void finish(const Sink& sink) override {
    if (const auto ended = drivers::decode::hid::finish_wmr100(stream_)) sink(outcome_of(*ended));
  }

 private:
  drivers::decode::hid::Wmr100Stream stream_;
};

using Made = std::unique_ptr<UnitDecoder>;

Made stateless(StatelessDecoder::Decode decode) {
  return std::make_unique<StatelessDecoder>(std::move(decode));
}

/// A decoder of lines, with options of its own.
template <class Options>
Made of_lines(Result<drivers::decode::DecodedWind, drivers::decode::Refusal> (*decode)(const Options&,
                                                                                       std::string_view) noexcept,
              Options options) {
  return stateless([decode, options = std::move(options)](drivers::decode::ByteSpan line) {
    return decode(options, {reinterpret_cast<const char*>(line.data()), line.size()});
  });
}

Made make_nmea(const UnitDecoderOptions& options) {
  return of_lines(drivers::decode::text::decode_nmea,
                  drivers::decode::text::NmeaOptions{options.checksum, options.status, options.xdr_first_id});
}

Made make_gill(const UnitDecoderOptions& options) {
  drivers::decode::text::GillOptions gill;
  gill.checksum = options.makers_checksum;
  gill.status = options.status;
  gill.node = options.node;
  return of_lines(drivers::decode::text::decode_gill, gill);
}

Made make_ft(const UnitDecoderOptions& options) {
  return of_lines(drivers::decode::text::decode_ft,
                  drivers::decode::text::FtOptions{options.makers_checksum, options.status});
}

Made make_wxt(const UnitDecoderOptions& options) {
  return of_lines(drivers::decode::text::decode_wxt, drivers::decode::text::WxtOptions{options.checksum});
}

Made make_umb(const UnitDecoderOptions& options) {
  return of_lines(drivers::decode::text::decode_umb,
                  drivers::decode::text::UmbOptions{options.makers_checksum, options.status, options.umb_device,
                                                    options.umb_speed_range_m_s});
}

Made make_umb_binary(const UnitDecoderOptions& options) {
  return stateless([device = options.umb_device](drivers::decode::ByteSpan frame)
                       -> Result<drivers::decode::DecodedWind, drivers::decode::Refusal> {
    const auto reply = drivers::decode::lufft::decode_umb_reply(device, frame);
    if (!reply) return reply.error();
    return drivers::decode::lufft::wind_of(*reply);
  });
}

Made make_line(const UnitDecoderOptions& options) {
  return of_lines(drivers::decode::text::decode_line, options.line);
}

Made make_wmr100(const UnitDecoderOptions& options) {
  auto stream = std::make_unique<Wmr100Decoder>();
  if (options.are_reports) return make_wmr100_reports_decoder(std::move(stream));
  return stream;
}

Made make_te923(const UnitDecoderOptions& options) {
  return options.are_reports ? make_te923_reports_decoder() : stateless(drivers::decode::hid::decode_te923);
}

Made make_fineoffset(const UnitDecoderOptions& options) {
  return options.are_reports ? make_fineoffset_reports_decoder()
                             : stateless(drivers::decode::hid::decode_fineoffset_record);
}

/// A driver's own format.
UnitFormat of_driver(const drivers::sensor::MessageFormat& format) {
  return {.name = format.name,
          .is_text = format.is_text,
          .unit = format.unit,
          .devices = format.devices,
          .example = format.example,
          .make = [decode = format.decode](const UnitDecoderOptions&) { return stateless(decode); }};
}

const std::array kFormatsWithOptions = {
    UnitFormat{.name = "nmea",
               .is_text = true,
               .unit = "a line",
               .devices = "NMEA 0183: MWV, MWD, VWR, VWT, MDA, XDR of any talker",
               .example = "nmea voyage.log",
               .make = make_nmea},
    UnitFormat{.name = "gill",
               .is_text = true,
               .unit = "a line",
               .devices = "Gill WindSonic, WindObserver, WindMaster, MaxiMet",
               .example = "gill --node Q mast.log",
               .make = make_gill},
    UnitFormat{.name = "umb",
               .is_text = true,
               .unit = "a line",
               .devices = "Lufft VENTUS, V200A, WS200 to WS800 in a text mode",
               .example = "umb --speed-range 90 ventus.log",
               .make = make_umb},
    UnitFormat{.name = "ft",
               .is_text = true,
               .unit = "a line",
               .devices = "FT Technologies FT205, FT7xx",
               .example = "ft --checksum accept ft742.log",
               .make = make_ft},
    UnitFormat{.name = "wxt",
               .is_text = true,
               .unit = "a line",
               .devices = "Vaisala WXT510 to WXT536, WMT52 in their ASCII protocol",
               .example = "wxt --checksum accept wxt536.log",
               .make = make_wxt},
    UnitFormat{.name = "line",
               .is_text = true,
               .ending = drivers::decode::text::LineEnding::kEtx,
               .unit = "a line",
               .devices = "numbers that a microcontroller prints",
               .example = "line --speed-column 2 --direction-column 1 --speed-unit km/h esp32.log",
               .make = make_line},
    UnitFormat{.name = "nmea2000",
               .is_text = true,
               .longest_line = drivers::decode::marine::kMaxBusLine,
               .unit = "a line",
               .devices = "NMEA 2000 of gateways of Yacht Devices (RAW), Actisense (N2K ASCII), canboat, candump",
               .example = "nmea2000 --angle-unit rad canboatjs.log",
               .make = make_nmea2000_unit_decoder},
    UnitFormat{.name = "signalk",
               .is_text = true,
               .longest_line = drivers::decode::marine::kMaxDelta,
               .unit = "a line",
               .devices = "Signal K deltas; a message with the angle alone is its own reading",
               .example = "signalk deltas.log",
               .make = make_signalk_unit_decoder},
    UnitFormat{.name = "wmr100",
               .is_text = false,
               .unit = "any part of the stream, without each report's length byte",
               .devices = "Oregon Scientific WMR100, WMR88, WMRS200, RMS300, RMS600",
               .example = "wmr100 --hex stream.hex",
               .make = make_wmr100},
    UnitFormat{.name = "fineoffset",
               .is_text = false,
               .unit = "a record of 16 or 20 bytes",
               .devices = "Fine Offset WH1080, WH1090, WH2080, WH3080 and their other names",
               .example = "fineoffset --hex records.hex",
               .make = make_fineoffset},
    UnitFormat{.name = "te923",
               .is_text = false,
               .unit = "the block of readings, of 34 bytes",
               .devices = "Hideki TE923 (Meade, TFA Nexus, Mebus, IROX)",
               .example = "te923 --hex blocks.hex",
               .make = make_te923},
    UnitFormat{.name = "weatherlink",
               .is_text = true,
               .longest_line = 64UL * 1024,
               .unit = "a line: a broadcast, or the reply to current_conditions",
               .devices = "Davis WeatherLink Live",
               .example = "weatherlink broadcasts.json",
               .make = make_weatherlink_unit_decoder},
    UnitFormat{.name = "tempest",
               .is_text = true,
               .longest_line = drivers::decode::network::kMaxTempestMessage,
               .unit = "a line: a message of the hub",
               .devices = "WeatherFlow Tempest, Sky; an observation where no rapid wind came before it",
               .example = "tempest hub.json",
               .make = make_tempest_unit_decoder},
    UnitFormat{.name = "ecowitt",
               .is_text = false,
               .unit = "a reply to the request for the current values",
               .devices = "gateways of Ecowitt and Fine Offset by TCP",
               .example = "ecowitt --hex replies.hex",
               .make = make_ecowitt_unit_decoder},
    UnitFormat{
        .name = "ecowitt-push",
        .is_text = true,
        .longest_line = drivers::decode::network::kMaxStationPush,
        .unit = "a line: a form, or a request with one",
        .devices = "what stations push by the protocols of Ecowitt, Ambient Weather, Weather Underground, WSLink",
        .example = "ecowitt-push pushes.log",
        .make = make_station_push_unit_decoder},
    UnitFormat{.name = "umb-binary",
               .is_text = false,
               .unit = "a frame that replies to a query of channels",
               .devices = "Lufft VENTUS, V200A, WS200 to WS800 in their binary protocol",
               .example = "umb-binary --hex frames.hex",
               .make = make_umb_binary},
    UnitFormat{.name = "mcc1208",
               .is_text = false,
               .unit = "a reply: 4 bytes of the counter, 2 of an analogue input",
               .devices = "a cup and a vane at an MCC USB-1208FS-Plus",
               .example = "mcc1208 --hex --slope 0.765 --interval 0.1 counts.hex",
               .make = make_mcc1208_unit_decoder},
    UnitFormat{.name = "labjack",
               .is_text = false,
               .unit = "a reply to a feedback command",
               .devices = "a cup and a vane at a LabJack U3",
               .example = "labjack --hex --vane-reference 2.4 replies.hex",
               .make = make_labjack_unit_decoder},
    UnitFormat{.name = "modbus:PROFILE",
               .is_text = false,
               .unit = "request | response, of RTU with their checksums or of TCP",
               .devices = "Modbus anemometers: a response alone does not show which register it answers",
               .example = "modbus:renke-rs-fsjt-n01 --hex bus.hex",
               .make = make_modbus_unit_decoder},
};

std::vector<UnitFormat> all_formats() {
  std::vector<UnitFormat> formats(kFormatsWithOptions.begin(), kFormatsWithOptions.end());
  for (const drivers::sensor::DriverDescription* const driver : drivers::sensor::driver_table())
    std::ranges::transform(driver->message_formats, std::back_inserter(formats), of_driver);
  return formats;
}

}  // namespace

UnitDecoder::Outcome outcome_of(const Result<drivers::decode::DecodedWind, drivers::decode::Refusal>& decoded) {
  if (!decoded) return UnitRefusal{decoded.error(), {}};
  return UnitReading{*decoded, {}, {}};
}

std::span<const UnitFormat> unit_formats() {
  static const std::vector<UnitFormat> formats = all_formats();
  return formats;
}

const UnitFormat* find_unit_format(std::string_view name) {
  const auto stem = [](std::string_view whole) { return whole.substr(0, whole.find(':')); };
  const auto fits = [&](const UnitFormat& format) {
    return stem(format.name) == stem(name) &&
           (format.name.find(':') == format.name.npos) == (name.find(':') == name.npos);
  };
  const auto formats = unit_formats();
  const auto found = std::ranges::find_if(formats, fits);
  return found == formats.end() ? nullptr : &*found;
}

}  // namespace yuragi::daemon::tools::decode
