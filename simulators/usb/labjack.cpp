// LabJack U3-HV, as labjack/exodriver uses it (examples/U3/u3.c and u3.h, liblabjackusb/labjackusb.c). Commands come in
// on bulk end point 1, replies go out on 2. Both begin with sum8, F8, words, command, sum16 (low byte first), and go on
// with:
//
//   00  Feedback   echo, then for each input: 01 channel 1f (AIN against ground), 36 00 (Counter0), 37 00 (Counter1)
//                  reply: error, which of them, echo, then 2 bytes for an AIN, 4 for a counter
//   08  ConfigU3   20 bytes; reply: error, ..., from 15 the serial number, 37 the version: 18 is a U3-HV
//   0B  ConfigIO   mask, 0, timers and counters, DAC1, FIO analogue, EIO analogue; reply: error, 0, the same four
//   2D  ReadMem    0, block; reply: error, 0, 32 bytes: four fixed point numbers, 32 bits behind the point
#include "simulators/usb/labjack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <random>

#include "simulators/usb/cup_and_vane.hpp"

namespace yuragi::simulators::usb {
namespace {

constexpr std::uint8_t kCommandEndpoint = 1;
constexpr std::uint8_t kReplyEndpoint = 2;
constexpr std::size_t kFrameHeader = 6;
constexpr std::size_t kMaxReplies = 16;
constexpr std::uint32_t kSerialNumber = 320'012'345;
constexpr std::uint8_t kCounterPin = 4;  // where the cup is wired to: FIO4
/// Error codes. The maker publishes a list; that these are the right ones is unconfirmed. None is 0.
constexpr std::uint8_t kNotEnabled = 0x50;
constexpr std::uint8_t kNotAnInput = 0x51;

using View = std::span<const std::uint8_t>;

/// The calibration of inputs 0 to 3, each a little off the nominal one.
double volts_per_step(unsigned channel) {
  return 0.000314 * (1.01 + 0.002 * channel);
}
double volts_at_zero(unsigned channel) {
  return -10.3 - 0.05 * (channel + 1.0);
}

std::uint16_t labjack_sum_of(View bytes) {
  unsigned sum = 0;
  for (const std::uint8_t byte : bytes) sum += byte;
  return static_cast<std::uint16_t>(sum);
}

/// The sum of the bytes after the first byte of a header, folded into 8 bits twice.
std::uint8_t folded_sum(View frame) {
  unsigned sum = labjack_sum_of(frame.subspan(1, kFrameHeader - 1));
  sum = (sum & 0xFFU) + (sum >> 8U);
  return static_cast<std::uint8_t>((sum & 0xFFU) + (sum >> 8U));
}

void seal(Bytes& frame) {
  const std::uint16_t sum = labjack_sum_of(View(frame).subspan(kFrameHeader));
  frame[4] = static_cast<std::uint8_t>(sum & 0xFFU);
  frame[5] = static_cast<std::uint8_t>(sum >> 8U);
  frame[0] = folded_sum(frame);
}

bool is_sealed(View frame) {
  if (frame.size() < kFrameHeader || frame[1] != 0xF8 || frame.size() != kFrameHeader + std::size_t{2} * frame[2])
    return false;
  const std::uint16_t sum = labjack_sum_of(frame.subspan(kFrameHeader));
  return frame[4] == (sum & 0xFFU) && frame[5] == sum >> 8U && frame[0] == folded_sum(frame);
}

/// A reply with these bytes behind its header.
Bytes frame_of(std::uint8_t command, const Bytes& data) {
  Bytes frame(kFrameHeader + data.size() + data.size() % 2);
  frame[1] = 0xF8;
  frame[2] = static_cast<std::uint8_t>((frame.size() - kFrameHeader) / 2);
  frame[3] = command;
  std::ranges::copy(data, frame.begin() + kFrameHeader);
  seal(frame);
  return frame;
}

void append_number(Bytes& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

Descriptors labjack_descriptors() {
  return {.device = {18, 1, 0x00, 0x02, 0, 0, 0, 8, 0xD5, 0x0C, 0x03, 0x00, 0x00, 0x01, 1, 2, 0, 1},
          .configuration = {9, 2, 39,   0, 1,  1,    0,    0x80, 250,  // bus powered, 500 mA
                            9, 4, 0,    0, 3,  0xFF, 0xFF, 0xFF, 0,    // one vendor's interface
                            7, 5, 0x01, 2, 64, 0,    0,                // bulk out: commands
                            7, 5, 0x82, 2, 64, 0,    0,                // bulk in: replies
                            7, 5, 0x83, 2, 64, 0,    0},               // bulk in: streamed samples
          .hid_report = {},
          .strings = {"LabJack Corporation", "LabJack U3"}};  // no serial number: ConfigU3 reports it
}

class Labjack final : public Device {
 public:
  const Descriptors& descriptors() const override { return descriptors_; }

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kSilence,
                                          core::FaultKind::kFreeze,
                                          core::FaultKind::kSpike,
                                          core::FaultKind::kGarbage,
                                          core::FaultKind::kPartial,
                                          core::FaultKind::kBadChecksum,
                                          core::FaultKind::kWrongTransaction,
                                          core::FaultKind::kLate,
                                          core::FaultKind::kException,
                                          core::FaultKind::kUnplug};
    return kKnown;
  }

