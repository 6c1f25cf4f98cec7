#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/wind/wind_reading.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::history {

/// What a sensor reported in one step of time, before calibration.
struct Step {
  std::uint64_t readings = 0;  ///< 0: a gap, in which nothing else is known
  double sum_m_s = 0.0, min_m_s = 0.0;
  double max_m_s = 0.0;              ///< gusts that the device itself reported included
  wind::Vector vector_sum_m_s = {};  ///< of the readings with a direction

  double mean_m_s() const { return sum_m_s / static_cast<double>(readings); }

  void add(const Step& other) {
    min_m_s = readings == 0 ? other.min_m_s : std::min(min_m_s, other.min_m_s);
    max_m_s = std::max(max_m_s, other.max_m_s);
    readings += other.readings;
    sum_m_s += other.sum_m_s;
    vector_sum_m_s = vector_sum_m_s + other.vector_sum_m_s;
  }
  void add(const wind::Reading& reading) {
    const double speed_m_s = reading.speed_m_s;
    add(Step{
        .readings = 1,
        .sum_m_s = speed_m_s,
        .min_m_s = speed_m_s,
        .max_m_s = std::max(speed_m_s, reading.gust_m_s.value_or(0.0)),
        .vector_sum_m_s = reading.direction_deg ? wind::wind_from(speed_m_s, *reading.direction_deg) : wind::Vector{}});
  }
};

}  // namespace yuragi::daemon::history
