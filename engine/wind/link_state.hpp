#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace yuragi::wind {

/// Whether a sensor's device replies. The stream (pose.fbs) has the same in the same order.
enum class LinkState : std::uint8_t {
  kConnecting,  ///< looking for it; also between attempts
  kConnected,   ///< open, and the last exchange succeeded
  kFinished,    ///< a recording that has ended; no more readings follow
};
inline constexpr std::array<std::string_view, 3> kLinkStateNames = {"connecting", "connected", "finished"};

constexpr std::string_view name_of(LinkState state) {
  const auto number = static_cast<std::size_t>(state);
  return number < kLinkStateNames.size() ? kLinkStateNames[number] : "?";
}

}  // namespace yuragi::wind
