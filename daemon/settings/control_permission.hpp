#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace yuragi::daemon::settings {

/// Where clients may control scenes and recordings, and see raw messages, from: [stream] control.
enum class ControlPermission : std::uint8_t { kLoopback, kAnywhere, kNobody };
inline constexpr std::array<std::string_view, 3> kControlPermissionNames = {"loopback", "anywhere", "nobody"};

/// The reason for refusing a client, which begins with `what` ("scenes cannot be switched"); nullopt if `allowed`
/// permits it. `is_local`: the client is on this machine.
inline std::optional<std::string> control_refusal(ControlPermission allowed, bool is_local, const std::string& what) {
  if (allowed == ControlPermission::kNobody) return what + ": the configuration has [stream] control = \"nobody\"";
  if (allowed == ControlPermission::kLoopback && !is_local) {
    return what +
           " from here: [stream] control = \"loopback\" allows it on the daemon's machine or, if [http] "
           "token_file is set, with the token (YURAGI_TOKEN_FILE=FILE)";
  }
  return std::nullopt;
}

}  // namespace yuragi::daemon::settings
