#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace yuragi {

/// Why a client may not do `what` ("scenes are switched"), by `allowed`: the value of [stream] control. Nothing where
/// it may. `is_local`: it asks from this machine.
inline std::optional<std::string> control_refusal(std::string_view allowed, bool is_local, const std::string& what) {
  if (allowed == "nobody") return what + ": the configuration has [stream] control = \"nobody\"";
  if (allowed == "loopback" && !is_local) {
    return what + " from another machine: the configuration has [stream] control = \"loopback\"";
  }
  return std::nullopt;
}

}  // namespace yuragi
