#include "engine/wind/ground/wind_tapes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <type_traits>

#include "engine/base/kernel.hpp"

namespace yuragi::wind::ground {
namespace {

/// A smaller share of a wave's power on the tape counts as none.
constexpr double kNothing = 1e-12;
/// The length at its end over which a tape's gusts fade out.
constexpr double kTapeEnd_m = 16.0;
/// The mean at a place is weighted by 1 / (this + distance) of each sensor.
constexpr double kNearby_m = 1.0;

constexpr KernelRows<TapeKernels> kTapeRows = YURAGI_KERNEL_ROWS(tape_kernels);

/// The maximum change of a row's lateness per renewal of the row, every half second: less than a tick.
constexpr double kLatenessStep_s = 0.01;

/// Number of places that are processed at a time.
constexpr std::size_t kPlacesAtOnce = 32;

/// The remaining part of a sensor's gusts, relative to that by the place's distance alone.
template <std::size_t lanes>
std::array<float, lanes> part_of(const std::array<float, lanes>& kept, const std::array<float, lanes>& by_distance,
                                 float besides) noexcept {
  std::array<float, lanes> part;
  for (std::size_t i = 0; i < lanes; ++i) {
    part[i] = by_distance[i] > 0.0F ? besides * std::min(kept[i] / by_distance[i], 1.0F) : 0.0F;
  }
  return part;
}

template <std::size_t lanes, std::size_t most>
void weaken(std::array<std::array<float, lanes>, most>& weights, const std::array<std::array<float, lanes>, most>& left,
            std::size_t count) noexcept {
  for (std::size_t tape = 0; tape < count; ++tape) {
    for (std::size_t i = 0; i < lanes; ++i) weights[tape][i] *= left[tape][i];
  }
}

/// OctaveFollower::Response at the frequency of each octave, band by band, so that all octaves are summed at once.
class OctaveResponses {
 public:
  using Weights = std::array<double, turbulence::OctaveFollower::kBands + 1>;

  OctaveResponses(const OctaveLanes& octave_hz, const GustCoherence& coherence) noexcept {
    for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
      const turbulence::OctaveFollower::Response response(static_cast<double>(octave_hz[i]));
      for (std::size_t band = 0; band < response.real.size(); ++band) {
        real_[band][i] = response.real[band];
        imaginary_[band][i] = response.imaginary[band];
      }
      turn_rad_s_[i] = 2.0 * std::numbers::pi * static_cast<double>(octave_hz[i]);
      const double length = static_cast<double>(octave_hz[i]) * coherence.length_m / coherence.speed_m_s;
      usual_power_[i] = length / std::pow(1.0 + 70.8 * length * length, 5.0 / 6.0);
    }
  }

  using Octaves = std::array<double, kTileOctaveCount>;
  /// For each octave the sum over the bands, each with its weight.
  struct Passed {
    Octaves real{}, imaginary{};
    double power(std::size_t i) const noexcept { return real[i] * real[i] + imaginary[i] * imaginary[i]; }
  };
  Passed passed(const Weights& weights) const noexcept {
    Passed sum;
    for (std::size_t band = 0; band < weights.size(); ++band) {
      for (std::size_t i = 0; i < kTileOctaveCount; ++i) sum.real[i] += weights[band] * real_[band][i];
      for (std::size_t i = 0; i < kTileOctaveCount; ++i) sum.imaginary[i] += weights[band] * imaginary_[band][i];
    }
    return sum;
  }

  /// The delay of `left` behind `all`, at which their correlation, sum of S |A| cos(w t - a) over the octaves, is
  /// largest, A = left conj(all) = |A| exp(-j a), S von Karman's power (W5). Iterates from `late_s`, in Newton's steps
  /// with the curvature of small angles, which are never too long.
  double later_s(double late_s, const Passed& left, const Passed& all) const noexcept {
    double slope = 0.0;
    double curvature = 0.0;
    for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
      const double real = left.real[i] * all.real[i] + left.imaginary[i] * all.imaginary[i];
      const double imaginary = left.real[i] * all.imaginary[i] - left.imaginary[i] * all.real[i];
      const double cosine = std::cos(turn_rad_s_[i] * late_s);
      const double sine = std::sin(turn_rad_s_[i] * late_s);
      slope += usual_power_[i] * turn_rad_s_[i] * (imaginary * cosine - real * sine);
      curvature += usual_power_[i] * turn_rad_s_[i] * turn_rad_s_[i] * std::sqrt(real * real + imaginary * imaginary);
    }
    if (!(curvature > kNothing)) return late_s;
    return std::max(late_s + std::clamp(slope / curvature, -kLatenessStep_s, kLatenessStep_s), 0.0);
  }

