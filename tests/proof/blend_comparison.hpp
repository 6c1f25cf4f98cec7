#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/wind/turbulence/gust_noise.hpp"
#include "tests/proof/band_power.hpp"
#include "tests/proof/sonic_record.hpp"

namespace yuragi::proof {

/// A blade of grass: metres east and south of the middle of the scene, which is where the sensor stands.
struct Blade {
  double east_m = 0.0;
  double south_m = 0.0;
};
/// A corner of a meadow of 7 m, and two that are farther from the sensor than any wall is wide.
inline constexpr std::array<Blade, 3> kBlades = {{{3.0, -3.0}, {-20.0, 5.0}, {60.0, 25.0}}};

inline constexpr double kTick_hz = 60.0;
/// The bounds of the spectrum reach from here to there; above, the noise is compared with its own model.
inline constexpr double kFromHz = 0.003;
inline constexpr double kToHz = 0.6;
inline constexpr double kTopHz = 5.0;

/// The wind of one place against the record, mean of the seeds.
struct PlaceComparison {
  double variance = 0.0;        ///< over the record's
  double mean_speed = 0.0;      ///< over the record's
  std::vector<double> density;  ///< m^2/s^2/Hz, of u and v together, in bins of step_hz
  std::vector<double> octaves;  ///< dB over the record, from kFromHz to kToHz
  std::vector<double> above;    ///< the same of the octaves above
};

/// How sharp a wind's gusts are: of the differences between two moments kIncrement_s apart, u and v taken together.
struct Increments {
  double kurtosis = 0.0;  ///< 3 of Gaussian ones
  double far_part = 0.0;  ///< how many are beyond 4 of their deviations
};
inline constexpr double kIncrement_s = 0.2;

/// What a sensor of one interval makes of a record, against all that the record has.
struct BlendComparison {
  double interval_s = 0.0;
  double gustiness = 0.0;
  int seeds = 0;
  double from_s = 0.0, to_s = 0.0;  ///< of the record: its start is the estimator's
  WindMoments record;

  double step_hz = 0.0;
  std::vector<double> record_density, sensor_density;
  std::vector<double> sensor_octaves;  ///< dB: the readings alone, held

  std::vector<Band> octaves, above;
  /// dB in the octaves `above`, of the wind over the record with its folding taken out.
  std::vector<double> unfolded_above;
  Increments record_increments, increments;  ///< of samples 10 a second
  PlaceComparison signal;
  std::array<PlaceComparison, kBlades.size()> blades;

  std::vector<double> synthetic_density, model_density;  ///< from kToHz on: of the noise; and what it should be
  std::vector<double> synthetic_above;                   ///< dB of the noise over its model, in the octaves `above`
  std::vector<double> model_above;                       ///< m^2/s^2 in the octaves `above`

  double coherent_to_hz = 0.0;  ///< a third of the crossover
  double coherence = 0.0;       ///< of the wind and the readings held: mean from kFromHz to coherent_to_hz
  double least_coherence = 0.0;
};

/// Runs the estimator of the daemon at 60 Hz over the record as a sensor of this interval would have told it, once for
/// each seed from 1 on, and compares. The sensor stands in the middle, and so does what is compared but for the blades,
/// which read the tapes. The first max(30, 3 intervals) seconds are not compared.
BlendComparison compare_blend(const SonicRecord& record, double interval_s, double gustiness, int seeds,
                              const std::shared_ptr<const wind::turbulence::GustNoise>& noise);

}  // namespace yuragi::proof
