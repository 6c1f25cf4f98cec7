#pragma once

#include <array>
#include <cstddef>

#include "engine/base/state_pass.hpp"
#include "engine/wind/ground/gust_coherence.hpp"
#include "engine/wind/turbulence/gust_noise.hpp"
#include "engine/wind/turbulence/octave_follower.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::wind::ground {

/// A number for each octave band of the measured wind, or for each octave of the noise's tiles: padded to whole SIMD
/// registers with zeros.
inline constexpr std::size_t kBandLanes = 16;
inline constexpr std::size_t kTileOctaveCount = 2 * turbulence::GustNoise::kTileOctaves;
inline constexpr std::size_t kOctaveLanes = (kTileOctaveCount + 15) / 16 * 16;
static_assert(turbulence::OctaveFollower::kBands <= kBandLanes);
using BandLanes = std::array<float, kBandLanes>;
using OctaveLanes = std::array<float, kOctaveLanes>;

/// The measured wind at one place and moment.
struct alignas(64) WindSample {
  BandLanes east_m_s{}, north_m_s{};          ///< the measured gusts of each band, times their weights
  OctaveLanes known_along{}, known_across{};  ///< the part of each noise octave's power that they cover
  Vector mean;                                ///< slower than all bands
  Vector way;                                 ///< the noise's waves that are longer than the ground
  double east_m = 0.0, south_m = 0.0;  ///< the place, minus the distance that the wind had carried the gusts by then
  double gain = 1.0;                   ///< of the ceiling

  void list_state(StatePass& pass) {
    pass(east_m_s, north_m_s, known_along, known_across, mean, way, gain);
    pass.total(east_m);
    pass.total(south_m);
  }
};

/// A sample between two.
WindSample between(const WindSample& first, const WindSample& second, double fraction) noexcept;

/// Where measured wind is written onto a tape: the place of a sensor, or the windward edge of the scenes.
struct WindPen {
  double east_m = 0.0, south_m = 0.0;  ///< from the middle of the scenes
  double part = 1.0;                   ///< of the wind that is shown to people
  double presence = 0.0;               ///< weight of its sensors among those of other places: 0 absent, 1 present
  /// For the mean (0) and each band, as they are written onto the tape.
  std::array<double, turbulence::OctaveFollower::kBands + 1> weights{};
  WindSample now;      ///< at this place
  WindSample written;  ///< the same without waves that are too short for the tape

  void list_state(StatePass& pass) { pass(east_m, south_m, part, presence, weights, now, written); }
};

/// The addition of one tick of the estimator to the tapes. A value of some kilobytes that is passed from thread to
/// thread.
struct WindStroke {
  static constexpr std::size_t kMaxPens = 4;

  std::size_t pen_count = 0;                           ///< 0: nothing can be measured, there are no tapes
  double way_m = 0.0;                                  ///< total way of the mean wind; it never decreases
  double carried_east_m = 0.0, carried_south_m = 0.0;  ///< and its vector: how far it has carried the gusts
  Vector ahead{0.0, 1.0};                              ///< unit vector downwind
  GustCoherence coherence;
  OctaveLanes octave_hz{};  ///< frequency at which each octave of the tiles passes
  std::array<WindPen, kMaxPens> pens;

  /// All but the number of pens, which is not known from the bytes alone: pens may have been added at the end.
  void list_state(StatePass& pass) {
    pass.within(way_m, 0.0, StatePass::kLargestTotal);
    pass.total(carried_east_m);
    pass.total(carried_south_m);
    pass.unit_vector(ahead.u_m_s, ahead.v_m_s);
    pass(coherence, octave_hz);
    pass.grown(std::span(pens).first(pen_count));
  }
};

}  // namespace yuragi::wind::ground
