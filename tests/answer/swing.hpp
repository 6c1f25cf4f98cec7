#pragma once

#include <limits>

#include "tests/answer/series.hpp"

namespace yuragi::answer {

/// A swing that dies away: the time from its first turning point to its second is half a period of it, and what is left
/// of its amplitude says its damping ratio. NaN where it does not swing twice.
struct Swing {
  double frequency_hz = std::numeric_limits<double>::quiet_NaN();
  double damping = std::numeric_limits<double>::quiet_NaN();
};

/// Of a way that has come to rest at its end. The turning points are those after it first passes its rest.
Swing swing_of(const Series& way_m, double rate_hz);

}  // namespace yuragi::answer
