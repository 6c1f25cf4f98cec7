#pragma once

#include <cstdint>

namespace yuragi::wind {

/// What a station reports.
enum class ReadingValue : std::uint8_t {
  kMean,     ///< the mean wind over a time
  kInstant,  ///< the instantaneous wind: frequencies above half the sampling rate are folded into it (aliasing)
};

}  // namespace yuragi::wind
