#include "daemon/sensing/refusal_text.hpp"

#include <fmt/format.h>

namespace yuragi::daemon::sensing {

std::string refusal_text(const wire::SensorStatus& sensor) {
  std::string text;
  for (const auto& [why, count] : sensor.refused) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", why, count);
  return text.empty() ? "nothing" : text;
}

}  // namespace yuragi::daemon::sensing
