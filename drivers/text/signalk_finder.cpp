#include "drivers/text/signalk_finder.hpp"

#include <future>
#include <string_view>

#include <fmt/format.h>

#include "drivers/bus/service_search.hpp"

namespace yuragi::drivers::text {
namespace {

std::vector<sensor::FoundDevice> find_streams(const sensor::NetworkSearch& search, std::string_view transport,
                                              const std::string& type, std::uint16_t usual_port) {
  std::vector<sensor::FoundDevice> found;
  for (const bus::AnnouncedService& service :
       bus::find_services(type, search.to, search.dns_port, search.duration).value()) {
    std::string settings = fmt::format("transport = \"{}\"\nhost = \"{}\"\n", transport, service.address);
    if (service.port != 0 && service.port != usual_port) settings += fmt::format("port = {}\n", service.port);
    found.push_back({.what = fmt::format("Signal K server {} at {}", service.name, service.address),
                     .settings = settings,
                     .trouble = {},
                     .remedy = {}});
  }
  return found;
}

}  // namespace

std::vector<sensor::FoundDevice> find_signalk_servers(const sensor::NetworkSearch& search) {
  auto by_tcp = std::async(std::launch::async,
                           [&search] { return find_streams(search, "tcp", "_signalk-tcp._tcp.local", 8375); });
  std::vector<sensor::FoundDevice> found = find_streams(search, "websocket", "_signalk-ws._tcp.local", 3000);
  for (sensor::FoundDevice& device : by_tcp.get()) found.push_back(std::move(device));
  return found;
}

}  // namespace yuragi::drivers::text
