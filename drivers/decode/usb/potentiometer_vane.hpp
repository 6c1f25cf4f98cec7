#pragma once

#include <optional>

namespace yuragi::drivers::decode::usb {

// A vane on a potentiometer: direction from the voltage of the wiper, as a share of the voltage over the track.
// Source: drivers/SOURCES.md S3.4.
//
// The track does not go round: between its end and its beginning the wiper touches nothing (the dead band, 4 degrees,
// say). There the input floats, or a resistor pulls it to a rail; both must come out as no direction. A vane whose
// track begins at the rail that it is pulled to needs a little resistance in front, and lowest_ratio above 0.

/// The track. What it must satisfy: lowest_ratio < highest_ratio, 0 < electrical_deg <= 360, all finite.
struct VaneCalibration {
  double lowest_ratio = 0.0;       ///< share of the reference voltage at the beginning of the track
  double highest_ratio = 1.0;      ///< and at its end
  double electrical_deg = 356.0;   ///< the angle that the track covers, clockwise
  double start_deg = 0.0;          ///< the direction at its beginning; any turns
  double tolerance_ratio = 0.002;  ///< by how much noise may leave the track at either end: 8 steps of 12 bits
};

/// The direction that the wind comes from, clockwise from the vane's north mark, [0, 360); empty in the dead band, with
/// no reference voltage, and for anything not finite. Thread-safe and realtime-safe: yes.
std::optional<double> vane_direction_deg(const VaneCalibration& vane, double wiper_v, double reference_v) noexcept;

}  // namespace yuragi::drivers::decode::usb