 private:
  std::array<Octaves, turbulence::OctaveFollower::kBands + 1> real_, imaginary_;
  Octaves turn_rad_s_, usual_power_;
};

double dot_product(double east, double north, Vector unit) noexcept {
  return east * unit.u_m_s + north * unit.v_m_s;
}

}  // namespace

WindTapes::WindTapes(std::size_t most_pens, SimdRow row) : kernels_(&kTapeRows[row]), tapes_(most_pens) {}

double WindTapes::distance_of(std::size_t row) noexcept {
  if (row == 0) return 0.0;
  const std::size_t step = row - 1;
  const double within = 1.0 + static_cast<double>(step % kRowsAnOctave) / static_cast<double>(kRowsAnOctave);
  return std::ldexp(within, kFirstOctave + static_cast<int>(step / kRowsAnOctave));
}

/// Rows are linear in the distance within an octave: its exponent and the first bits of its mantissa give their index.
inline WindTapes::Row WindTapes::row_of(double distance_m) noexcept {
  constexpr float kShortest_m = 1.0F / 32.0F;
  static_assert(kFirstOctave == -5 && kRowsAnOctave == 4);
  const auto distance = static_cast<float>(distance_m);
  if (distance < kShortest_m) return {0, distance / kShortest_m};
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(distance) - std::bit_cast<std::uint32_t>(kShortest_m);
  const std::size_t row = 1 + (bits >> 21U);  // two bits of the mantissa's 23
  if (row >= kRows - 1) return {kRows - 2, 1.0F};
  return {row, static_cast<float>(bits & 0x1FFFFFU) * 0x1p-21F};
}

void WindTapes::write(const WindStroke& stroke) noexcept {
  const std::size_t pen_count = std::min(stroke.pen_count, tapes_.size());
  const bool is_new = pen_count_ != pen_count;
  pen_count_ = pen_count;
  if (pen_count_ == 0) return;
  stroke_ = stroke;
  for (std::size_t i = 0; i < pen_count_; ++i) tapes_[i].write(stroke.pens[i], stroke.way_m);

  for (std::size_t band = 0; band < turbulence::OctaveFollower::kBands; ++band) {
    band_loss_per_m_[band] =
        static_cast<float>(stroke.coherence.loss_per_m(turbulence::OctaveFollower::centre_hz(band)));
  }
  for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
    octave_loss_per_m_[i] = static_cast<float>(stroke.coherence.loss_per_m(static_cast<double>(stroke.octave_hz[i])));
  }
  renew_rows(is_new);
  if (pen_count_ == 1) return;
  const std::span pens(stroke_.pens.data(), pen_count_);
  band_kriging_.prepare(pens, stroke.ahead, stroke.coherence,
                        [this](std::size_t tape, double distance_m) { return bands_kept(tape, distance_m); });
  octave_kriging_.prepare(pens, stroke.ahead, stroke.coherence,
                          [this](std::size_t tape, double distance_m) { return octaves_kept(tape, distance_m); });
}

void WindTapes::list_state(StatePass& pass) {
  pass.grown(std::span(tapes_));
  pass.grown(std::span(kept_).first(tapes_.size()));
  pass.index(pen_count_, tapes_.size() + 1);
  std::size_t turn = next_row_ / kRowsATick;
  pass.index(turn, kRows / kRowsATick);
  next_row_ = turn * kRowsATick;
}

void WindTapes::renew_rows(bool all) noexcept {
  static_assert(kRows % kRowsATick == 0);
  keep(all ? 0 : next_row_, all ? kRows : kRowsATick);
  next_row_ = (next_row_ + kRowsATick) % kRows;
}

