#include "drivers/sensor/endpoint.hpp"

#include <utility>

#include "engine/base/address.hpp"

namespace yuragi::drivers::sensor {

std::vector<Endpoint> endpoints_at(const bus::BytePortAddress& address) {
  const auto named = [&](EndpointKind kind, std::string name) {
    return std::vector{Endpoint{.kind = kind,
                                .name = std::move(name),
                                .claim = bus::sole_device_of(address),
                                .is_shared = address.is_port_shared}};
  };
  const std::string host_and_port = to_string(Address{address.host, address.port});
  switch (address.kind) {
    case bus::BytePortKind::kSerial:
      return named(EndpointKind::kSerialPort, address.path);
    case bus::BytePortKind::kTcpClient:
    case bus::BytePortKind::kWebSocket:
      return named(EndpointKind::kServer, host_and_port);
    case bus::BytePortKind::kUdp:
      return named(EndpointKind::kUdpPort, host_and_port);
    case bus::BytePortKind::kFile:
      return named(EndpointKind::kFile, address.path);
    case bus::BytePortKind::kCan:
      break;
  }
  return {};
}

}  // namespace yuragi::drivers::sensor
