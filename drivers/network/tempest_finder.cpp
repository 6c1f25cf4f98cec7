#include "drivers/network/tempest_finder.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "drivers/bus/byte_port_kinds.hpp"
#include "drivers/decode/network/tempest.hpp"

namespace yuragi::drivers::network {
namespace {

constexpr std::size_t kMaxStations = 100;

/// Returns true for a serial number as printed on a station or hub. No other text of a datagram is shown or written
/// into a configuration.
bool is_serial_number(const std::string& text) {
  const auto is_part = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  };
  return !text.empty() && text.size() <= 32 && std::ranges::all_of(text, is_part);
}

/// Each hub that was heard, with its stations that have a wind.
using Hubs = std::map<std::string, std::set<std::string>>;

void note(Hubs& hubs, std::span<const std::uint8_t> datagram) {
  const auto message =
      decode::network::decode_tempest({reinterpret_cast<const char*>(datagram.data()), datagram.size()});
  if (!message || !is_serial_number(message->hub_serial_number) || !is_serial_number(message->serial_number)) return;
  if (hubs.size() >= kMaxStations && !hubs.contains(message->hub_serial_number)) return;
  auto& stations = hubs[message->hub_serial_number];
  const bool has_wind = message->kind != decode::network::TempestKind::kOther;
  if (has_wind && stations.size() < kMaxStations) stations.insert(message->serial_number);
}

}  // namespace

std::vector<sensor::FoundDevice> find_tempest_stations(const sensor::NetworkSearch& search) {
  const auto port =
      bus::make_byte_port({.kind = bus::BytePortKind::kUdp, .port = search.tempest_port, .is_port_shared = true});
  port->open().value();
  Hubs hubs;
  std::vector<std::uint8_t> buffer(bus::kMaxDatagram);
  const auto end = std::chrono::steady_clock::now() + search.duration;
  for (auto now = end - search.duration; now < end; now = std::chrono::steady_clock::now()) {
    const bus::ByteArrival arrival = port->read(buffer, end - now);
    if (arrival.status == bus::ByteStatus::kLost) break;
    if (arrival.status == bus::ByteStatus::kBytes) note(hubs, std::span(buffer).first(arrival.size));
  }

  std::vector<sensor::FoundDevice> found;
  for (const auto& [hub, stations] : hubs) {
    for (const std::string& station : stations) {
      found.push_back({.what = fmt::format("WeatherFlow station {} of hub {}", station, hub),
                       .settings = fmt::format("serial_number = \"{}\"\n", station),
                       .trouble = {},
                       .remedy = {}});
    }
    if (!stations.empty()) continue;
    found.push_back({.what = fmt::format("WeatherFlow hub {}", hub),
                     .settings = {},
                     .trouble = "it has forwarded no wind of a station",
                     .remedy = "search longer: a station that saves its battery sends every 5 minutes"});
  }
  return found;
}

}  // namespace yuragi::drivers::network
