#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::modbus {

// Modbus messages as bytes, and nothing else: no connection, no time, no state.
// Source: MODBUS Application Protocol Specification V1.1b3 (sections 4, 6.3, 6.4, 7); MODBUS Messaging on TCP/IP
// Implementation Guide V1.0b (section 3.1.3); MODBUS over Serial Line V1.02 (section 2.5.1).

/// The longest message on either transport (libmodbus: MODBUS_MAX_ADU_LENGTH).
inline constexpr std::size_t kModbusMaxMessage = 260;
/// The most registers in one request.
inline constexpr std::size_t kModbusMaxRegisters = 125;

/// How a message is wrapped on its way.
enum class Framing : std::uint8_t {
  kTcp,  ///< transaction id, protocol id, length, unit id in front
  kRtu,  ///< slave id before the message, CRC after it
};

/// A request for registers.
struct Request {
  std::uint16_t transaction = 0;  ///< TCP only
  std::uint8_t unit = 1;          ///< slave id
  std::uint8_t function = 3;      ///< 3: holding registers; 4: input registers
  std::uint16_t address = 0;      ///< of the first register, as sent
  std::uint16_t count = 1;        ///< registers, 1 to kModbusMaxRegisters
};

/// The request as sent on a TCP connection.
std::array<std::uint8_t, 12> encode_tcp(const Request& request) noexcept;

/// The request as sent on a serial line, without its CRC.
std::array<std::uint8_t, 6> encode_rtu_without_crc(const Request& request) noexcept;

/// The request as sent on a serial line, with its CRC.
std::array<std::uint8_t, 8> encode_rtu(const Request& request) noexcept;

/// The content of a reply.
struct Registers {
  std::array<std::uint16_t, kModbusMaxRegisters> values{};
  std::size_t count = 0;

  std::span<const std::uint16_t> span() const noexcept { return {values.data(), count}; }
};

struct RefusedReply {
  Refusal why = Refusal::kMalformed;
  std::uint8_t exception = 0;  ///< the device's exception code, if `why` is kException
};

/// The registers in one whole message that came after `request`, or the first thing that is wrong with it, in this
/// order: kTooShort (no header, or it ends before its own length), kMalformed (not Modbus, or longer than its length),
/// kNotMine (another transaction or unit), kException, kMalformed (another function or byte count). Reads any bytes
/// whatsoever. Thread-safe and realtime-safe: yes.
Result<Registers, RefusedReply> decode_tcp(const Request& request, std::span<const std::uint8_t> message) noexcept;

/// The same for a serial line, with kBadChecksum before kNotMine. One stray byte 0x00 or 0xFF in front, as RS-485
/// transceivers make when they turn around, is skipped if the rest is a message with a right CRC.
Result<Registers, RefusedReply> decode_rtu(const Request& request, std::span<const std::uint8_t> message) noexcept;

Result<Registers, RefusedReply> decode_modbus(Framing framing, const Request& request,
                                              std::span<const std::uint8_t> message) noexcept;

/// CRC-16/MODBUS; its low byte goes first on the wire.
std::uint16_t modbus_crc(std::span<const std::uint8_t> bytes) noexcept;

/// "illegal data address" for 2; "unknown exception" for a code that the specification does not have.
std::string_view modbus_exception_name(std::uint8_t code) noexcept;

/// Returns true if this exception is a gateway's report that the slave does not reply.
bool is_gateway_silence(std::uint8_t exception) noexcept;

}  // namespace yuragi::drivers::decode::modbus
