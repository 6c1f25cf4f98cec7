#pragma once

#include <string>

#include "engine/wind/reading_value.hpp"

namespace yuragi::drivers::sensor {

/// What the speed in a reading is, with the document that states it.
struct StatedValue {
  wind::ReadingValue value = wind::ReadingValue::kUnknown;
  double averaging_s = 0.0;  ///< period of a mean or maximum; 0: the interval between readings, or unknown
  std::string source = {};   ///< the document that states it, for people

  bool operator==(const StatedValue&) const = default;
};

/// "instantaneous", "mean over 3 s", "maximum over the interval", "unknown". Pure.
std::string value_text(wind::ReadingValue value, double averaging_s);

/// The same with its source in brackets: "instantaneous (Lufft WS manual 6.8)". If it is unknown, what it is taken as:
/// "instantaneous (assumed)", "mean over the interval (judged from its readings)". Pure.
std::string value_text(const StatedValue& stated, wind::TakenValue taken = {});

}  // namespace yuragi::drivers::sensor
