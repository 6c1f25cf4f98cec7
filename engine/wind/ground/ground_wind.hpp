#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/wind/ground/wind_stroke.hpp"
#include "engine/wind/ground/wind_tapes.hpp"
#include "engine/wind/turbulence/gust_noise.hpp"
#include "engine/wind/wind_state.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::ground {

/// How the measured mean wind changes from place to place where several anemometers stand apart: a plane through their
/// means, constant beyond the outermost of them. Without a slope: the same everywhere.
struct WindSlope {
  WindVector per_m_east, per_m_south;   ///< (m/s) / m
  double west_m = 0.0, east_m = 0.0;    ///< where the plane ends, metres east of the middle of the scene
  double north_m = 0.0, south_m = 0.0;  ///< and south of it

  /// By how much the wind at a place differs from that in the middle of the scene.
  WindVector at(double at_east_m, double at_south_m) const noexcept {
    const double east = std::clamp(at_east_m, west_m, east_m) - std::clamp(0.0, west_m, east_m);
    const double south = std::clamp(at_south_m, north_m, south_m) - std::clamp(0.0, north_m, south_m);
    return east * per_m_east + south * per_m_south;
  }
};

/// The wind over the ground at one moment: the measured wind, where it has been carried to by now, and the noise that
/// fills what is not measured there (engine/wind/model.md W26). Finite. Refers to the tapes of what was measured;
/// without them (nothing is measured, or a test) all places have the same but for their own gusts. Thread-safe and
/// realtime-safe: reading, yes.
struct GroundWind {
  WindVector everywhere;                ///< without tapes: the wind of all places, less the gusts of the tiles
  WindSlope slope;                      ///< of the mean; none unless sensors stand at several places
  turbulence::GustNoise::Moment gusts;  ///< the noise, at its strength where nothing is measured
  const WindTapes* tapes = nullptr;
  double gain = 1.0;       ///< on all wind that is read from the tapes
  double gust_gain = 1.0;  ///< and on its gusts besides
  WindVector breeze;       ///< blows everywhere besides
  WindVector advection;    ///< how fast the mean wind carries the gusts and the tapes, m/s
  /// The number of the animation's tick, by which scenes spread slow work over several ticks (ReadingSchedule). Without
  /// it, all is done at once.
  std::optional<std::uint64_t> tick;

  GroundWind() = default;
  /// The same wind everywhere.
  GroundWind(WindVector wind) : everywhere(wind) {}  // NOLINT(google-explicit-constructor): a wind is a wind

  /// The wind at a place (metres east and south of the middle of the scenes) without the gusts that pass there: its
  /// mean, and what is longer than the ground.
  WindVector smooth_at(double east_m, double south_m) const noexcept {
    return tapes == nullptr ? untaped_at(east_m, south_m) : smooth(tapes->known_at(east_m, south_m), east_m, south_m);
  }

  /// The same with the gusts that were measured, without those of the noise.
  WindVector measured_at(double east_m, double south_m) const noexcept {
    return tapes == nullptr ? untaped_at(east_m, south_m) : measured(tapes->known_at(east_m, south_m), east_m, south_m);
  }

  /// The wind at a place.
  WindVector at(const turbulence::GustNoise& noise, double east_m, double south_m) const noexcept {
    return tapes == nullptr ? untaped_at(east_m, south_m) + noise.local(gusts, east_m, south_m)
                            : at(noise, tapes->at(east_m, south_m), east_m, south_m);
  }

  /// Without tapes: what a place has besides its own gusts.
  WindVector untaped_at(double east_m, double south_m) const noexcept { return everywhere + slope.at(east_m, south_m); }

  // The same three of a reading of the tapes at that place.
  WindVector smooth(const WindTapes::Known& reading, double east_m, double south_m) const noexcept {
    return reading.gain * (gain * (reading.mean + gust_gain * reading.way) + slope.at(east_m, south_m) + breeze);
  }
  WindVector measured(const WindTapes::Known& reading, double east_m, double south_m) const noexcept {
    return smooth(reading, east_m, south_m) + (reading.gain * gain * gust_gain) * reading.gusts;
  }
  WindVector at(const turbulence::GustNoise& noise, const WindTapes::Reading& reading, double east_m,
                double south_m) const noexcept {
    return measured(reading, east_m, south_m) + reading.gain * noise.local(left_of(reading), east_m, south_m);
  }

  /// The noise where this is measured.
  turbulence::GustNoise::Moment left_of(const WindTapes::Reading& reading) const noexcept {
    turbulence::GustNoise::Moment left = gusts;
    for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
      left.along_m_s[turbulence::GustNoise::kFirstTileOctave + i] *= reading.noise_along[i];
      left.across_m_s[turbulence::GustNoise::kFirstTileOctave + i] *= reading.noise_across[i];
    }
    return left;
  }
};

/// The wind that moves the scenes: what it is where it is measured, for people to see; over the ground; and what it
/// adds to the tapes. A reader of `ground` has WindTapes of its own, writes `stroke` of every moment onto them, and
/// lets `ground` refer to them: Latest may drop a moment, over which the tapes are interpolated.
struct DrivingWind {
  WindState state;
  GroundWind ground{};
  WindStroke stroke{};
};

/// The wind over the ground at this moment, read from these tapes, onto which its stroke is written.
inline GroundWind written_to(WindTapes& tapes, const DrivingWind& wind) noexcept {
  tapes.write(wind.stroke);
  GroundWind ground = wind.ground;
  ground.tapes = tapes.is_written() ? &tapes : nullptr;
  return ground;
}

/// The wind where it is measured at this moment (of several places their mean), or in the middle of the scenes where
/// nothing can be measured.
inline WindVector wind_where_measured(const GroundWind& ground, const WindStroke& stroke,
                                      const turbulence::GustNoise& noise) noexcept {
  if (stroke.pen_count == 0) return ground.at(noise, 0.0, 0.0);
  WindVector wind;
  for (const WindPen& pen : std::span(stroke.pens).first(stroke.pen_count)) {
    wind = wind + pen.part * ground.at(noise, WindTapes::at_pen(pen.now), pen.east_m, pen.south_m);
  }
  return wind;
}

/// A wind that is stronger by a factor, blowing as far.
inline GroundWind operator*(double gain, GroundWind wind) noexcept {
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