/// The remaining part at some distances, for each band and for each octave of the noise, which is in several bands.
void WindTapes::keep(std::size_t first_row, std::size_t count) noexcept {
  const OctaveResponses responses(stroke_.octave_hz, stroke_.coherence);
  std::array<OctaveResponses::Passed, WindStroke::kMaxPens> all;
  for (std::size_t tape = 0; tape < pen_count_; ++tape) all[tape] = responses.passed(stroke_.pens[tape].weights);
  for (std::size_t row = first_row; row < first_row + count; ++row) {
    const double distance_m = distance_of(row);
    BandLanes bands{};
    for (std::size_t band = 0; band < turbulence::OctaveFollower::kBands; ++band) {
      bands[band] = static_cast<float>(std::exp(-distance_m * static_cast<double>(band_loss_per_m_[band])));
    }
    for (std::size_t tape = 0; tape < pen_count_; ++tape) {
      Kept& here = kept_[tape][row];
      here.bands = bands;
      auto left = stroke_.pens[tape].weights;
      for (std::size_t band = 0; band < turbulence::OctaveFollower::kBands; ++band) {
        left[1 + band] *= static_cast<double>(bands[band]);
      }
      const OctaveResponses::Passed passed = responses.passed(left);
      here.late_s = responses.later_s(here.late_s, passed, all[tape]);
      for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
        // If nothing is measured yet: that of its own frequency, so that the first readings count at the pen at once.
        const auto own = [&] { return std::exp(-2.0 * distance_m * static_cast<double>(octave_loss_per_m_[i])); };
        const double power = all[tape].power(i);
        const double kept = power > kNothing ? passed.power(i) / power : own();
        here.octaves[i] = static_cast<float>(std::clamp(kept, 0.0, 1.0));
      }
    }
  }
}

inline WindTapes::Found WindTapes::find(std::size_t tape, double east_m, double south_m) const noexcept {
  const WindPen& pen = stroke_.pens[tape];
  const double downwind_m = dot_product(east_m - pen.east_m, pen.south_m - south_m, stroke_.ahead);
  Found found{.place = tapes_[tape].back(std::max(downwind_m, 0.0))};

  // The distance of the place from the present place of the air that was measured then.
  const WindSample& first = *found.place.first;
  const WindSample& second = *found.place.second;
  const double fraction = found.place.fraction;
  const double parcel_east_m = first.east_m + fraction * (second.east_m - first.east_m) + stroke_.carried_east_m;
  const double parcel_south_m = first.south_m + fraction * (second.south_m - first.south_m) + stroke_.carried_south_m;
  double away_east_m = east_m - parcel_east_m;
  double away_north_m = parcel_south_m - south_m;
  if (downwind_m < 0.0) {
    const double along_m = dot_product(away_east_m, away_north_m, stroke_.ahead);
    away_east_m -= along_m * stroke_.ahead.u_m_s;
    away_north_m -= along_m * stroke_.ahead.v_m_s;
  }
  const double away_m = std::sqrt(away_east_m * away_east_m + away_north_m * away_north_m);
  found.distance_m = stroke_.coherence.distance_m(std::max(downwind_m, 0.0), away_m) + std::max(-downwind_m, 0.0);
  if (downwind_m > 0.0) {
    const Row row = row_of(found.distance_m);
    const double near_s = kept_[tape][row.below].late_s;
    const double far_s = kept_[tape][row.below + 1].late_s;
    const double late_m = stroke_.coherence.speed_m_s * (near_s + static_cast<double>(row.fraction) * (far_s - near_s));
    found.place = tapes_[tape].back(std::max(downwind_m - late_m, 0.0));
  }
  found.kept = static_cast<float>(std::clamp(found.place.left_m / kTapeEnd_m, 0.0, 1.0));
  return found;
}

/// The distance of the coherence law by the place alone: from the pen, along and across the wind.
double WindTapes::from_pen_m(std::size_t tape, double east_m, double south_m) const noexcept {
  const WindPen& pen = stroke_.pens[tape];
  const double north_m = pen.south_m - south_m;
  const double downwind_m = dot_product(east_m - pen.east_m, north_m, stroke_.ahead);
  const double beside_m = (east_m - pen.east_m) * stroke_.ahead.v_m_s - north_m * stroke_.ahead.u_m_s;
  return stroke_.coherence.distance_m(downwind_m, beside_m);
}

WindTapes::Reading WindTapes::at(double east_m, double south_m) const noexcept {
  if (pen_count_ != 1) return at_several(east_m, south_m);
  const Found found = find(0, east_m, south_m);
  const TapeKernelPlace place = on_tape(found);
  Reading reading;
  static_cast<Known&>(reading) = slow_part(found.place);
  float east = 0.0F;
  float north = 0.0F;
  kernels_->gusts(place, &east, &north);
  kernels_->octaves(place, reading.noise_along.data(), reading.noise_across.data());
  reading.gusts = {static_cast<double>(east), static_cast<double>(north)};
  return reading;
}

WindTapes::Known WindTapes::known_at(double east_m, double south_m) const noexcept {
  if (pen_count_ != 1) return at_several(east_m, south_m);
  const Found found = find(0, east_m, south_m);
  Known known = slow_part(found.place);
  float east = 0.0F;
  float north = 0.0F;
  kernels_->gusts(on_tape(found), &east, &north);
  known.gusts = {static_cast<double>(east), static_cast<double>(north)};
  return known;
}

