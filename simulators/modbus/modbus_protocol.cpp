#include "simulators/modbus/modbus_protocol.hpp"

#include <algorithm>
#include <array>

namespace yuragi::simulators::modbus {
namespace {

constexpr std::size_t kTcpHeader = 6;  // transaction, protocol, length; the unit is counted by the length
constexpr std::size_t kMaxTcpBody = 254;
constexpr std::size_t kMinRtu = 4;
constexpr std::size_t kMaxRtu = 256;

std::uint16_t word_at(const Bytes& bytes, std::size_t at) {
  return at + 1 < bytes.size() ? static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]) : std::uint16_t{0};
}

/// The CRC of each byte, for a CRC by table.
constexpr std::array<std::uint16_t, 256> make_table() {
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < table.size(); ++byte) {
    unsigned sum = byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1U) ^ ((sum & 1U) * 0xA001U);
    table[byte] = static_cast<std::uint16_t>(sum);
  }
  return table;
}

std::uint16_t sum_of(std::span<const std::uint8_t> bytes) {
  static constexpr auto kTable = make_table();
  unsigned sum = 0xFFFF;
  for (const std::uint8_t byte : bytes) sum = (sum >> 8U) ^ kTable[(sum ^ byte) & 0xFFU];
  return static_cast<std::uint16_t>(sum);
}

/// The length of a request of this function on a serial line, CRC included; 0 if that is not known yet.
std::size_t rtu_length(const Bytes& bytes) {
  constexpr std::size_t kFixed = 8;
  constexpr std::uint8_t kWriteCoils = 15;
  constexpr std::uint8_t kWriteRegisters = 16;
  if (bytes.size() < 2) return 0;
  if (bytes[1] != kWriteCoils && bytes[1] != kWriteRegisters) return kFixed;
  return bytes.size() > 6 ? 9U + bytes[6] : 0;
}

}  // namespace

std::optional<SlaveRequest> take_tcp_request(Bytes& incoming) {
  if (incoming.size() < kTcpHeader) return std::nullopt;
  const std::size_t length = word_at(incoming, 4);
  if (word_at(incoming, 2) != 0 || length < 2 || length > kMaxTcpBody) {
    incoming.clear();
    return std::nullopt;
  }
  if (incoming.size() < kTcpHeader + length) return std::nullopt;
  const SlaveRequest request{.transaction = word_at(incoming, 0),
                             .unit = incoming[6],
                             .function = incoming[7],
                             .address = word_at(incoming, 8),
                             .count = word_at(incoming, 10)};
  incoming.erase(incoming.begin(), incoming.begin() + static_cast<std::ptrdiff_t>(kTcpHeader + length));
  return request;
}

std::optional<SlaveRequest> take_rtu_request(Bytes& incoming) {
  while (incoming.size() >= kMinRtu) {
    const std::size_t length = rtu_length(incoming);
    if (length == 0) return std::nullopt;
    if (length <= kMaxRtu && incoming.size() < length) return std::nullopt;
    const bool is_whole = length <= kMaxRtu && sum_of(std::span(incoming).first(length)) == 0;
    if (!is_whole) {
      incoming.erase(incoming.begin());
      continue;
    }
    const SlaveRequest request{.transaction = 0,
                               .unit = incoming[0],
                               .function = incoming[1],
                               .address = word_at(incoming, 2),
                               .count = word_at(incoming, 4)};
    incoming.erase(incoming.begin(), incoming.begin() + static_cast<std::ptrdiff_t>(length));
    return request;
  }
  return std::nullopt;
}

Bytes registers_reply(std::uint8_t function, std::span<const std::uint16_t> registers) {
  Bytes reply = {function, static_cast<std::uint8_t>(2 * registers.size())};
  for (const std::uint16_t value : registers) {
    reply.push_back(static_cast<std::uint8_t>(value >> 8U));
    reply.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  }
  return reply;
}

Bytes exception_reply(std::uint8_t function, std::uint8_t code) {
  return {static_cast<std::uint8_t>(function | 0x80U), code};
}

Bytes tcp_message(std::uint16_t transaction, std::uint8_t unit, const Bytes& reply) {
  const std::size_t length = 1 + reply.size();
  Bytes message = {static_cast<std::uint8_t>(transaction >> 8U), static_cast<std::uint8_t>(transaction & 0xFFU), 0,   0,
                   static_cast<std::uint8_t>(length >> 8U),      static_cast<std::uint8_t>(length & 0xFFU),      unit};
  message.insert(message.end(), reply.begin(), reply.end());
  return message;
}

Bytes rtu_message(std::uint8_t unit, const Bytes& reply) {
  Bytes message = {unit};
  message.insert(message.end(), reply.begin(), reply.end());
  const std::uint16_t sum = sum_of(message);
  message.push_back(static_cast<std::uint8_t>(sum & 0xFFU));
  message.push_back(static_cast<std::uint8_t>(sum >> 8U));
  return message;
}

}  // namespace yuragi::simulators::modbus
