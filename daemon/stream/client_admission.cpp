#include "daemon/stream/client_admission.hpp"

#include <algorithm>

#include <fmt/core.h>

namespace yuragi::daemon::stream {
namespace {

std::size_t asking(std::span<const Peer> connected) {
  return static_cast<std::size_t>(
      std::ranges::count_if(connected, [](const Peer& peer) { return peer.only_asks_because.has_value(); }));
}

}  // namespace

std::size_t places_kept_for_this_machine(const AdmissionLimits& limits) {
  return std::min<std::size_t>(4, limits.max_clients / 2);
}

std::optional<std::string> admission_refusal(const AdmissionLimits& limits, std::span<const Peer> connected,
                                             const Peer& newcomer) {
  const std::size_t count = connected.size() - asking(connected);
  if (count >= limits.max_clients) return fmt::format("the maximum number of clients is connected: {}", count);
  if (newcomer.is_local) return std::nullopt;

  const std::size_t kept = places_kept_for_this_machine(limits);
  if (count + kept >= limits.max_clients) {
    return fmt::format("{} clients are connected, and the last {} of {} places are for the daemon's own machine", count,
                       kept, limits.max_clients);
  }
  const std::ptrdiff_t from_there = std::ranges::count(connected, newcomer.address, &Peer::address);
  if (from_there >= static_cast<std::ptrdiff_t>(limits.max_clients_per_address)) {
    return fmt::format("the maximum number of clients from {} is connected: {}", newcomer.address, from_there);
  }
  return std::nullopt;
}

bool may_ask(std::span<const Peer> connected, const Peer& newcomer) {
  return newcomer.is_local && asking(connected) < kPlacesForQuestions;
}

}  // namespace yuragi::daemon::stream
