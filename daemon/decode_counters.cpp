// `yuragi decode mcc1208` and `labjack`: replies are counts and voltages; what wind these are, the options say.
#include <fmt/format.h>

#include "daemon/decode_formats.hpp"

namespace yuragi {
namespace {

/// What counts and voltages mean, reply after reply.
class CounterMeaning {
 public:
  explicit CounterMeaning(const UnitDecoderOptions& options) : options_(options) {}

  /// The wind of a reply, as far as the options say. Refused: the counter went back, or on by more than any wind
  /// drives.
  UnitDecoder::Outcome of(std::optional<std::uint32_t> count, std::optional<double> volts) {
    UnitReading reading;
    reading.count = count;
    reading.volts = volts;
    if (volts && options_.vane_reference_v) {
      reading.wind.direction_deg = vane_direction_deg(options_.vane, *volts, *options_.vane_reference_v);
    }
    if (count && options_.interval_s) {
      const auto speed_m_s = advance_cup(cup_, options_.cup, *count, *options_.interval_s);
      if (speed_m_s && !*speed_m_s) return UnitRefusal{speed_m_s->error(), "the counter went back, or on too far"};
      if (speed_m_s) reading.wind.speed_m_s = **speed_m_s;
    }
    return reading;
  }

  /// A reply was no use: how far apart the next two counts are is not known.
  void interrupt() { cup_ = {}; }

 private:
  UnitDecoderOptions options_;
  CupState cup_;
};

class Mcc1208Decoder final : public UnitDecoder {
 public:
  explicit Mcc1208Decoder(const UnitDecoderOptions& options) : range_(options.range), meaning_(options) {}

  void take(const RawUnit& unit, const Sink& sink) override {
    const auto reply = decode_mcc1208(unit.bytes);
    if (!reply) {
      meaning_.interrupt();
      return sink(UnitRefusal{reply.error(), {}});
    }
    std::optional<double> volts;
    if (reply->analog) volts = mcc1208_volts(*reply->analog, range_);
    sink(meaning_.of(reply->count, volts));
  }

 private:
  Mcc1208Range range_;
  CounterMeaning meaning_;
};

/// What a feedback reply answers, by its length and its own echo: it holds an analogue input, the counter, or both.
LabjackRequest labjack_request_of(ByteSpan reply) {
  constexpr std::size_t kEchoAt = 8;
  LabjackRequest request;
  if (reply.size() > kEchoAt) request.echo = reply[kEchoAt];
  if (reply.size() == 12) request.wants_counter = false;
  if (reply.size() == 14) request.analog_channel.reset();
  return request;
}

class LabjackDecoder final : public UnitDecoder {
 public:
  explicit LabjackDecoder(const UnitDecoderOptions& options) : input_(options.input), meaning_(options) {}

  void take(const RawUnit& unit, const Sink& sink) override {
    const auto reply = decode_labjack(labjack_request_of(unit.bytes), unit.bytes);
    if (!reply) {
      meaning_.interrupt();
      const bool has_code = reply.error().why == Refusal::kException && reply.error().error != 0;
      return sink(UnitRefusal{reply.error().why, has_code ? fmt::format("error {}", reply.error().error) : ""});
    }
    std::optional<double> volts;
    if (reply->analog) volts = labjack_volts(*reply->analog, input_);
    sink(meaning_.of(reply->count, volts));
  }

 private:
  LabjackInput input_;
  CounterMeaning meaning_;
};

}  // namespace

std::unique_ptr<UnitDecoder> make_mcc1208_unit_decoder(const UnitDecoderOptions& options) {
  return std::make_unique<Mcc1208Decoder>(options);
}

std::unique_ptr<UnitDecoder> make_labjack_unit_decoder(const UnitDecoderOptions& options) {
  return std::make_unique<LabjackDecoder>(options);
}

}  // namespace yuragi
