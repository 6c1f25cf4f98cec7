#include "drivers/decode/labjack.hpp"

namespace yuragi {
namespace {

constexpr std::size_t kLabjackHeader = 6;
constexpr std::size_t kLabjackData = 9;  // of a feedback's reply: after error, part and echo
constexpr std::uint8_t kLabjackExtended = 0xF8;
constexpr std::uint8_t kLabjackFeedback = 0x00;
constexpr std::uint8_t kLabjackWrongSum = 0xB8;
constexpr std::uint8_t kIoAnalog = 1;
constexpr std::uint8_t kIoCounter0 = 54;
constexpr std::uint8_t kAgainstGround = 31;

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

}  // namespace

LabjackCommand encode_labjack_feedback(const LabjackRequest& request) noexcept {
  LabjackCommand command;
  const auto add = [&command](std::uint8_t byte) { command.bytes[command.size++] = byte; };
  for (const std::uint8_t byte : {std::uint8_t{0}, kLabjackExtended, std::uint8_t{0}, kLabjackFeedback, std::uint8_t{0},
                                  std::uint8_t{0}, request.echo}) {
    add(byte);
  }
  if (request.analog_channel) {
    for (const std::uint8_t byte : {kIoAnalog, *request.analog_channel, kAgainstGround}) add(byte);
  }
  if (request.wants_counter) {
    for (const std::uint8_t byte : {kIoCounter0, std::uint8_t{0}}) add(byte);
  }

  // Whole words, then both sums.
  command.size = even(command.size);
  command.bytes[2] = static_cast<std::uint8_t>((command.size - kLabjackHeader) / 2);
  const std::uint16_t sum = sum_16(command.span().subspan(kLabjackHeader));
  command.bytes[4] = static_cast<std::uint8_t>(sum & 0xFFU);
  command.bytes[5] = static_cast<std::uint8_t>(sum >> 8U);
  command.bytes[0] = header_sum(command.span());
  return command;
}

Result<LabjackReply, LabjackRefusal> decode_labjack(const LabjackRequest& request, ByteSpan reply) noexcept {
  // A whole frame, undamaged?
  if (reply.size() == 2 && reply[0] == kLabjackWrongSum && reply[1] == kLabjackWrongSum) {
    return refuse_labjack(Refusal::kException);
  }
  if (reply.size() < kLabjackHeader) return refuse_labjack(Refusal::kTooShort);
  if (reply[1] != kLabjackExtended) return refuse_labjack(Refusal::kMalformed);
  const std::size_t whole = kLabjackHeader + std::size_t{2} * reply[2];
  if (reply.size() < whole) return refuse_labjack(Refusal::kTooShort);
  if (reply.size() > whole) return refuse_labjack(Refusal::kMalformed);
  const bool is_undamaged =
      header_sum(reply) == reply[0] && sum_16(reply.subspan(kLabjackHeader)) == little_endian_16(reply, 4);
  if (!is_undamaged) return refuse_labjack(Refusal::kBadChecksum);

  // The answer to this question?
  if (reply[3] != kLabjackFeedback) return refuse_labjack(Refusal::kNotMine);
  if (whole < kLabjackData) return refuse_labjack(Refusal::kMalformed);
  if (reply[8] != request.echo) return refuse_labjack(Refusal::kNotMine);
  if (reply[6] != 0) return refuse_labjack(Refusal::kException, reply[6]);
  const std::size_t analog_size = request.analog_channel ? 2 : 0;
  const std::size_t count_size = request.wants_counter ? 4 : 0;
  if (whole != even(kLabjackData + analog_size + count_size)) return refuse_labjack(Refusal::kMalformed);

  LabjackReply decoded;
  if (request.analog_channel) decoded.analog = little_endian_16(reply, kLabjackData);
  if (request.wants_counter) decoded.count = little_endian_32(reply, kLabjackData + analog_size);
  return decoded;
}

double labjack_volts(std::uint16_t analog, LabjackInput input) noexcept {
  return input == LabjackInput::kHighVoltage ? 0.000314 * analog - 10.3 : 0.000037231 * analog;
}

}  // namespace yuragi
