#include "drivers/sensor/source_text.hpp"

namespace yuragi::drivers::sensor {

std::string source_text(const ParameterValues& values, std::initializer_list<std::string_view> keys) {
  std::string text;
  for (const std::string_view key : keys) {
    const auto found = values.all().find(key);
    if (found == values.all().end()) continue;  // it was left out, which is a choice of its own
    const auto* const as_text = std::get_if<std::string>(&found->second);
    if (as_text != nullptr && as_text->empty()) continue;
    text += (text.empty() ? "" : ", ") + std::string(key) + " = " + value_text(found->second);
  }
  return text;
}

}  // namespace yuragi::drivers::sensor
