#pragma once

#include <cstdint>

namespace yuragi::wind {

/// What the value of a reading is.
enum class ReadingValue : std::uint8_t {
  kMean,     ///< the mean of the wind over a time
  kInstant,  ///< the wind of the moment: waves that are quicker than half of the sampling rate are folded into it
};

}  // namespace yuragi::wind