void WindTapes::read(std::span<const double> east_m, std::span<const double> south_m, std::span<Known> known,
                     const NoiseLeft& left) const noexcept {
  if (pen_count_ != 1) {
    for (std::size_t place = 0; place < east_m.size(); ++place) {
      const Reading reading = at_several(east_m[place], south_m[place]);
      if (!known.empty()) known[place] = reading;
      for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
        if (left.along[i].empty()) continue;
        left.along[i][place] = reading.noise_along[i];
        left.across[i][place] = reading.noise_across[i];
      }
    }
    return;
  }
  TapeKernelArguments arguments;
  for (std::size_t i = 0; i < kTileOctaveCount; ++i) {
    if (left.along[i].empty()) continue;
    arguments.octaves[arguments.octave_count++] = {i, left.along[i].data(), left.across[i].data()};
  }
  for (std::size_t begin = 0; begin < east_m.size(); begin += kPlacesAtOnce) {
    const std::size_t count = std::min(kPlacesAtOnce, east_m.size() - begin);
    read_one_tape(east_m.subspan(begin, count), south_m.subspan(begin, count),
                  known.empty() ? known : known.subspan(begin, count), arguments);
    for (TapeKernelOctave& octave : std::span(arguments.octaves).first(arguments.octave_count)) {
      octave.along += count;
      octave.across += count;
    }
  }
}

void WindTapes::read_one_tape(std::span<const double> east_m, std::span<const double> south_m, std::span<Known> known,
                              TapeKernelArguments& arguments) const noexcept {
  std::array<TapeKernelPlace, kPlacesAtOnce> places;
  std::array<float, kPlacesAtOnce> east_m_s;
  std::array<float, kPlacesAtOnce> north_m_s;
  for (std::size_t i = 0; i < east_m.size(); ++i) {
    const Found found = find(0, east_m[i], south_m[i]);
    places[i] = on_tape(found);
    if (!known.empty()) known[i] = slow_part(found.place);
  }
  arguments.count = east_m.size();
  arguments.places = places.data();
  arguments.east_m_s = known.empty() ? nullptr : east_m_s.data();
  arguments.north_m_s = north_m_s.data();
  kernels_->many(arguments);
  for (std::size_t i = 0; i < known.size(); ++i) {
    known[i].gusts = {static_cast<double>(east_m_s[i]), static_cast<double>(north_m_s[i])};
  }
}

WindTapes::Reading WindTapes::at_pen(const WindSample& now) noexcept {
  Reading reading;
  reading.mean = now.mean;
  reading.way = now.way;
  reading.gain = now.gain;
  for (std::size_t i = 0; i < kBandLanes; ++i) {
    reading.gusts = reading.gusts + Vector{static_cast<double>(now.east_m_s[i]), static_cast<double>(now.north_m_s[i])};
  }
  for (std::size_t i = 0; i < kOctaveLanes; ++i) {
    reading.noise_along[i] = std::sqrt(std::max(1.0F - now.known_along[i], 0.0F));
    reading.noise_across[i] = std::sqrt(std::max(1.0F - now.known_across[i], 0.0F));
  }
  return reading;
}

/// The kernel's view of a place: the lanes of a sample, and of the table of losses, are contiguous.
TapeKernelPlace WindTapes::on_tape(const Found& found) const noexcept {
  static_assert(kBandLanes == kTapeBandLanes && kOctaveLanes == kTapeOctaveLanes);
  static_assert(std::is_standard_layout_v<WindSample> && std::is_standard_layout_v<Kept>);
  constexpr std::size_t kBandBytes = sizeof(BandLanes);
  static_assert(offsetof(WindSample, east_m_s) == 0 && offsetof(WindSample, north_m_s) == kBandBytes);
  static_assert(offsetof(WindSample, known_along) == 2 * kBandBytes);
  static_assert(offsetof(WindSample, known_across) == 2 * kBandBytes + sizeof(OctaveLanes));
  static_assert(offsetof(Kept, bands) == 0 && offsetof(Kept, octaves) == kBandBytes);
  const Row row = row_of(found.distance_m);
  return {.first = reinterpret_cast<const float*>(found.place.first),
          .second = reinterpret_cast<const float*>(found.place.second),
          .near = reinterpret_cast<const float*>(&kept_[0][row.below]),
          .far = reinterpret_cast<const float*>(&kept_[0][row.below + 1]),
          .fraction = static_cast<float>(found.place.fraction),
          .row_fraction = row.fraction,
          .kept = found.kept};
}

