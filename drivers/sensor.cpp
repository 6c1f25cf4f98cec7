#include "drivers/sensor.hpp"

namespace yuragi {

std::string_view name_of(Refusal refusal) {
  static constexpr std::array<std::string_view, kRefusalCount> kNames = {
      "timeout", "too short", "not mine", "bad checksum", "exception", "malformed", "invalid", "implausible"};
  return kNames.at(static_cast<std::size_t>(refusal));
}

std::string_view name_of(LinkState state) {
  switch (state) {
    case LinkState::kConnecting: return "connecting";
    case LinkState::kConnected: return "connected";
    case LinkState::kFinished: return "finished";
  }
  return "?";
}

}  // namespace yuragi
