// The MCC USB-1208FS-Plus behind the driver "usb". Its messages: drivers/decode/usb/mcc1208.hpp.
#include <array>

#include "drivers/decode/usb/mcc1208.hpp"
#include "drivers/usb/usb_daq.hpp"

namespace yuragi::drivers::usb {
namespace {

class Mcc1208Daq final : public Daq {
 public:
  Mcc1208Daq(const DaqWiring& wiring, Nanoseconds timeout) : wiring_(wiring), timeout_(timeout) {}

  Result<DaqIdentity, DaqTrouble> start(bus::UsbDevice& device, sensor::Sink& sink) override {
    // The counter is not reset: nothing here needs it to begin at 0, and another program may read it.
    for (const auto& [channel, calibration] :
         {std::pair{wiring_.vane_channel, &vane_}, {wiring_.reference_channel, &reference_}}) {
      if (!channel) continue;
      const auto reply = exchange(device, decode::usb::mcc1208_read_calibration(*channel), sink);
      if (!reply) return reply.error();
      const auto decoded = decode::usb::decode_mcc1208_calibration(*reply);
      if (!decoded && decoded.error() != decode::Refusal::kInvalid) return trouble_of(decoded.error(), sink);
      *calibration = decoded ? *decoded : decode::usb::Mcc1208Calibration{};  // never written: nominal values
    }
    return DaqIdentity{};
  }

  Result<DaqSample, DaqTrouble> sample(bus::UsbDevice& device, sensor::Sink& sink) override {
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
    const auto reply = exchange(device, decode::usb::kMcc1208ReadCounter, sink);
    if (!reply) return reply.error();
    const auto count = decode::usb::decode_mcc1208_count(*reply);
    if (!count) return trouble_of(count.error(), sink);
    sample.count = *count;
    return sample;
  }

 private:
  Result<double, DaqTrouble> read_volts(bus::UsbDevice& device, std::uint8_t channel,
                                        const decode::usb::Mcc1208Calibration& calibration, sensor::Sink& sink) {
    const auto reply = exchange(device, decode::usb::mcc1208_read_analog(channel), sink);
    if (!reply) return reply.error();
    const auto analog = decode::usb::decode_mcc1208_analog(*reply);
    if (!analog) return trouble_of(analog.error(), sink);
    return decode::usb::mcc1208_volts(*analog, calibration);
  }

  /// The reply, valid until the next one.
  Result<decode::ByteSpan, DaqTrouble> exchange(bus::UsbDevice& device, const decode::usb::Mcc1208Transfer& command,
                                                sensor::Sink& sink) {
    const std::array<std::uint8_t, 8> setup = {command.request_type, command.request,     low(command.value),
                                               high(command.value),  low(command.index),  high(command.index),
                                               low(command.length),  high(command.length)};
    sink.raw(sensor::RawDirection::kSent, setup);
    const bus::UsbRequest request = {command.request_type, command.request, command.value, command.index};
    const bus::UsbTransfer transfer = device.control(request, std::span(buffer_).first(command.length), timeout_);
    if (transfer.status != bus::UsbStatus::kDone) return trouble_of(transfer.status, sink);
    if (transfer.size > command.length) return trouble_of(bus::UsbStatus::kOverflow, sink);
    const decode::ByteSpan reply = decode::ByteSpan(buffer_).first(transfer.size);
    sink.raw(sensor::RawDirection::kReceived, reply);
    return reply;
  }

  static std::uint8_t low(std::uint16_t value) { return static_cast<std::uint8_t>(value & 0xFFU); }
  static std::uint8_t high(std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8U); }

  DaqWiring wiring_;
  Nanoseconds timeout_;
  decode::usb::Mcc1208Calibration vane_;
  decode::usb::Mcc1208Calibration reference_;
  std::array<std::uint8_t, 8> buffer_{};
};

std::unique_ptr<Daq> make_mcc1208_daq(const DaqWiring& wiring, Nanoseconds timeout) {
  return std::make_unique<Mcc1208Daq>(wiring, timeout);
}

}  // namespace

const DaqModel kMcc1208Model{.name = "mcc1208",
                             .what = "MCC USB-1208FS-Plus",
                             .id = {0x09DB, 0x00E8},
                             .counters = 1,
                             .channels = decode::usb::kMcc1208Inputs,
                             .make = make_mcc1208_daq};

}  // namespace yuragi::drivers::usb
