#include "drivers/network/tempest_stations.hpp"

#include <fmt/format.h>

namespace yuragi::drivers::network {

bool TempestStations::hears(const std::string& serial_number, MonoTime now) {
  if (chosen_.empty() && followed_.empty()) followed_ = serial_number;
  if (serial_number == followed()) {
    if (other_ == serial_number) other_heard_at_.reset();
    return true;
  }
  other_ = serial_number;
  other_heard_at_ = now;
  return false;
}

void TempestStations::lose() {
  followed_.clear();
}

std::string TempestStations::warning(MonoTime now) const {
  if (!chosen_.empty() || followed_.empty()) return {};
  if (!other_heard_at_ || now - *other_heard_at_ > kStillThere) return {};
  return fmt::format("; {} is heard, too, and not used: choose one by serial_number", other_);
}

}  // namespace yuragi::drivers::network
