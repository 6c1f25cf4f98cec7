// Any bytes as the payload of an MQTT message, read by any of some pointers, as what a station says besides the wind
// and which one it is, and as an OSC datagram.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "drivers/bus/osc_message.hpp"
#include "drivers/mqtt/home_assistant.hpp"
#include "drivers/mqtt/mqtt_payload.hpp"
#include "drivers/mqtt/mqtt_quantities.hpp"
#include "drivers/mqtt/station_identity.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const mqtt::Payload payload(text);
  for (const char* const pointer : {"", "/a", "/TX23/Speed/Act", "/0/a", "/99999999999999999999"}) {
    const auto number = payload.number_at(pointer);
    if (number && *number) require(std::isfinite(**number) && !payload.lacks(pointer));
    static_cast<void>(payload.text_at(pointer));
  }
  for (const auto& quantities : {mqtt::quantities_of_rtl_433(payload), mqtt::quantities_of_tasmota(payload)}) {
    if (quantities) static_cast<void>(wind::plausible_part(*quantities));
  }
  for (const char* const topic : {"homeassistant/sensor/roof/wind/config", "homeassistant/device/roof/config"})
    static_cast<void>(mqtt::announced_anemometers(mqtt::announced_in(topic, text), ""));
  require(mqtt::describe(mqtt::station_of(payload)).size() < 1000);

  if (const auto messages = bus::decode_osc({data, size})) {
    for (const bus::OscMessage& message : *messages) {
      for (const auto& number : message.numbers) require(!number || std::isfinite(*number));
      static_cast<void>(bus::osc_address_matches(message.address, "/wind"));
      static_cast<void>(bus::osc_address_matches(message.address, "/*/wind"));
    }
  }
  return 0;
}
