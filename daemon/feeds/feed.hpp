#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/values/moment.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::feeds {

/// What a feed sends, to whom, and whether it can; for a person and for the page.
struct Status {
  std::string kind = {};                   ///< "osc"
  std::string name = {};                   ///< as the configuration calls it
  std::string target = {};                 ///< "127.0.0.1:9000"
  std::string sends = {};                  ///< "wind, sensors, 2 mapped values"
  std::uint64_t messages = 0, bytes = 0;   ///< sent since the start
  std::optional<MonoTime> last_sent = {};  ///< nullopt: never
  std::string trouble = {};                ///< why nothing can be sent at present, and what to do; empty: it can
};

/// An output of the wind for other programs. Each is a file of its own; Feeds owns them and calls them on its thread.
/// None may wait: a receiver that hangs, vanishes or refuses must not delay the others.
class Feed {
 public:
  Feed() = default;
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;
  virtual ~Feed() = default;

  /// Sends what is due of the newest moment. Moments may be missing between two calls.
  virtual void send(const values::Moment& moment) = 0;

  /// The daemon ends, or the feed's configuration has changed: sends what has to be sent last.
  virtual void finish() {}

  virtual Status status() const = 0;
};

}  // namespace yuragi::daemon::feeds
