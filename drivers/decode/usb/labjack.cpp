#include "drivers/decode/usb/labjack.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::drivers::decode::usb {
namespace {

constexpr std::size_t kLabjackHeader = 6;
constexpr std::uint8_t kLabjackExtended = 0xF8;
constexpr std::uint8_t kLabjackWrongSum = 0xB8;
constexpr std::uint8_t kLabjackFeedback = 0x00;
constexpr std::uint8_t kLabjackConfigU3 = 0x08;
constexpr std::uint8_t kLabjackConfigIo = 0x0B;
constexpr std::uint8_t kLabjackReadMemory = 0x2D;
constexpr std::uint8_t kIoAnalog = 1;
constexpr std::uint8_t kIoCounter0 = 54;
constexpr std::uint8_t kAgainstGround = 31;
constexpr std::uint8_t kFirstInputsAnalog = 0x0F;

LabjackRefusal refuse_labjack(Refusal why, std::uint8_t error = 0) {
  return {why, error};
}

/// The sum of bytes 1 to 5, with its carries added in.
std::uint8_t header_sum(ByteSpan message) {
  unsigned sum = sum_16(message.subspan(1, kLabjackHeader - 1));
  sum = (sum >> 8U) + (sum & 0xFFU);
  sum = (sum >> 8U) + (sum & 0xFFU);
  return static_cast<std::uint8_t>(sum);
}

std::size_t even(std::size_t size) {
  return size + size % 2;
}

/// A command with this data, in whole words, and both sums.
LabjackCommand encode_labjack(std::uint8_t command_number, ByteSpan data) {
  LabjackCommand command;
  command.size = even(kLabjackHeader + data.size());
  command.bytes[1] = kLabjackExtended;
  command.bytes[2] = static_cast<std::uint8_t>((command.size - kLabjackHeader) / 2);
  command.bytes[3] = command_number;
  std::ranges::copy(data, command.bytes.begin() + kLabjackHeader);
  const std::uint16_t sum = sum_16(command.span().subspan(kLabjackHeader));
  command.bytes[4] = static_cast<std::uint8_t>(sum & 0xFFU);
  command.bytes[5] = static_cast<std::uint8_t>(sum >> 8U);
  command.bytes[0] = header_sum(command.span());
  return command;
}

/// The data of a whole and undamaged reply to this command; its length and its error are still to be looked at.
Result<ByteSpan, LabjackRefusal> data_of_reply(std::uint8_t command_number, ByteSpan reply) {
  if (reply.size() == 2 && reply[0] == kLabjackWrongSum && reply[1] == kLabjackWrongSum) {
    return refuse_labjack(Refusal::kException);
  }
  if (reply.size() < kLabjackHeader) return refuse_labjack(Refusal::kTooShort);
  if (reply[1] != kLabjackExtended) return refuse_labjack(Refusal::kMalformed);
  const std::size_t whole = kLabjackHeader + std::size_t{2} * reply[2];
  if (reply.size() < whole) return refuse_labjack(Refusal::kTooShort);
  if (reply.size() > whole) return refuse_labjack(Refusal::kMalformed);
  const ByteSpan data = reply.subspan(kLabjackHeader);
  const bool is_undamaged = header_sum(reply) == reply[0] && sum_16(data) == little_endian_16(reply, 4);
  if (!is_undamaged) return refuse_labjack(Refusal::kBadChecksum);
  if (reply[3] != command_number) return refuse_labjack(Refusal::kNotMine);
  return data;
}

/// The same, of `size` bytes, for a reply that begins with its error.
Result<ByteSpan, LabjackRefusal> data_without_error(std::uint8_t command_number, ByteSpan reply, std::size_t size) {
  const auto data = data_of_reply(command_number, reply);
  if (!data) return data.error();
  if (data->empty()) return refuse_labjack(Refusal::kMalformed);
  if ((*data)[0] != 0) return refuse_labjack(Refusal::kException, (*data)[0]);
  if (data->size() != size) return refuse_labjack(Refusal::kMalformed);
  return *data;
}

std::uint8_t counters_on(std::uint8_t counter) {
  constexpr unsigned kPinOffset = 4;
  return static_cast<std::uint8_t>((kPinOffset << 4U) | (4U << counter));
}

}  // namespace

LabjackCommand encode_labjack_configuration(std::uint8_t counter) noexcept {
  constexpr std::uint8_t kCountersFioEio = 1 | 4 | 8;
  const std::array<std::uint8_t, 6> data = {kCountersFioEio, 0, counters_on(counter), 0, kFirstInputsAnalog, 0};
  return encode_labjack(kLabjackConfigIo, data);
}

