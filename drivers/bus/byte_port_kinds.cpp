#include "drivers/bus/byte_port_kinds.hpp"

#include "drivers/bus/can_socket.hpp"
#include "drivers/bus/descriptor_port.hpp"

namespace yuragi::drivers::bus {

std::unique_ptr<BytePort> make_byte_port(const BytePortAddress& address) {
  switch (address.kind) {
    case BytePortKind::kSerial:
      return make_serial_port(address);
    case BytePortKind::kTcpClient:
      return make_tcp_port(address);
    case BytePortKind::kUdp:
      return make_udp_port(address);
    case BytePortKind::kCan:
      return make_can_port(address);
    case BytePortKind::kWebSocket:
      return make_websocket_port(address);
    case BytePortKind::kFile:
      break;
  }
  return make_file_port(address);
}

}  // namespace yuragi::drivers::bus
