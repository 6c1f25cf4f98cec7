#include "drivers/sensor/sensor.hpp"

namespace yuragi {

std::string_view name_of(LinkState state) {
  switch (state) {
    case LinkState::kConnecting:
      return "connecting";
    case LinkState::kConnected:
      return "connected";
    case LinkState::kFinished:
      return "finished";
  }
  return "?";
}

}  // namespace yuragi
