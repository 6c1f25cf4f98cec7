#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/marine/bus_line.hpp"
#include "drivers/decode/text/line.hpp"
#include "drivers/decode/text/line_assembler.hpp"
#include "drivers/decode/text_fields.hpp"
#include "drivers/decode/usb/cup_counter.hpp"
#include "drivers/decode/usb/labjack.hpp"
#include "drivers/decode/usb/potentiometer_vane.hpp"

namespace yuragi::daemon::tools::decode {

// The formats of `yuragi decode`: the drivers' own decoders, applied to a sequence of messages.

/// One received message: a line, a report, a reply.
struct RawUnit {
  drivers::decode::ByteSpan bytes;
  drivers::decode::ByteSpan request;  ///< the request; empty if unknown
};

/// The content of a message. Of a counter: its count and its analogue input; the wind is empty unless the options
/// define the conversion.
struct UnitReading {
  drivers::decode::DecodedWind wind;
  std::optional<std::uint32_t> count;
  std::optional<double> volts;
};

/// Why a message has no reading.
struct UnitRefusal {
  drivers::decode::Refusal why = drivers::decode::Refusal::kMalformed;
  std::string detail;  ///< more about it, for people; can be empty
};

/// Decodes messages in the order in which they were received. Thread-safe: no.
class UnitDecoder {
 public:
  using Outcome = Result<UnitReading, UnitRefusal>;
  using Sink = std::function<void(const Outcome&)>;

  virtual ~UnitDecoder() = default;
  /// Calls `sink` with each reading in the message, or with the refusal. Need not call it if a frame of the format
  /// spans several messages.
  virtual void take(const RawUnit& unit, const Sink& sink) = 0;
  /// Called at the end of the input.
  virtual void finish(const Sink& /*sink*/) {}
};

/// Policies, and facts that are not in the messages. Each format uses its own. The defaults are those of the drivers,
/// of messages from a file.
struct UnitDecoderOptions {
  drivers::decode::WhenMissing checksum = drivers::decode::WhenMissing::kAccept;         ///< nmea, wxt
  drivers::decode::WhenMissing makers_checksum = drivers::decode::WhenMissing::kRefuse;  ///< gill, umb, ft
  drivers::decode::WhenMissing status = drivers::decode::WhenMissing::kAccept;           ///< nmea, gill, umb, ft
  int xdr_first_id = 0;                                                                  ///< nmea
  std::optional<char> node;                                                              ///< gill
  std::optional<std::uint16_t> umb_device;                                               ///< umb
  double umb_speed_range_m_s = 75.0;                                                     ///< umb
  drivers::decode::text::LineOptions line;                                               ///< line
  drivers::decode::marine::BusLineOptions bus_lines;                                     ///< nmea2000
  bool are_reports = false;  ///< wmr100, te923, fineoffset: input reports of 8 bytes, as received

  std::string profile;      ///< modbus: a name, or the path of a .toml file
  int speed_slave = 0;      ///< modbus; 0 takes the profile's
  int direction_slave = 0;  ///< modbus; 0 takes the profile's

  // mcc1208, labjack. Two counts give a speed only if the time between them is known.
  std::optional<double> interval_s;          ///< from one reply to the next
  drivers::decode::usb::CupCalibration cup;  ///< used if there is an interval
  drivers::decode::usb::LabjackInput input = drivers::decode::usb::LabjackInput::kLowVoltage;
  std::optional<double>
      vane_reference_v;  ///< voltage across the vane's potentiometer; the input then measures its wiper
  drivers::decode::usb::VaneCalibration vane;
};

/// A format of the command.
struct UnitFormat {
  std::string_view name;
  bool is_text = true;  ///< lines of text; otherwise bytes, given as hexadecimal digits
  drivers::decode::text::LineEnding ending = drivers::decode::text::LineEnding::kNewline;
  std::size_t longest_line = drivers::decode::text::LineAssembler::kMaxLine;  ///< longer ones are refused
  std::string_view unit;
  std::string_view devices;
  std::string_view example;  ///< a command line, without `yuragi decode`
  /// Throws std::runtime_error for invalid options.
  std::function<std::unique_ptr<UnitDecoder>(const UnitDecoderOptions& options)> make;
};

/// All of them, in the order of the help: those with options, then those that drivers describe (MessageFormat).
std::span<const UnitFormat> unit_formats();

/// The format of this name; nullptr: there is none.
const UnitFormat* find_unit_format(std::string_view name);

/// Converts the result of a pure decoder.
UnitDecoder::Outcome outcome_of(const Result<drivers::decode::DecodedWind, drivers::decode::Refusal>& decoded);

/// The decoders in files of their own, which combine several messages.
std::unique_ptr<UnitDecoder> make_wmr100_reports_decoder(std::unique_ptr<UnitDecoder> stream);
std::unique_ptr<UnitDecoder> make_te923_reports_decoder();
std::unique_ptr<UnitDecoder> make_fineoffset_reports_decoder();
std::unique_ptr<UnitDecoder> make_nmea2000_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_signalk_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_tempest_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_ecowitt_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_station_push_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_weatherlink_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_modbus_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_mcc1208_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_labjack_unit_decoder(const UnitDecoderOptions& options);

}  // namespace yuragi::daemon::tools::decode
