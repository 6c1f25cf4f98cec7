// Any bytes as an answer of multicast DNS.
#include <cstdint>
#include <cstdlib>

#include "drivers/bus/dns_message.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto services = yuragi::drivers::bus::services_in({data, size}, "_signalk-ws._tcp.local");
  if (services.size() > 16) std::abort();
  for (const auto& service : services) {
    const bool is_address = service.address.find_first_not_of("0123456789.") == std::string::npos;
    if (!is_address || service.address.size() > 15 || service.name.size() > 4UL * 63) std::abort();
  }
  return 0;
}
