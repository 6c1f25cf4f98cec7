// The MCC USB-1208FS-Plus behind the driver "usb". Its messages: drivers/decode/usb/mcc1208.hpp.
#include <array>

#include "drivers/decode/usb/mcc1208.hpp"
#include "drivers/usb/usb_daq.hpp"

namespace yuragi {
namespace {

class Mcc1208Daq final : public UsbDaq {
 public:
  Mcc1208Daq(const DaqWiring& wiring, Nanoseconds timeout) : wiring_(wiring), timeout_(timeout) {}

  Result<DaqIdentity, DaqTrouble> start(UsbDevice& device, SensorSink& sink) override {
    // The counter is not reset: nothing here needs it to begin at 0, and another program may read it.
    for (const auto& [channel, calibration] :
         {std::pair{wiring_.vane_channel, &vane_}, {wiring_.reference_channel, &reference_}}) {
      if (!channel) continue;
      const auto reply = exchange(device, mcc1208_read_calibration(*channel), sink);
      if (!reply) return reply.error();
      const auto decoded = decode_mcc1208_calibration(*reply);
      if (!decoded && decoded.error() != Refusal::kInvalid) return trouble_of(decoded.error(), sink);
      *calibration = decoded ? *decoded : Mcc1208Calibration{};  // never written: nominal values
    }
    return DaqIdentity{};
  }

  Result<DaqSample, DaqTrouble> sample(UsbDevice& device, SensorSink& sink) override {
    DaqSample sample;
    if (wiring_.vane_channel) {
      const auto volts = read_volts(device, *wiring_.vane_channel, vane_, sink);
      if (!volts) return volts.error();
      sample.wiper_v = *volts;
    }
    if (wiring_.reference_channel) {
      const auto volts = read_volts(device, *wiring_.reference_channel, reference_, sink);
      if (!volts) return volts.error();
      sample.reference_v = *volts;
    }
    // The count last, so that it is as close as possible to the time that the caller assigns to it.
    const auto reply = exchange(device, kMcc1208ReadCounter, sink);
    if (!reply) return reply.error();
    const auto count = decode_mcc1208_count(*reply);
    if (!count) return trouble_of(count.error(), sink);
    sample.count = *count;
    return sample;
  }

 private:
  Result<double, DaqTrouble> read_volts(UsbDevice& device, std::uint8_t channel, const Mcc1208Calibration& calibration,
                                        SensorSink& sink) {
    const auto reply = exchange(device, mcc1208_read_analog(channel), sink);
    if (!reply) return reply.error();
    const auto analog = decode_mcc1208_analog(*reply);
    if (!analog) return trouble_of(analog.error(), sink);
    return mcc1208_volts(*analog, calibration);
  }

  /// The reply, valid until the next one.
  Result<ByteSpan, DaqTrouble> exchange(UsbDevice& device, const Mcc1208Transfer& command, SensorSink& sink) {
    const std::array<std::uint8_t, 8> setup = {command.request_type, command.request,     low(command.value),
                                               high(command.value),  low(command.index),  high(command.index),
                                               low(command.length),  high(command.length)};
    sink.raw(RawDirection::kSent, setup);
    const UsbRequest request = {command.request_type, command.request, command.value, command.index};
    const UsbTransfer transfer = device.control(request, std::span(buffer_).first(command.length), timeout_);
    if (transfer.status != UsbStatus::kDone) return trouble_of(transfer.status, sink);
    if (transfer.size > command.length) return trouble_of(UsbStatus::kOverflow, sink);
    const ByteSpan reply = ByteSpan(buffer_).first(transfer.size);
    sink.raw(RawDirection::kReceived, reply);
    return reply;
  }

  static std::uint8_t low(std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xFFU); }
  static std::uint8_t high(std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8U); }

  DaqWiring wiring_;
  Nanoseconds timeout_;
  Mcc1208Calibration vane_;
  Mcc1208Calibration reference_;
  std::array<std::uint8_t, 8> buffer_{};
};

std::unique_ptr<UsbDaq> make_mcc1208_daq(const DaqWiring& wiring, Nanoseconds timeout) {
  return std::make_unique<Mcc1208Daq>(wiring, timeout);
}

}  // namespace

const UsbDaqModel kMcc1208Model{.name = "mcc1208",
                                .what = "MCC USB-1208FS-Plus",
                                .id = {0x09DB, 0x00E8},
                                .counters = 1,
                                .channels = kMcc1208Inputs,
                                .make = make_mcc1208_daq};

}  // namespace yuragi
