// The LabJack U3 behind the driver "usb". Its messages: drivers/decode/usb/labjack.hpp.
#include <algorithm>
#include <array>
#include <type_traits>

#include <fmt/format.h>

#include "drivers/decode/usb/labjack.hpp"
#include "drivers/usb/usb_daq.hpp"

namespace yuragi::drivers::usb {
namespace {

constexpr std::uint8_t kLabjackCommands = 1;  // the end points
constexpr std::uint8_t kLabjackReplies = 2;
/// How many replies to other requests are skipped before the request is given up.
constexpr int kMaxStrangers = 16;

class LabjackDaq final : public Daq {
 public:
  LabjackDaq(const DaqWiring& wiring, Nanoseconds timeout) : timeout_(timeout) {
    request_.analog_channel = wiring.vane_channel;
    request_.reference_channel = wiring.reference_channel;
    request_.counter = wiring.counter;
  }

  Result<DaqIdentity, DaqTrouble> start(bus::UsbDevice& device, sensor::Sink& sink) override {
    const auto identity =
        exchange(device, sink, decode::usb::encode_labjack_identity(), decode::usb::decode_labjack_identity);
    if (!identity) return identity.error();
    const std::uint8_t counter = *request_.counter;
    const auto configured = exchange(
        device, sink, decode::usb::encode_labjack_configuration(counter),
        [counter](decode::ByteSpan reply) { return decode::usb::decode_labjack_configuration(counter, reply); });
    if (!configured) return configured.error();

    // High voltage inputs have a slope and an offset each, in two blocks; the others share one of both.
    const bool is_high = identity->input == decode::usb::LabjackInput::kHighVoltage;
    const auto slopes =
        exchange(device, sink, decode::usb::encode_labjack_memory(is_high ? 3 : 0), decode::usb::decode_labjack_memory);
    if (!slopes) return slopes.error();
    const auto offsets =
        is_high ? exchange(device, sink, decode::usb::encode_labjack_memory(4), decode::usb::decode_labjack_memory)
                : slopes;
    if (!offsets) return offsets.error();
    for (std::size_t channel = 0; channel < calibrations_.size(); ++channel) {
      const decode::usb::LabjackCalibration own =
          is_high ? decode::usb::LabjackCalibration{(*slopes)[channel], (*offsets)[channel]}
                  : decode::usb::LabjackCalibration{(*slopes)[0], (*slopes)[1]};
      calibrations_[channel] =
          is_believable(own, identity->input) ? own : decode::usb::nominal_labjack_calibration(identity->input);
    }
    return DaqIdentity{fmt::format("{}", identity->serial)};
  }

  Result<DaqSample, DaqTrouble> sample(bus::UsbDevice& device, sensor::Sink& sink) override {
    ++request_.echo;
    const auto reply =
        exchange(device, sink, decode::usb::encode_labjack_feedback(request_),
                 [this](decode::ByteSpan bytes) { return decode::usb::decode_labjack(request_, bytes); });
    if (!reply) return reply.error();
    DaqSample sample;
    sample.count = *reply->count;
    if (reply->analog) sample.wiper_v = calibrations_[*request_.analog_channel].volts(*reply->analog);
    if (reply->reference) sample.reference_v = calibrations_[*request_.reference_channel].volts(*reply->reference);
    return sample;
  }

 private:
  /// Sends a command and decodes its reply. Replies to other commands, such as a late one to the command before, are
  /// counted and skipped.
  template <class Decode>
  auto exchange(bus::UsbDevice& device, sensor::Sink& sink, const decode::usb::LabjackCommand& command, Decode&& decode)
      -> Result<typename decltype(decode(decode::ByteSpan()))::value_type, DaqTrouble> {
    sink.raw(sensor::RawDirection::kSent, command.span());
    const bus::UsbTransfer sent = device.write(kLabjackCommands, command.span(), timeout_);
    if (sent.status != bus::UsbStatus::kDone) return trouble_of(sent.status, sink);
    for (int message = 0; message < kMaxStrangers; ++message) {
      const bus::UsbTransfer got = device.read(kLabjackReplies, buffer_, timeout_);
      if (got.status == bus::UsbStatus::kTimeout && message > 0)
        return DaqTrouble{"replies to other requests, not to this one: check that no other program uses it"};
      if (got.status != bus::UsbStatus::kDone) return trouble_of(got.status, sink);
      const decode::ByteSpan reply = decode::ByteSpan(buffer_).first(std::min(got.size, buffer_.size()));
      sink.raw(sensor::RawDirection::kReceived, reply);
      auto decoded = decode(reply);
      if (decoded) {
        if constexpr (std::is_void_v<typename decltype(decoded)::value_type>) {
          return {};
        } else {
          return *decoded;
        }
      }
      const decode::usb::LabjackRefusal refusal = decoded.error();
      if (refusal.why == decode::Refusal::kException) return exception(refusal.error, sink);
      if (refusal.why != decode::Refusal::kNotMine) return trouble_of(refusal.why, sink);
      sink.refused(decode::Refusal::kNotMine);
    }
    return DaqTrouble{"replies to other requests, not to this one: check that no other program uses it"};
  }

  static DaqTrouble exception(std::uint8_t error, sensor::Sink& sink) {
    sink.refused(decode::Refusal::kException);
    if (error == 0) return {"reports a damaged command: check its cable"};
    return {fmt::format("refuses the command (error {}): check that no other program has configured it", error)};
  }

  Nanoseconds timeout_;
  decode::usb::LabjackRequest request_;
  std::array<decode::usb::LabjackCalibration, 4> calibrations_{};
  std::array<std::uint8_t, 64> buffer_{};  // one packet
};

std::unique_ptr<Daq> make_labjack_daq(const DaqWiring& wiring, Nanoseconds timeout) {
  return std::make_unique<LabjackDaq>(wiring, timeout);
}

}  // namespace

const DaqModel kLabjackModel{.name = "labjack-u3",
                             .what = "LabJack U3",
                             .id = {0x0CD5, 0x0003},
                             .counters = 2,
                             .channels = 4,
                             .make = make_labjack_daq};

}  // namespace yuragi::drivers::usb
