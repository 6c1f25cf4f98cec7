#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/simd_row.hpp"
#include "engine/base/state_pass.hpp"
#include "engine/wind/ground/gust_kriging.hpp"
#include "engine/wind/ground/tape_kernels.hpp"
#include "engine/wind/ground/wind_stroke.hpp"
#include "engine/wind/ground/wind_tape.hpp"

namespace yuragi::wind::ground {

/// The measured wind and its present place: the tapes of all places with a sensor, and the part of their content that
/// is still valid at any place over the ground (engine/wind/model.md W24 to W27).
///
/// At a place x, a way D = (x - pen) . ahead downwind of the pen, the tape is read at D of the way ago. The air of that
/// moment is now at P = its pen + its displacement since, and the place is |x - P| away from it: across the wind in a
/// steady wind, farther where the wind has turned. So the distance by which gusts are lost (GustCoherence) has two
/// parts, that way across and D along; a place upwind of the pen reads the newest sample, whose weight decreases with
/// the time that the gust still needs to the pen (per wave exp(-kappa |D|), as a reading of that age). Noise replaces
/// the lost power: an octave of which the part k was known at the pen has the factor sqrt(1 - k g^2) there, g being the
/// part kept by the bands that carry this octave.
///
/// Several places: GustKriging per octave; the mean and the way's noise from all of them, the nearest most.
///
/// This is conditional simulation with the condition at a place, as PyConTurb (Rinker 2018) and TurbSim do it for a
/// whole recorded box, but it continues in time. Bands lose by causal low passes: the remaining part is late. A place
/// downwind of the pen is ahead of the gusts that are on the tape, and reads them earlier by that much, so that gusts
/// arrive with the wind. Known limits: a place 7 m beside the sensor lags by up to 0.6 s; frozen noise does not change
/// along the way, so that with a sensor of 1 s the fast octaves of two places along the wind are more similar than in
/// nature.
///
/// Owns the tapes. The table of losses over distance is renewed by a few rows a tick. Thread-safe: reading, yes.
/// Realtime-safe: all but construction. Every SIMD row computes the same bits.
class WindTapes {
 public:
  /// Tapes for this many pens; further ones are ignored.
  explicit WindTapes(std::size_t most_pens = WindStroke::kMaxPens, SimdRow row = best_simd_row());

  /// Adds a tick's stroke. If the way goes back, the tapes start again.
  void write(const WindStroke& stroke) noexcept;

  /// Is there anything written?
  bool is_written() const noexcept { return pen_count_ > 0; }

  /// The measured wind at a place.
  struct Known {
    Vector mean, way, gusts;  ///< gusts: all measured bands, with their kept parts
    double gain = 1.0;        ///< of the ceiling, when this wind was measured
  };
  /// And the factors on the noise.
  struct Reading : Known {
    OctaveLanes noise_along{}, noise_across{};  ///< factors on each octave of the tiles, 0 to 1
  };
  /// Metres east and south of the middle of the scenes.
  Reading at(double east_m, double south_m) const noexcept;
  /// The same without the noise.
  Known known_at(double east_m, double south_m) const noexcept;

  /// The remaining part of the noise at many places: for each octave of the tiles a factor for each place; empty: not
  /// requested. An octave is requested along and across.
  struct NoiseLeft {
    std::array<std::span<float>, kTileOctaveCount> along, across;
  };
  /// The same at many places, with the same bits; `known` can be empty. All other arrays have the same size.
  void read(std::span<const double> east_m, std::span<const double> south_m, std::span<Known> known,
            const NoiseLeft& left) const noexcept;
  /// The same at the place of a sample, at that moment.
  static Reading at_pen(const WindSample& now) noexcept;

  /// The rest of it follows from the next stroke.
  void list_state(StatePass& pass);

 private:
  /// The kept part at some distances, evenly spread over its logarithm, with linear interpolation.
  static constexpr std::size_t kRowsAnOctave = 4;
  static constexpr int kFirstOctave = -5, kLastOctave = 9;  ///< from 1/32 m to 512 m
  static constexpr std::size_t kRows = 2 + kRowsAnOctave * static_cast<std::size_t>(kLastOctave - kFirstOctave);
  static constexpr std::size_t kRowsATick = 2;
  struct Kept {
    BandLanes bands{};
    OctaveLanes octaves{};  ///< in power
    double late_s = 0.0;    ///< delay of the remaining bands behind all of them

    void list_state(StatePass& pass) {
      pass.within(std::span<float>(bands), 0.0, 1.0);
      pass.within(std::span<float>(octaves), 0.0, 1.0);
      pass.within(late_s, 0.0, StatePass::kLargest);
    }
  };
  struct Row {
    std::size_t below = 0;
    float fraction = 0.0F;
  };
  static double distance_of(std::size_t row) noexcept;
  static Row row_of(double distance_m) noexcept;

  /// A tape at the position that a place reads.
  struct Found {
    WindTape::Place place;
    double distance_m = 0.0;  ///< the distance that determines the loss of gusts
    float kept = 1.0F;        ///< reduced at the end of the tape
  };
  Found find(std::size_t tape, double east_m, double south_m) const noexcept;
  double from_pen_m(std::size_t tape, double east_m, double south_m) const noexcept;
  void keep(std::size_t first_row, std::size_t count) noexcept;
  void renew_rows(bool all) noexcept;
  TapeKernelPlace on_tape(const Found& found) const noexcept;
  static Known slow_part(const WindTape::Place& place) noexcept;
  void read_one_tape(std::span<const double> east_m, std::span<const double> south_m, std::span<Known> known,
                     TapeKernelArguments& arguments) const noexcept;
  BandLanes bands_kept(std::size_t tape, double distance_m) const noexcept;
  OctaveLanes octaves_kept(std::size_t tape, double distance_m) const noexcept;
  Reading at_several(double east_m, double south_m) const noexcept;

  const TapeKernels* kernels_;
  std::vector<WindTape> tapes_;
  std::size_t pen_count_ = 0;
  WindStroke stroke_;
  BandLanes band_loss_per_m_{};
  OctaveLanes octave_loss_per_m_{};
  std::array<std::array<Kept, kRows>, WindStroke::kMaxPens> kept_{};  ///< of each tape
  std::size_t next_row_ = 0;                                          ///< to be renewed
  GustKriging<kBandLanes> band_kriging_;
  GustKriging<kOctaveLanes> octave_kriging_;
};

}  // namespace yuragi::wind::ground
