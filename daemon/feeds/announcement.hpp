#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/time.hpp"
#include "engine/platform/backoff.hpp"
#include "engine/platform/child_process.hpp"

namespace yuragi::daemon::feeds {

/// Announces a service as long as it exists, so that other programs of the network find it by its type (S. Cheshire and
/// M. Krochmal, RFC 6763, "DNS-Based Service Discovery", 2013). By Avahi: avahi-publish runs as a child, which is
/// started again if it ends. Thread-safe: no.
class Announcement {
 public:
  /// `name`: for a person who chooses it from a list; Avahi adds a number if another machine has it. `type`:
  /// "_oscjson._tcp".
  Announcement(const std::string& name, const std::string& type, std::uint16_t port);

  /// Starts it if it does not run and an attempt is due. Does not wait.
  void check(MonoTime now);

  /// Why it is not announced, and what to do; empty: it is, as far as is known.
  const std::string& trouble() const noexcept { return trouble_; }

 private:
  void start(MonoTime now);

  platform::ChildProcess::Setup setup_;
  std::optional<platform::ChildProcess> publisher_;
  platform::Backoff waits_;
  MonoTime started_{}, next_{};
  std::string trouble_;
};

}  // namespace yuragi::daemon::feeds