  void advance(double time_s, const core::PlayedMoment& wind, std::optional<core::FaultKind> fault) override {
    fault_ = fault;
    cup_and_vane_.advance(time_s, wind, fault == core::FaultKind::kFreeze);
    if (fault != core::FaultKind::kUnplug) return;
    // Without power it loses its configuration.
    counted_from_ = cup_and_vane_.pulses();
    timers_and_counters_ = 0;
    digital_as_analog_ = {0, 0};
    late_.clear();
    replies_.clear();
  }

  std::optional<Bytes> control(const SetupPacket& /*setup*/, std::span<const std::uint8_t> /*data*/) override {
    return std::nullopt;
  }

  bool out(std::uint8_t endpoint, std::span<const std::uint8_t> data) override {
    if (endpoint != kCommandEndpoint) return false;
    if (fault_ == core::FaultKind::kSilence) return true;
    // A late reply is sent with the next command.
    std::ranges::move(late_, std::back_inserter(replies_));
    late_.clear();
    if (std::optional<Bytes> reply = reply_to(data)) {
      (fault_ == core::FaultKind::kLate ? late_ : replies_).push_back(spoilt(std::move(*reply)));
    }
    while (replies_.size() > kMaxReplies) replies_.pop_front();
    return true;
  }

  std::optional<Bytes> in(std::uint8_t endpoint, std::size_t max_size) override {
    if (endpoint != kReplyEndpoint || replies_.empty() || fault_ == core::FaultKind::kSilence) return std::nullopt;
    Bytes& next = replies_.front();
    const auto size = static_cast<std::ptrdiff_t>(std::min(max_size, next.size()));
    Bytes part(next.begin(), next.begin() + size);
    next.erase(next.begin(), next.begin() + size);
    if (next.empty()) replies_.pop_front();
    return part;
  }

 private:
  std::optional<Bytes> reply_to(View command) {
    if (!is_sealed(command)) return Bytes{0xB8, 0xB8};
    const View data = command.subspan(kFrameHeader);
    switch (command[3]) {
      case 0x00:
        return data.empty() ? std::nullopt : std::optional(feedback(data));
      case 0x08:
        return data.size() == 20 ? std::optional(config_u3()) : std::nullopt;
      case 0x0B:
        return data.size() == 6 ? std::optional(config_io(data)) : std::nullopt;
      case 0x2D:
        return data.size() == 2 ? std::optional(read_memory(data[1])) : std::nullopt;
      default:
        return std::nullopt;
    }
  }

  Bytes feedback(View data) const {
    Bytes reply = {0, 0, data[0]};
    if (fault_ == core::FaultKind::kWrongTransaction) --reply[2];
    std::uint8_t part = 0;
    const auto refuse = [&](std::uint8_t error) { return frame_of(0x00, {error, part, reply[2]}); };
    if (fault_ == core::FaultKind::kException) return refuse(kNotEnabled);
    for (std::size_t at = 1; at < data.size(); ++part) {
      const std::uint8_t type = data[at];
      const std::size_t remaining = data.size() - at;
      if (type == 1 && remaining >= 3) {
        const unsigned channel = data[at + 1] & 0x1FU;
        if (channel > 3 || data[at + 2] != 31) return refuse(kNotAnInput);
        append_number(reply, convert(channel), 2);
        at += 3;
      } else if ((type == 54 || type == 55) && remaining >= 2) {
        const int counter = type - 54;
        if (!is_wired(counter)) return refuse(kNotEnabled);
        append_number(reply, static_cast<std::uint32_t>(cup_and_vane_.pulses() - counted_from_), 4);
        at += 2;
      } else if (type == 0 && remaining == 1) {
        ++at;  // fills the last word
      } else {
        return refuse(kNotAnInput);
      }
    }
    return frame_of(0x00, reply);
  }

