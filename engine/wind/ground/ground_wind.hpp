#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/state_pass.hpp"
#include "engine/wind/ground/wind_stroke.hpp"
#include "engine/wind/ground/wind_tapes.hpp"
#include "engine/wind/turbulence/gust_noise.hpp"
#include "engine/wind/wind_state.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::ground {

/// The change of the measured mean wind from place to place, with anemometers at several places: a plane through their
/// means, constant beyond the outermost of them. Without a slope: the same everywhere.
struct WindSlope {
  Vector per_m_east, per_m_south;       ///< (m/s) / m
  double west_m = 0.0, east_m = 0.0;    ///< ends of the plane, metres east of the middle of the scene
  double north_m = 0.0, south_m = 0.0;  ///< and south of it

  /// All but its ends, which never change.
  void list_state(StatePass& pass) { pass(per_m_east, per_m_south); }

  /// The difference of the wind at a place from that in the middle of the scene.
  Vector at(double at_east_m, double at_south_m) const noexcept {
    const double east = std::clamp(at_east_m, west_m, east_m) - std::clamp(0.0, west_m, east_m);
    const double south = std::clamp(at_south_m, north_m, south_m) - std::clamp(0.0, north_m, south_m);
    return east * per_m_east + south * per_m_south;
  }
};

/// The wind over the ground at one moment: the measured wind at the places to which it has been carried, and the noise
/// that fills the rest (engine/wind/model.md W26). Finite. Refers to the tapes of the measured wind; without them
/// (nothing is measured, or a test) all places have the same wind except for their own gusts. Thread-safe and
/// realtime-safe: reading, yes.
struct Wind {
  Vector everywhere;                    ///< without tapes: the wind of all places, minus the gusts of the tiles
  WindSlope slope;                      ///< of the mean; zero unless sensors are at several places
  turbulence::GustNoise::Moment gusts;  ///< the noise, at its strength without measurements
  const WindTapes* tapes = nullptr;
  double gain = 1.0;       ///< factor on all wind that is read from the tapes
  double gust_gain = 1.0;  ///< further factor on its gusts
  Vector breeze;           ///< blows everywhere besides
  Vector advection;        ///< how fast the mean wind carries the gusts and the tapes, m/s
  /// The number of the animation's tick, by which scenes spread slow work over several ticks (ReadingSchedule). Without
  /// it, all is done at once.
  std::optional<std::uint64_t> tick;

  /// What the maker of the wind keeps from tick to tick; the rest is added later.
  void list_state(StatePass& pass) { pass(everywhere, slope, gusts, advection); }

  Wind() = default;
  /// The same wind everywhere.
  Wind(Vector wind) : everywhere(wind) {}  // NOLINT(google-explicit-constructor): a wind is a wind

  /// The wind at a place (metres east and south of the middle of the scenes) without its local gusts: its mean, and the
  /// waves that are longer than the ground.
  Vector smooth_at(double east_m, double south_m) const noexcept {
    return tapes == nullptr ? untaped_at(east_m, south_m) : smooth(tapes->known_at(east_m, south_m), east_m, south_m);
  }

  /// The same with the gusts that were measured, without those of the noise.
  Vector measured_at(double east_m, double south_m) const noexcept {
    return tapes == nullptr ? untaped_at(east_m, south_m) : measured(tapes->known_at(east_m, south_m), east_m, south_m);
  }

  /// The wind at a place.
  Vector at(const turbulence::GustNoise& noise, double east_m, double south_m) const noexcept {
    return tapes == nullptr ? untaped_at(east_m, south_m) + noise.local(gusts, east_m, south_m)
                            : at(noise, tapes->at(east_m, south_m), east_m, south_m);
  }

  /// Without tapes: the wind of a place without its own gusts.
  Vector untaped_at(double east_m, double south_m) const noexcept { return everywhere + slope.at(east_m, south_m); }

  // The same three of a reading of the tapes at that place.
  Vector smooth(const WindTapes::Known& reading, double east_m, double south_m) const noexcept {
    return reading.gain * (gain * (reading.mean + gust_gain * reading.way) + slope.at(east_m, south_m) + breeze);
  }
  Vector measured(const WindTapes::Known& reading, double east_m, double south_m) const noexcept {
    return smooth(reading, east_m, south_m) + (reading.gain * gain * gust_gain) * reading.gusts;
  }
  Vector at(const turbulence::GustNoise& noise, const WindTapes::Reading& reading, double east_m,
            double south_m) const noexcept {
    return measured(reading, east_m, south_m) + reading.gain * noise.local(left_of(reading), east_m, south_m);
  }

  /// The noise that remains with this measurement.
  turbulence::GustNoise::Moment left_of(const WindTapes::Reading& reading) const noexcept {
    turbulence::GustNoise::Moment left = gusts;
    for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
      left.along_m_s[turbulence::GustNoise::kFirstTileOctave + i] *= reading.noise_along[i];
      left.across_m_s[turbulence::GustNoise::kFirstTileOctave + i] *= reading.noise_across[i];
    }
    return left;
  }
};

/// The wind that moves the scenes: at the place of measurement, for display; over the ground; and its addition to the
/// tapes. A reader of `ground` has its own WindTapes, writes `stroke` of every moment onto them, and makes `ground`
/// refer to them: Latest can drop a moment; the tapes are then interpolated.
struct DrivingWind {
  State state;
  Wind ground{};
  WindStroke stroke{};
};

/// The wind over the ground at this moment, read from these tapes, after its stroke is written onto them.
inline Wind written_to(WindTapes& tapes, const DrivingWind& wind) noexcept {
  tapes.write(wind.stroke);
  Wind ground = wind.ground;
  ground.tapes = tapes.is_written() ? &tapes : nullptr;
  return ground;
}

/// The wind at the place of measurement at this moment (for several places their mean), or in the middle of the scenes
/// if nothing can be measured.
inline Vector wind_where_measured(const Wind& ground, const WindStroke& stroke,
                                  const turbulence::GustNoise& noise) noexcept {
  if (stroke.pen_count == 0) return ground.at(noise, 0.0, 0.0);
  Vector wind;
  for (const WindPen& pen : std::span(stroke.pens).first(stroke.pen_count)) {
    wind = wind + pen.part * ground.at(noise, WindTapes::at_pen(pen.now), pen.east_m, pen.south_m);
  }
  return wind;
}

/// The wind multiplied by a factor, with the same distances.
inline Wind operator*(double gain, Wind wind) noexcept {
  wind.everywhere = gain * wind.everywhere;
  wind.slope.per_m_east = gain * wind.slope.per_m_east;
  wind.slope.per_m_south = gain * wind.slope.per_m_south;
  wind.gain *= gain;
  wind.breeze = gain * wind.breeze;
  for (float& deviation : wind.gusts.along_m_s) deviation *= static_cast<float>(gain);
  for (float& deviation : wind.gusts.across_m_s) deviation *= static_cast<float>(gain);
  return wind;
}

}  // namespace yuragi::wind::ground
