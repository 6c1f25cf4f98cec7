#include "drivers/sensor/stated_value.hpp"

#include <fmt/format.h>

namespace yuragi::drivers::sensor {

std::string value_text(wind::ReadingValue value, double averaging_s) {
  const auto over = [averaging_s](std::string_view what) {
    return averaging_s > 0.0 ? fmt::format("{} over {:g} s", what, averaging_s)
                             : fmt::format("{} over the interval", what);
  };
  switch (value) {
    case wind::ReadingValue::kMean:
      return over("mean");
    case wind::ReadingValue::kInstant:
      return "instantaneous";
    case wind::ReadingValue::kMaximum:
      return over("maximum");
    case wind::ReadingValue::kUnknown:
      break;
  }
  return "unknown";
}

std::string value_text(const StatedValue& stated, wind::TakenValue taken) {
  if (stated.value == wind::ReadingValue::kUnknown) {
    if (taken.value == wind::ReadingValue::kUnknown) return value_text(taken.value, 0.0);
    return fmt::format("{} ({})", value_text(taken.value, 0.0),
                       taken.is_judged ? "judged from its readings" : "assumed");
  }
  return fmt::format("{} ({})", value_text(stated.value, stated.averaging_s), stated.source);
}

}  // namespace yuragi::drivers::sensor
