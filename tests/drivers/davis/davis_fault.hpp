#pragma once

#include <gtest/gtest.h>

#include "tests/support/station_fault.hpp"

namespace yuragi::drivers::davis {

/// Of a Davis station, which says a reading each 2.5 s, in whole miles per hour.
class DavisFault : public StationFault {
 protected:
  DavisFault() : StationFault(16 * 0.44704, 2.5) {}

  /// Of the simulated station's other sensors.
  void expect_weather() const {
    ASSERT_FALSE(bench_.sink.station_quantities.empty());
    const wind::StationQuantities& said = bench_.sink.station_quantities.back();
    EXPECT_NEAR(said.air_temperature_c.value_or(0.0), 14.5, 1e-9);
    EXPECT_NEAR(said.pressure_hpa.value_or(0.0), 1013.24, 0.01);
    EXPECT_EQ(said.relative_humidity_percent, 65.0);
    EXPECT_NEAR(said.rain_rate_mm_h.value_or(0.0), 3.0, 1e-9);
    EXPECT_NEAR(said.rain_total_mm.value_or(0.0), 7.4, 1e-9);
  }
};

}  // namespace yuragi::drivers::davis
