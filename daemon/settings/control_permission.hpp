#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace yuragi {

/// From where clients may change what is shown and played: [stream] control.
enum class ControlPermission : std::uint8_t { kLoopback, kAnywhere, kNobody };
inline constexpr std::array<std::string_view, 3> kControlPermissionNames = {"loopback", "anywhere", "nobody"};

/// The one of this name, which is among kControlPermissionNames; of any other, kNobody.
constexpr ControlPermission control_permission_named(std::string_view name) noexcept {
  for (std::size_t index = 0; index < kControlPermissionNames.size(); ++index) {
    if (name == kControlPermissionNames[index]) return static_cast<ControlPermission>(index);
  }
  return ControlPermission::kNobody;
}

/// Why a client may not do `what` ("scenes cannot be switched"), by `allowed`. Nothing where it may. `is_local`: it
/// asks from this machine.
inline std::optional<std::string> control_refusal(ControlPermission allowed, bool is_local, const std::string& what) {
  if (allowed == ControlPermission::kNobody) return what + ": the configuration has [stream] control = \"nobody\"";
  if (allowed == ControlPermission::kLoopback && !is_local) {
    return what + " from another machine: the configuration has [stream] control = \"loopback\"";
  }
  return std::nullopt;
}

}  // namespace yuragi
