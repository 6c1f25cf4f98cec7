// `yuragi decode mcc1208` and `labjack`: replies are counts and voltages, which the options convert to wind.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "daemon/tools/decode/decode_formats.hpp"
#include "drivers/decode/usb/mcc1208.hpp"

namespace yuragi::daemon::tools::decode {
namespace {

/// The content of a reply.
struct CounterReply {
  std::optional<std::uint32_t> count;
  std::optional<double> volts;        ///< of the vane's wiper, if there is a vane
  std::optional<double> reference_v;  ///< across the vane's potentiometer, if the reply contains it
};

/// Converts counts and voltages to wind, reply by reply.
class CounterMeaning {
 public:
  explicit CounterMeaning(const UnitDecoderOptions& options) : options_(options) {}

  /// The wind of a reply, as far as the options allow. Refused: the counter decreased, or increased by more than any
  /// wind could make it.
  UnitDecoder::Outcome of(const CounterReply& reply) {
    UnitReading reading;
    reading.count = reply.count;
    reading.volts = reply.volts;
    const auto reference_v = reply.reference_v ? reply.reference_v : options_.vane_reference_v;
    if (reply.volts && reference_v) {
      reading.wind.direction_deg = drivers::decode::usb::vane_direction_deg(options_.vane, *reply.volts, *reference_v);
    }
    if (reply.count && options_.interval_s) {
      const auto speed_m_s = drivers::decode::usb::advance_cup(cup_, options_.cup, *reply.count, *options_.interval_s);
      if (speed_m_s && !*speed_m_s) return UnitRefusal{speed_m_s->error(), "the counter went back or jumped"};
      if (speed_m_s) reading.wind.speed_m_s = **speed_m_s;
    }
    return reading;
  }

  /// After a refused reply: the time between the next two counts is not known.
  void interrupt() { cup_ = {}; }

 private:
  UnitDecoderOptions options_;
  drivers::decode::usb::CupState cup_;
};

/// Replies to control transfers, identified by the setup packet before them, or by their length.
class Mcc1208Decoder final : public UnitDecoder {
 public:
  explicit Mcc1208Decoder(const UnitDecoderOptions& options) : meaning_(options) {}

  void take(const RawUnit& unit, const Sink& sink) override {
    const drivers::decode::ByteSpan setup = unit.request.size() == 8 ? unit.request : drivers::decode::ByteSpan();
    const bool is_polled = !setup.empty();
    if (is_polled && setup[1] == drivers::decode::usb::mcc1208_read_calibration(0).request)
      return take_calibration(unit, sink);

    const bool is_analog =
        is_polled ? setup[1] == drivers::decode::usb::mcc1208_read_analog(0).request : unit.bytes.size() == 2;
    CounterReply reply;
    std::optional<drivers::decode::Refusal> why;
    if (is_analog) {
      const auto analog = drivers::decode::usb::decode_mcc1208_analog(unit.bytes);
      if (analog) {
        reply.volts = drivers::decode::usb::mcc1208_volts(
            *analog, is_polled ? calibrations_[setup[2] % drivers::decode::usb::kMcc1208Inputs]
                               : drivers::decode::usb::Mcc1208Calibration{});
      } else {
        why = analog.error();
      }
    } else {
      const auto count = drivers::decode::usb::decode_mcc1208_count(unit.bytes);
      if (count) {
        reply.count = *count;
      } else {
        why = count.error();
      }
    }
    if (!why) return sink(meaning_.of(reply));
    meaning_.interrupt();
    sink(UnitRefusal{*why, {}});
  }

 private:
  /// The calibration of an input, for its later values. An unwritten one is ignored.
  void take_calibration(const RawUnit& unit, const Sink& sink) {
    const auto calibration = drivers::decode::usb::decode_mcc1208_calibration(unit.bytes);
    if (!calibration) return sink(UnitRefusal{calibration.error(), "the calibration of an input"});
    const auto channel = static_cast<std::size_t>(unit.request[2] / 8U);
    calibrations_[channel % drivers::decode::usb::kMcc1208Inputs] = *calibration;
  }

  std::array<drivers::decode::usb::Mcc1208Calibration, drivers::decode::usb::kMcc1208Inputs> calibrations_{};
  CounterMeaning meaning_;
};

/// The command of a feedback reply: as given; else guessed from its echo and length.
drivers::decode::usb::LabjackRequest labjack_request_of(const RawUnit& unit) {
  constexpr std::size_t kCommandEcho = 6;
  constexpr std::size_t kReplyEcho = 8;
  constexpr std::uint8_t kAnalog = 0x01;
  constexpr std::uint8_t kCounter0 = 0x36;
  drivers::decode::usb::LabjackRequest request;
  if (unit.request.size() <= kCommandEcho) {
    if (unit.bytes.size() > kReplyEcho) request.echo = unit.bytes[kReplyEcho];
    if (unit.bytes.size() == 12) request.counter.reset();
    if (unit.bytes.size() == 14) request.analog_channel.reset();
    return request;
  }

  request = {.echo = unit.request[kCommandEcho], .analog_channel = {}, .reference_channel = {}, .counter = {}};
  for (drivers::decode::ByteSpan parts = unit.request.subspan(kCommandEcho + 1); parts.size() >= 2;) {
    const bool is_analog = parts[0] == kAnalog;
    if (is_analog) {
      (request.analog_channel ? request.reference_channel : request.analog_channel) = parts[1];
    } else if (parts[0] == kCounter0 || parts[0] == kCounter0 + 1) {
      request.counter = static_cast<std::uint8_t>(parts[0] - kCounter0);
    }
    parts = parts.subspan(std::min<std::size_t>(is_analog ? 3 : 2, parts.size()));
  }
  return request;
}

class LabjackDecoder final : public UnitDecoder {
 public:
  explicit LabjackDecoder(const UnitDecoderOptions& options)
      : calibration_(drivers::decode::usb::nominal_labjack_calibration(options.input)), meaning_(options) {}

  void take(const RawUnit& unit, const Sink& sink) override {
    const auto reply = drivers::decode::usb::decode_labjack(labjack_request_of(unit), unit.bytes);
    if (!reply) {
      meaning_.interrupt();
      const bool has_code = reply.error().why == drivers::decode::Refusal::kException && reply.error().error != 0;
      return sink(UnitRefusal{reply.error().why, has_code ? fmt::format("error {}", reply.error().error) : ""});
    }
    const auto volts = [this](std::optional<std::uint16_t> analog) {
      return analog ? std::optional(calibration_.volts(*analog)) : std::nullopt;
    };
    sink(meaning_.of({reply->count, volts(reply->analog), volts(reply->reference)}));
  }

 private:
  drivers::decode::usb::LabjackCalibration calibration_;
  CounterMeaning meaning_;
};

}  // namespace

std::unique_ptr<UnitDecoder> make_mcc1208_unit_decoder(const UnitDecoderOptions& options) {
  return std::make_unique<Mcc1208Decoder>(options);
}

std::unique_ptr<UnitDecoder> make_labjack_unit_decoder(const UnitDecoderOptions& options) {
  return std::make_unique<LabjackDecoder>(options);
}

}  // namespace yuragi::daemon::tools::decode
