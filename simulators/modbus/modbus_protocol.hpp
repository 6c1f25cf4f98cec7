#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace yuragi::simulators::modbus {

// Modbus from the slave's side, byte by byte: the faults need replies that no library would send. Source: MODBUS
// Application Protocol V1.1b3 (sections 4, 6, 7); MODBUS over Serial Line V1.02 (2.5.1, 6.2.2); MODBUS Messaging on
// TCP/IP V1.0b (3.1.3).

using Bytes = std::vector<std::uint8_t>;

inline constexpr std::uint8_t kIllegalFunction = 1;
inline constexpr std::uint8_t kIllegalAddress = 2;
inline constexpr std::uint8_t kIllegalValue = 3;
inline constexpr std::uint8_t kDeviceFailure = 4;
inline constexpr std::uint8_t kGatewayTargetSilent = 11;

/// A master's request.
struct SlaveRequest {
  std::uint16_t transaction = 0;  ///< TCP only
  std::uint8_t unit = 0;
  std::uint8_t function = 0;
  std::uint16_t address = 0;  ///< of functions 1 to 4; otherwise the bytes at that place
  std::uint16_t count = 0;
};

/// Takes the first whole request out of the bytes of a TCP client; nullopt while it is incomplete. Bytes that cannot be
/// Modbus empty `incoming`.
std::optional<SlaveRequest> take_tcp_request(Bytes& incoming);

/// The same for a serial line: bytes without a valid CRC are skipped one by one.
std::optional<SlaveRequest> take_rtu_request(Bytes& incoming);

/// The part of a reply that both framings carry: these registers.
Bytes registers_reply(std::uint8_t function, std::span<const std::uint16_t> registers);
Bytes exception_reply(std::uint8_t function, std::uint8_t code);

Bytes tcp_message(std::uint16_t transaction, std::uint8_t unit, const Bytes& reply);
Bytes rtu_message(std::uint8_t unit, const Bytes& reply);

}  // namespace yuragi::simulators::modbus
