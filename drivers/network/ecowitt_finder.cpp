#include "drivers/network/ecowitt_finder.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "drivers/bus/datagram_inquiry.hpp"
#include "drivers/decode/network/ecowitt_gateway.hpp"

namespace yuragi::drivers::network {
namespace {

constexpr std::uint16_t kUsualEcowittPort = 45000;

}  // namespace

std::vector<sensor::FoundDevice> find_ecowitt_gateways(const sensor::NetworkSearch& search) {
  const auto& question = decode::network::kEcowittSearch;
  const auto answers = bus::ask_networks({.question = {question.begin(), question.end()},
                                          .port = search.ecowitt_port,
                                          .to = search.to,
                                          .duration = search.duration})
                           .value();
  std::vector<sensor::FoundDevice> found;
  std::vector<std::string> macs;  // one with a cable and a radio answers twice
  for (const bus::DatagramAnswer& answer : answers) {
    const auto gateway = decode::network::decode_ecowitt_gateway(answer.bytes);
    if (!gateway || std::ranges::find(macs, gateway->mac) != macs.end()) continue;
    macs.push_back(gateway->mac);
    std::string settings = fmt::format("host = \"{}\"\n", answer.sender);
    if (gateway->port != kUsualEcowittPort) settings += fmt::format("port = {}\n", gateway->port);
    found.push_back({.what = fmt::format("Ecowitt gateway {} at {} ({})", gateway->name, answer.sender, gateway->mac),
                     .settings = settings,
                     .trouble = {},
                     .remedy = {}});
  }
  return found;
}

}  // namespace yuragi::drivers::network