Result<void, LabjackRefusal> decode_labjack_configuration(std::uint8_t counter, ByteSpan reply) noexcept {
  const auto data = data_without_error(kLabjackConfigIo, reply, 6);
  if (!data) return data.error();
  const bool is_done = (*data)[2] == counters_on(counter) && ((*data)[4] & kFirstInputsAnalog) == kFirstInputsAnalog;
  if (!is_done) return refuse_labjack(Refusal::kInvalid);
  return {};
}

LabjackCommand encode_labjack_feedback(const LabjackRequest& request) noexcept {
  std::array<std::uint8_t, 9> data{};
  std::size_t size = 0;
  const auto add = [&](std::uint8_t byte) { data[size++] = byte; };
  const auto add_input = [&](std::uint8_t channel) {
    for (const std::uint8_t byte : {kIoAnalog, channel, kAgainstGround}) add(byte);
  };
  add(request.echo);
  if (request.analog_channel) add_input(*request.analog_channel);
  if (request.reference_channel) add_input(*request.reference_channel);
  if (request.counter) {
    add(static_cast<std::uint8_t>(kIoCounter0 + *request.counter));
    add(0);  // leave it as it is
  }
  return encode_labjack(kLabjackFeedback, ByteSpan(data).first(size));
}

Result<LabjackReply, LabjackRefusal> decode_labjack(const LabjackRequest& request, ByteSpan reply) noexcept {
  // Returns true for the reply to this request.
  constexpr std::size_t kValues = 3;  // after error, part and echo
  const auto data = data_of_reply(kLabjackFeedback, reply);
  if (!data) return data.error();
  if (data->size() < kValues) return refuse_labjack(Refusal::kMalformed);
  if ((*data)[2] != request.echo) return refuse_labjack(Refusal::kNotMine);
  if ((*data)[0] != 0) return refuse_labjack(Refusal::kException, (*data)[0]);

  // As many values as were requested, in their order.
  const std::size_t size = kValues + (request.analog_channel ? 2U : 0U) + (request.reference_channel ? 2U : 0U) +
                           (request.counter ? 4U : 0U);
  if (data->size() != even(size)) return refuse_labjack(Refusal::kMalformed);
  LabjackReply decoded;
  std::size_t at = kValues;
  if (request.analog_channel) {
    decoded.analog = little_endian_16(*data, at);
    at += 2;
  }
  if (request.reference_channel) {
    decoded.reference = little_endian_16(*data, at);
    at += 2;
  }
  if (request.counter) decoded.count = little_endian_32(*data, at);
  return decoded;
}

LabjackCommand encode_labjack_identity() noexcept {
  return encode_labjack(kLabjackConfigU3, std::array<std::uint8_t, 20>{});
}

Result<LabjackIdentity, LabjackRefusal> decode_labjack_identity(ByteSpan reply) noexcept {
  constexpr std::uint8_t kIsHighVoltage = 18;
  const auto data = data_without_error(kLabjackConfigU3, reply, 32);
  if (!data) return data.error();
  const bool is_high = ((*data)[31] & kIsHighVoltage) == kIsHighVoltage;
  return LabjackIdentity{.serial = little_endian_32(*data, 9),
                         .input = is_high ? LabjackInput::kHighVoltage : LabjackInput::kLowVoltage};
}

LabjackCommand encode_labjack_memory(std::uint8_t block) noexcept {
  return encode_labjack(kLabjackReadMemory, std::array<std::uint8_t, 2>{0, block});
}

Result<std::array<double, 4>, LabjackRefusal> decode_labjack_memory(ByteSpan reply) noexcept {
  const auto data = data_without_error(kLabjackReadMemory, reply, 34);
  if (!data) return data.error();
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t at = 2 + 8 * i;
    const auto whole = static_cast<std::int32_t>(little_endian_32(*data, at + 4));
    numbers[i] = whole + little_endian_32(*data, at) / 4294967296.0;
  }
  return numbers;
}

LabjackCalibration nominal_labjack_calibration(LabjackInput input) noexcept {
  if (input == LabjackInput::kHighVoltage) return {.volts_per_step = 0.000314, .offset_v = -10.3};
  return {.volts_per_step = 0.000037231, .offset_v = 0.0};
}

bool is_believable(const LabjackCalibration& calibration, LabjackInput input) noexcept {
  const LabjackCalibration nominal = nominal_labjack_calibration(input);
  const double full_scale_v = nominal.volts_per_step * 65536.0;
  return std::abs(calibration.volts_per_step / nominal.volts_per_step - 1.0) <= 0.1 &&
         std::abs(calibration.offset_v - nominal.offset_v) <= 0.05 * full_scale_v;
}

}  // namespace yuragi::drivers::decode::usb
