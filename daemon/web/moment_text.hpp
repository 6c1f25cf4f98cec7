#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "daemon/values/moment.hpp"

namespace yuragi::daemon::web {

/// The message of a WebSocket with the wind of a moment, JSON: {"t", "utc", "wind": {...}, "places": {name: {...}}}.
/// t: seconds since the daemon started, by a steady clock. utc: ISO 8601 with milliseconds. A place that does not exist
/// is null. Pure.
std::string moment_text(const values::Moment& moment, std::span<const std::string> places);

/// A text that several clients are sent.
using SharedText = std::shared_ptr<const std::string>;

/// The texts of one moment: each list of places is written once, for all clients that want it. Thread-safe: no.
class MomentTexts {
 public:
  explicit MomentTexts(std::shared_ptr<const values::Moment> moment) : moment_(std::move(moment)) {}

  const values::Moment& moment() const noexcept { return *moment_; }
  SharedText of(const std::vector<std::string>& places);

 private:
  std::shared_ptr<const values::Moment> moment_;
  std::vector<std::pair<std::vector<std::string>, SharedText>> made_;
};

}  // namespace yuragi::daemon::web
