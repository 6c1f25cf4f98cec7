#include "drivers/bus/service_search.hpp"

#include <algorithm>

#include "drivers/bus/datagram_inquiry.hpp"

namespace yuragi::drivers::bus {

Result<std::vector<AnnouncedService>, Failure> find_services(const std::string& type, const std::string& to,
                                                             std::uint16_t port, Nanoseconds duration) {
  const auto answers = ask_networks({.question = service_question(type),
                                     .port = port,
                                     .to = to.empty() ? kMulticastDnsGroup : to,
                                     .duration = duration});
  if (!answers) return answers.error();
  std::vector<AnnouncedService> found;
  for (const DatagramAnswer& answer : *answers) {
    for (AnnouncedService& service : services_in(answer.bytes, type)) {
      if (service.address.empty()) service.address = answer.sender;
      if (std::ranges::find(found, service) == found.end()) found.push_back(std::move(service));
    }
  }
  return found;
}

}  // namespace yuragi::drivers::bus