  /// Returns true if the cup's pin is connected to this counter. Enabled counters get pins in order, from an offset on.
  bool is_wired(int counter) const {
    const unsigned timers = timers_and_counters_ & 3U;
    const bool has_zero = (timers_and_counters_ & 4U) != 0;
    const bool has_one = (timers_and_counters_ & 8U) != 0;
    unsigned pin = (timers_and_counters_ >> 4U) + timers;
    if (counter == 0) return has_zero && pin == kCounterPin;
    if (has_zero) ++pin;
    return has_one && pin == kCounterPin;
  }

  static Bytes config_u3() {
    Bytes data(32, 0);
    data[7] = 30;  // hardware version 1.30
    data[8] = 1;
    Bytes serial;
    append_number(serial, kSerialNumber, 4);
    std::ranges::copy(serial, data.begin() + 9);
    data[13] = 3;   // product id
    data[15] = 1;   // local id
    data[31] = 18;  // U3-HV
    return frame_of(0x08, data);
  }

  Bytes config_io(View data) {
    const std::uint8_t mask = data[0];
    if ((mask & 1U) != 0) {
      if (data[2] >> 4U < 4) return frame_of(0x0B, {kNotAnInput, 0, 0, 0, 0, 0});  // those pins are analogue on the HV
      timers_and_counters_ = data[2];
      counted_from_ = cup_and_vane_.pulses();
    }
    if ((mask & 4U) != 0) digital_as_analog_[0] = data[4];
    if ((mask & 8U) != 0) digital_as_analog_[1] = data[5];
    return frame_of(0x0B, {0, 0, timers_and_counters_, 0, static_cast<std::uint8_t>(digital_as_analog_[0] | 0x0FU),
                           digital_as_analog_[1]});
  }

  static Bytes read_memory(std::uint8_t block) {
    Bytes data = {0, 0};
    for (unsigned i = 0; i < 4; ++i) {
      double value = 0.0;
      if (block == 0) value = i % 2 == 0 ? 0.000037231 : 0.0;
      if (block == 3) value = volts_per_step(i);
      if (block == 4) value = volts_at_zero(i);
      append_number(data, static_cast<std::uint64_t>(std::llround(value * 4294967296.0)), 8);
    }
    return frame_of(0x2D, data);
  }

  /// The 12-bit ADC's code for the voltage at an input, in 16 bits.
  std::uint16_t convert(unsigned channel) const {
    double volts = 0.0;
    if (channel == 0) volts = cup_and_vane_.wiper_v();
    if (channel == 1) volts = CupAndVane::kReference_v;
    const double code = std::round((volts - volts_at_zero(channel)) / volts_per_step(channel) / 16.0);
    return static_cast<std::uint16_t>(16.0 * std::clamp(code, 0.0, 4095.0));
  }

  Bytes spoilt(Bytes reply) {
    if (fault_ == core::FaultKind::kGarbage) {
      std::ranges::generate(reply, [this] { return static_cast<std::uint8_t>(random_()); });
    }
    if (fault_ == core::FaultKind::kBadChecksum) ++reply[reply.size() > kFrameHeader ? 4 : 0];
    if (fault_ == core::FaultKind::kPartial) reply.pop_back();
    return reply;
  }

  Descriptors descriptors_ = labjack_descriptors();
  CupAndVane cup_and_vane_;
  std::uint64_t counted_from_ = 0;
  std::uint8_t timers_and_counters_ = 0;
  std::array<std::uint8_t, 2> digital_as_analog_{};
  std::deque<Bytes> replies_;
  std::deque<Bytes> late_;
  std::optional<core::FaultKind> fault_;
  std::mt19937_64 random_{3};
};

}  // namespace

std::unique_ptr<Device> make_labjack() {
  return std::make_unique<Labjack>();
}

}  // namespace yuragi::simulators::usb
