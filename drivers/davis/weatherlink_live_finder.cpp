#include "drivers/davis/weatherlink_live_finder.hpp"

#include <fmt/format.h>

#include "drivers/bus/service_search.hpp"

namespace yuragi::drivers::davis {

std::vector<sensor::FoundDevice> find_weatherlink_lives(const sensor::NetworkSearch& search) {
  constexpr std::uint16_t kUsualPort = 80;
  std::vector<sensor::FoundDevice> found;
  for (const bus::AnnouncedService& service :
       bus::find_services("_weatherlinklive._tcp.local", search.to, search.dns_port, search.duration).value()) {
    std::string settings = fmt::format("host = \"{}\"\n", service.address);
    if (service.port != 0 && service.port != kUsualPort) settings += fmt::format("http_port = {}\n", service.port);
    found.push_back({.what = fmt::format("WeatherLink Live {} at {}", service.name, service.address),
                     .settings = settings,
                     .trouble = {},
                     .remedy = {}});
  }
  return found;
}

}  // namespace yuragi::drivers::davis
