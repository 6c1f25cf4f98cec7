#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/decode/decoded_wind.hpp"
#include "drivers/decode/text/line.hpp"
#include "drivers/decode/text/line_assembler.hpp"
#include "drivers/decode/text_fields.hpp"
#include "drivers/decode/usb/cup_counter.hpp"
#include "drivers/decode/usb/labjack.hpp"
#include "drivers/decode/usb/potentiometer_vane.hpp"

namespace yuragi {

// What `yuragi decode` knows: the drivers' own decoders, each over messages one after the other.

/// One message as it came: a line, a report, a reply.
struct RawUnit {
  ByteSpan bytes;
  ByteSpan request;  ///< what it answers; empty where that was not given
};

/// What a message says. Of a counter: what it counted, and what its analogue input has; the wind is empty as long as
/// nobody said what these mean.
struct UnitReading {
  DecodedWind wind;
  std::optional<std::uint32_t> count;
  std::optional<double> volts;
};

/// Why a message says nothing.
struct UnitRefusal {
  Refusal why = Refusal::kMalformed;
  std::string detail;  ///< more about it, for people; may be empty
};

/// Decodes messages in the order in which they came. Thread-safe: no.
class UnitDecoder {
 public:
  using Outcome = Result<UnitReading, UnitRefusal>;
  using Sink = std::function<void(const Outcome&)>;

  virtual ~UnitDecoder() = default;
  /// Tells `sink` of each reading in the message, or why there is none. May tell nothing where the format's frames do
  /// not end with a message.
  virtual void take(const RawUnit& unit, const Sink& sink) = 0;
  /// The input ends here.
  virtual void finish(const Sink& /*sink*/) {}
};

/// Policies, and what the messages themselves do not say. Each format reads its own.
struct UnitDecoderOptions {
  WhenMissing checksum = WhenMissing::kRefuse;
  WhenMissing status = WhenMissing::kRefuse;
  int xdr_first_id = 0;                     ///< nmea
  std::optional<char> node;                 ///< gill
  std::optional<std::uint16_t> umb_device;  ///< umb
  double umb_speed_range_m_s = 75.0;        ///< umb
  LineOptions line;                         ///< line
  bool are_reports = false;                 ///< wmr100, te923, fineoffset: input reports of 8 bytes, as they came

  std::string profile;      ///< modbus: a name, or the path of a .toml file
  int speed_slave = 0;      ///< modbus; 0 takes the profile's
  int direction_slave = 0;  ///< modbus; 0 takes the profile's

  // mcc1208, labjack. Two counts make a speed only if it is known how long apart they are.
  std::optional<double> interval_s;  ///< from one reply to the next
  CupCalibration cup;                ///< read where there is an interval
  LabjackInput input = LabjackInput::kLowVoltage;
  std::optional<double> vane_reference_v;  ///< over the vane's track: what is measured is then its wiper
  VaneCalibration vane;
};

/// A format that the command knows by name.
struct UnitFormat {
  std::string_view name;
  bool is_text = true;  ///< lines; otherwise bytes, which come as hexadecimal digits
  LineEnding ending = LineEnding::kNewline;
  std::string_view unit;
  std::string_view devices;
  std::string_view example;  ///< a command line, without `yuragi decode`
  /// Throws std::runtime_error where the options cannot work.
  std::unique_ptr<UnitDecoder> (*make)(const UnitDecoderOptions& options);
};

/// All of them, in the order of the help.
std::span<const UnitFormat> unit_formats();

/// The one of this name; nullptr: there is none.
const UnitFormat* find_unit_format(std::string_view name);

/// What a pure decoder said.
UnitDecoder::Outcome outcome_of(const Result<DecodedWind, Refusal>& decoded);

/// The decoders that have files of their own, since they know more than one message.
std::unique_ptr<UnitDecoder> make_wmr100_reports_decoder(std::unique_ptr<UnitDecoder> stream);
std::unique_ptr<UnitDecoder> make_te923_reports_decoder();
std::unique_ptr<UnitDecoder> make_fineoffset_reports_decoder();
std::unique_ptr<UnitDecoder> make_modbus_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_mcc1208_unit_decoder(const UnitDecoderOptions& options);
std::unique_ptr<UnitDecoder> make_labjack_unit_decoder(const UnitDecoderOptions& options);

}  // namespace yuragi
