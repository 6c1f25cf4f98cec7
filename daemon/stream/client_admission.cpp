#include "daemon/stream/client_admission.hpp"

#include <algorithm>

#include <fmt/core.h>

namespace yuragi::daemon::stream {

std::size_t places_kept_for_this_machine(const AdmissionLimits& limits) {
  return std::min<std::size_t>(4, limits.max_clients / 2);
}

std::optional<std::string> admission_refusal(const AdmissionLimits& limits, std::span<const Peer> connected,
                                             const Peer& newcomer) {
  if (connected.size() >= limits.max_clients) {
    return fmt::format("the maximum number of clients is connected: {}", connected.size());
  }
  if (newcomer.is_local) return std::nullopt;

  const std::size_t kept = places_kept_for_this_machine(limits);
  if (connected.size() + kept >= limits.max_clients) {
    return fmt::format("{} clients are connected, and the last {} of {} places are for the daemon's own machine",
                       connected.size(), kept, limits.max_clients);
  }
  const std::ptrdiff_t from_there = std::ranges::count(connected, newcomer.address, &Peer::address);
  if (from_there >= static_cast<std::ptrdiff_t>(limits.max_clients_per_address)) {
    return fmt::format("the maximum number of clients from {} is connected: {}", newcomer.address, from_there);
  }
  return std::nullopt;
}

}  // namespace yuragi::daemon::stream
