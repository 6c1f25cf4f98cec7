#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace yuragi::daemon::stream {

/// How many clients may be connected at once.
struct AdmissionLimits {
  std::size_t max_clients = 32;
  std::size_t max_clients_per_address = 8;  ///< of each other machine; this machine has no such limit
};

/// Where a client is.
struct Peer {
  std::string address;  ///< without the port
  bool is_local = false;
  /// Why it has one of the places kept for questions, instead of one like the others.
  std::optional<std::string> only_asks_because = std::nullopt;
};

/// Places besides `max_clients`, so that `yuragi status` on this machine gets a reply with any number of clients.
/// A client in one gets neither poses nor raw messages, and is disconnected after kQuestionsFor.
inline constexpr std::size_t kPlacesForQuestions = 4;
inline constexpr auto kQuestionsFor = std::chrono::seconds(60);

/// The number of places that only clients of this machine get, so that a technician on it can always see what is wrong:
/// the last 4, or half of them if there are fewer than 8.
std::size_t places_kept_for_this_machine(const AdmissionLimits& limits);

/// The reason why `newcomer` cannot connect in addition to the connected ones; nullopt if it can. Those with a place
/// for questions do not count. Pure.
std::optional<std::string> admission_refusal(const AdmissionLimits& limits, std::span<const Peer> connected,
                                             const Peer& newcomer);

/// Returns true if one of the places for questions is free for `newcomer`, whom admission_refusal() refuses. Pure.
bool may_ask(std::span<const Peer> connected, const Peer& newcomer);

}  // namespace yuragi::daemon::stream
