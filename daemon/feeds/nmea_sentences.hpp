#pragma once

#include <string>

namespace yuragi::daemon::feeds {

/// The wind as NMEA 0183 has it.
struct NmeaWind {
  double speed_m_s = 0.0;
  double direction_deg = 0.0;  ///< where it comes from, clockwise from true north
  bool is_valid = true;
};

// Sentences of the talker WI (weather instrument), with checksum and line end (gpsd's NMEA Revealed, "MWV", "MWD").
// Pure.

/// $WIMWV,direction,T,speed,M,A|V: the angle is from the bow, which for a wall points north; T: the true wind.
std::string mwv_sentence(const NmeaWind& wind);

/// $WIMWD,direction,T,,M,knots,N,speed,M: from true north; the magnetic direction is not known. Without values if they
/// are not valid.
std::string mwd_sentence(const NmeaWind& wind);

}  // namespace yuragi::daemon::feeds