/// The part slower than all bands.
WindTapes::Known WindTapes::slow_part(const WindTape::Place& place) noexcept {
  const WindSample& first = *place.first;
  const WindSample& second = *place.second;
  return {.mean = first.mean + place.fraction * (second.mean - first.mean),
          .way = first.way + place.fraction * (second.way - first.way),
          .gusts = {},
          .gain = first.gain + place.fraction * (second.gain - first.gain)};
}

/// The part of each band's amplitude that is left at a distance.
BandLanes WindTapes::bands_kept(std::size_t tape, double distance_m) const noexcept {
  const Row row = row_of(distance_m);
  const BandLanes& near = kept_[tape][row.below].bands;
  const BandLanes& far = kept_[tape][row.below + 1].bands;
  BandLanes result;
  for (std::size_t i = 0; i < kBandLanes; ++i) result[i] = near[i] + row.fraction * (far[i] - near[i]);
  return result;
}

/// The part of each noise octave's amplitude that is left, by the bands that carry it.
OctaveLanes WindTapes::octaves_kept(std::size_t tape, double distance_m) const noexcept {
  const Row row = row_of(distance_m);
  const OctaveLanes& near = kept_[tape][row.below].octaves;
  const OctaveLanes& far = kept_[tape][row.below + 1].octaves;
  OctaveLanes result;
  for (std::size_t i = 0; i < kOctaveLanes; ++i) {
    result[i] = std::sqrt(near[i] + row.fraction * (far[i] - near[i]));
  }
  return result;
}

/// The weights of the sensors follow from their places and this one (GustKriging). Other losses (a gust that has not
/// arrived yet, a wind that has turned, the end of a tape) reduce each sensor's own part.
WindTapes::Reading WindTapes::at_several(double east_m, double south_m) const noexcept {
  constexpr std::size_t kMost = WindStroke::kMaxPens;
  std::array<WindSample, kMost> samples;
  std::array<BandLanes, kMost> bands, bands_left, band_weights;
  std::array<OctaveLanes, kMost> octaves, octaves_left, octave_weights;
  Reading reading;
  reading.gain = 0.0;
  double counted = 0.0;
  for (std::size_t tape = 0; tape < pen_count_; ++tape) {
    const Found found = find(tape, east_m, south_m);
    samples[tape] = between(*found.place.first, *found.place.second, found.place.fraction);
    const double alone_m = std::min(from_pen_m(tape, east_m, south_m), found.distance_m);
    bands[tape] = bands_kept(tape, alone_m);
    octaves[tape] = octaves_kept(tape, alone_m);
    bands_left[tape] = part_of(bands_kept(tape, found.distance_m), bands[tape], found.kept);
    octaves_left[tape] = part_of(octaves_kept(tape, found.distance_m), octaves[tape], found.kept);
    const double counts = std::max(stroke_.pens[tape].presence, 1e-9) / (kNearby_m + found.distance_m);
    counted += counts;
    reading.mean = reading.mean + counts * samples[tape].mean;
    reading.way = reading.way + counts * samples[tape].way;
    reading.gain += counts * samples[tape].gain;
  }
  reading.mean = (1.0 / counted) * reading.mean;
  reading.way = (1.0 / counted) * reading.way;
  reading.gain /= counted;

  band_kriging_.weigh(bands, band_weights);
  weaken(band_weights, bands_left, pen_count_);
  float east = 0.0F;
  float north = 0.0F;
  for (std::size_t tape = 0; tape < pen_count_; ++tape) {
    for (std::size_t i = 0; i < kBandLanes; ++i) {
      east += band_weights[tape][i] * samples[tape].east_m_s[i];
      north += band_weights[tape][i] * samples[tape].north_m_s[i];
    }
  }
  reading.gusts = {static_cast<double>(east), static_cast<double>(north)};

  octave_kriging_.weigh(octaves, octave_weights);
  weaken(octave_weights, octaves_left, pen_count_);
  const auto fill = [&](OctaveLanes WindSample::*known, OctaveLanes& noise) {
    const OctaveLanes power =
        octave_kriging_.power(octave_weights, [&](std::size_t i, std::size_t j, std::size_t lane) {
          return std::sqrt((samples[i].*known)[lane] * (samples[j].*known)[lane]);
        });
    for (std::size_t i = 0; i < kOctaveLanes; ++i) noise[i] = std::sqrt(std::clamp(1.0F - power[i], 0.0F, 1.0F));
  };
  fill(&WindSample::known_along, reading.noise_along);
  fill(&WindSample::known_across, reading.noise_across);
  return reading;
}

}  // namespace yuragi::wind::ground
