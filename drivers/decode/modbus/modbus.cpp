#include "drivers/decode/modbus/modbus.hpp"

namespace yuragi::drivers::decode::modbus {
namespace {

using Bytes = std::span<const std::uint8_t>;
using DecodeResult = Result<Registers, RefusedReply>;

constexpr std::size_t kTcpHeader = 7;      // transaction id, protocol id, length, unit id
constexpr std::size_t kTcpLengthFrom = 6;  // the length field counts from here
constexpr std::size_t kCrc = 2;
constexpr std::uint8_t kExceptionBit = 0x80;

constexpr std::uint8_t high(std::uint16_t value) {
  return static_cast<std::uint8_t>(value >> 8U);
}
constexpr std::uint8_t low(std::uint16_t value) {
  return static_cast<std::uint8_t>(value & 0xFFU);
}

std::uint16_t big_endian(Bytes bytes, std::size_t at) {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}

RefusedReply refuse(Refusal why, std::uint8_t exception = 0) {
  return {why, exception};
}

/// The common part of both framings: function, byte count, registers; or function with the high bit, exception code.
DecodeResult decode_pdu(const Request& request, Bytes pdu) {
  if (pdu.size() < 2) return refuse(Refusal::kTooShort);
  if (pdu[0] == (request.function | kExceptionBit)) {
    return pdu.size() == 2 ? refuse(Refusal::kException, pdu[1]) : refuse(Refusal::kMalformed);
  }
  if (pdu[0] != request.function) return refuse(Refusal::kMalformed);
  if (request.count > kModbusMaxRegisters || pdu[1] != 2U * request.count) return refuse(Refusal::kMalformed);

  const Bytes data = pdu.subspan(2);
  if (data.size() < pdu[1]) return refuse(Refusal::kTooShort);
  if (data.size() > pdu[1]) return refuse(Refusal::kMalformed);

  Registers registers;
  registers.count = request.count;
  for (std::size_t i = 0; i < registers.count; ++i) registers.values[i] = big_endian(data, 2 * i);
  return registers;
}

/// Returns true if the sum over a message including its own sum is 0.
bool has_right_crc(Bytes message) {
  return modbus_crc(message) == 0;
}

}  // namespace

std::array<std::uint8_t, 12> encode_tcp(const Request& request) noexcept {
  const auto body = encode_rtu_without_crc(request);
  std::array<std::uint8_t, 12> message = {high(request.transaction), low(request.transaction), 0, 0, 0, body.size()};
  for (std::size_t i = 0; i < body.size(); ++i) message[kTcpLengthFrom + i] = body[i];
  return message;
}

std::array<std::uint8_t, 6> encode_rtu_without_crc(const Request& request) noexcept {
  return {request.unit,         request.function,    high(request.address),
          low(request.address), high(request.count), low(request.count)};
}

std::array<std::uint8_t, 8> encode_rtu(const Request& request) noexcept {
  const auto body = encode_rtu_without_crc(request);
  const std::uint16_t crc = modbus_crc(body);
  std::array<std::uint8_t, 8> message{};
  for (std::size_t i = 0; i < body.size(); ++i) message[i] = body[i];
  message[body.size()] = low(crc);
  message[body.size() + 1] = high(crc);
  return message;
}

DecodeResult decode_tcp(const Request& request, Bytes message) noexcept {
  // The header: refuses messages that are not Modbus, incomplete, or for others.
  if (message.size() < kTcpHeader) return refuse(Refusal::kTooShort);
  const std::size_t whole = kTcpLengthFrom + big_endian(message, 4);
  if (big_endian(message, 2) != 0 || whole < kTcpHeader || whole > kModbusMaxMessage) {
    return refuse(Refusal::kMalformed);
  }
  if (message.size() < whole) return refuse(Refusal::kTooShort);
  if (message.size() > whole) return refuse(Refusal::kMalformed);
  if (big_endian(message, 0) != request.transaction || message[6] != request.unit) return refuse(Refusal::kNotMine);

  return decode_pdu(request, message.subspan(kTcpHeader));
}

DecodeResult decode_rtu(const Request& request, Bytes message) noexcept {
  constexpr std::size_t kShortest = 1 + 2 + kCrc;  // an exception
  const bool stray = message.size() > kShortest && message[0] != request.unit &&
                     (message[0] == 0x00 || message[0] == 0xFF) && has_right_crc(message.subspan(1));
  if (stray) message = message.subspan(1);

  if (message.size() < kShortest) return refuse(Refusal::kTooShort);
  if (!has_right_crc(message)) {
    // Cut off, or damaged: a reply to this request that ends too early is cut off.
    const bool is_cut =
        message[0] == request.unit && message[1] == request.function && message.size() < 3U + message[2] + kCrc;
    return refuse(is_cut ? Refusal::kTooShort : Refusal::kBadChecksum);
  }
  if (message[0] != request.unit) return refuse(Refusal::kNotMine);

  return decode_pdu(request, message.subspan(1, message.size() - 1 - kCrc));
}

DecodeResult decode_modbus(Framing framing, const Request& request, Bytes message) noexcept {
  return framing == Framing::kTcp ? decode_tcp(request, message) : decode_rtu(request, message);
}

std::uint16_t modbus_crc(Bytes bytes) noexcept {
  std::uint32_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0xA001U : crc >> 1U;
  }
  return static_cast<std::uint16_t>(crc);
}

std::string_view modbus_exception_name(std::uint8_t code) noexcept {
  switch (code) {
    case 1:
      return "illegal function";
    case 2:
      return "illegal data address";
    case 3:
      return "illegal data value";
    case 4:
      return "server device failure";
    case 5:
      return "acknowledge";
    case 6:
      return "server device busy";
    case 8:
      return "memory parity error";
    case 10:
      return "gateway path unavailable";
    case 11:
      return "gateway target device failed to respond";
    default:
      return "unknown exception";
  }
}

bool is_gateway_silence(std::uint8_t exception) noexcept {
  constexpr std::uint8_t kPathUnavailable = 10;
  constexpr std::uint8_t kTargetFailedToRespond = 11;
  return exception == kPathUnavailable || exception == kTargetFailedToRespond;
}

}  // namespace yuragi::drivers::decode::modbus
