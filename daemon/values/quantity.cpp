#include "daemon/values/quantity.hpp"

#include <algorithm>

namespace yuragi::daemon::values {

const std::array<QuantityDescription, kQuantityCount>& quantities() noexcept {
  static constexpr std::array<QuantityDescription, kQuantityCount> kAll = {{
      {"speed", "m/s", 0.0, 30.0, "the speed of the wind"},
      {"direction", "deg", 0.0, 360.0, "where the wind comes from, clockwise from north; smooth u and v instead"},
      {"u", "m/s", -30.0, 30.0, "the part of the wind toward the east"},
      {"v", "m/s", -30.0, 30.0, "the part of the wind toward the north"},
      {"mean", "m/s", 0.0, 30.0, "the mean speed of the last 100 s"},
      {"gust", "m/s", -10.0, 10.0, "speed less mean"},
      {"peak", "m/s", 0.0, 40.0, "the strongest 3 s of the last 10 minutes"},
      {"norm", "", 0.0, 1.0, "the speed from 0 to 1: 0.5 at the site's median, 1 in its strong wind"},
      {"gust_norm", "", 0.0, 1.0, "the gust from 0 to 1: 1 at twice its standard deviation"},
      {"live", "", 0.0, 1.0, "0: no sensor is live, the wind is synthetic; 1: measured"},
      {"age", "s", 0.0, 60.0, "time since the newest reading that is part of the wind"},
  }};
  return kAll;
}

const QuantityDescription& description_of(Quantity quantity) noexcept {
  return quantities()[static_cast<std::size_t>(quantity)];
}

std::optional<Quantity> quantity_named(std::string_view name) noexcept {
  const auto found = std::ranges::find(quantities(), name, &QuantityDescription::name);
  if (found == quantities().end()) return std::nullopt;
  return static_cast<Quantity>(found - quantities().begin());
}

}  // namespace yuragi::daemon::values
