#include "engine/wire/sensor_trouble.hpp"

namespace yuragi::wire {

std::string trouble_of(const SensorStatus& sensor) {
  if (!is_believed(sensor.state)) {
    const std::string& why = sensor.state_reason.empty() ? sensor.detail : sensor.state_reason;
    return "is " + std::string(name_of(sensor.state)) + (why.empty() ? "" : ": " + why);
  }
  std::string trouble;
  for (const QuantityStatus& quantity : sensor.quantities) {
    if (!quantity.is_missing) continue;
    if (!trouble.empty()) trouble += "; it ";
    trouble += "sends no " + std::string(name_of(quantity.quantity));
    if (!quantity.reason.empty()) trouble += ": " + quantity.reason;
  }
  return trouble;
}

}  // namespace yuragi::wire
