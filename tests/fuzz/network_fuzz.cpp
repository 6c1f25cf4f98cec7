// Any bytes as the payload of an MQTT message, read by any of some pointers, and as an OSC datagram.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/bus/osc_message.hpp"
#include "drivers/mqtt/mqtt_payload.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view payload(reinterpret_cast<const char*>(data), size);
  for (const char* const pointer : {"", "/a", "/TX23/Speed/Act", "/0/a", "/99999999999999999999"}) {
    const auto number = mqtt::number_in(payload, {pointer});
    if (number && *number) require(std::isfinite(**number));
  }

  if (const auto messages = bus::decode_osc({data, size})) {
    for (const bus::OscMessage& message : *messages) {
      for (const auto& number : message.numbers) require(!number || std::isfinite(*number));
      static_cast<void>(bus::osc_address_matches(message.address, "/wind"));
      static_cast<void>(bus::osc_address_matches(message.address, "/*/wind"));
    }
  }
  return 0;
}
