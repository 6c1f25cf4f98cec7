#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/wind/wind_reading.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::proof {

/// A stretch of real wind, measured by a sonic anemometer at equal steps of time.
struct SonicRecord {
  std::string name;
  double rate_hz = 10.0;
  std::vector<wind::Vector> samples;  ///< as the file has them: u, v

  double duration_s() const { return static_cast<double>(samples.size()) / rate_hz; }
};

/// The two recordings of Finse (engine/wind/model.md), by their number 0 or 1 (20 July 2018, 13:30 and 14:00, Finse;
/// CSAT3, 10 Hz). Empty where the folder is not there. Throws std::runtime_error for a file that cannot be read.
std::optional<SonicRecord> load_sonic(int number);

/// load_sonic(number), or where it is not there half an hour of the wind model's own: what BlendedEstimator blows
/// without a sensor, at 7 m/s with a turbulence intensity of 0.3 and gusts as unequal as gustiness 0.5 makes them. For
/// what has to hold in any wind that is as gusty as a real one; SyntheticWind, which ends at 2 Hz, is too smooth to
/// compare the effect of a fault with.
SonicRecord sonic_or_synthetic(int number);

/// What a slower sensor would have said: vector means over blocks of `interval_s`, each heard at the end of its block.
/// Their times begin at 0 with the record. A block that is not full at the end is left out.
std::vector<wind::Reading> block_means(const SonicRecord& record, double interval_s);

/// The readings of an instantaneous station: the last sample of each block, at its end.
std::vector<wind::Reading> instant_samples(const SonicRecord& record, double interval_s);

/// A made-up wind of known spectrum, along east: von Karman's along and across it (engine/wind/model.md W5), the
/// latter with 0.8 of the deviation; 54 minutes, ten samples a second.
SonicRecord von_karman_record(double speed_m_s, double intensity, double length_m, std::uint64_t seed);

}  // namespace yuragi::proof
