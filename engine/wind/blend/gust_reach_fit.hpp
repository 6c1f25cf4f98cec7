#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/state_pass.hpp"
#include "engine/wind/ground/wind_stroke.hpp"
#include "engine/wind/turbulence/octave_follower.hpp"

namespace yuragi::wind::blend {

/// The reach of gusts at a site, relative to the law of GustCoherence, learnt from its own pairs of sensors (W44): the
/// logarithms of the factors across the wind and along it, and the variance of each.
struct GustReach {
  /// For an unknown site: the law's constants differ from site to site by about this.
  static constexpr double kPriorVariance = 0.25;
  /// Largest factor, and the inverse of the smallest.
  static constexpr double kMaxFactor = 3.0;

  double across_ln = 0.0, along_ln = 0.0;
  double across_variance = kPriorVariance, along_variance = kPriorVariance;

  /// The factors, each only once it is known within 20 %.
  std::optional<double> across() const noexcept;
  std::optional<double> along() const noexcept;

  bool operator==(const GustReach&) const = default;

  void list_state(StatePass& pass) {
    pass.within(across_ln, -2.0, 2.0);
    pass.within(along_ln, -2.0, 2.0);
    pass.within(across_variance, 0.0, kPriorVariance);
    pass.within(along_variance, 0.0, kPriorVariance);
  }
};

/// May that have been learnt? Pure.
bool is_valid(const GustReach& reach) noexcept;

/// Learns GustReach from measurements at several places, octave band by octave band. A gust of one place is compared
/// with that of the other at the moment when the mean wind has carried it there, as WindTapes reads it; the product of
/// the two, over their deviations, is expected to be the root coherence. An extended Kalman filter (Jazwinski 1970,
/// Stochastic Processes and Filtering Theory, 8.3) of two logarithms, bounded; it has a memory of hours of learning,
/// and does not change while nothing can be learnt. Causal; steps are at most some per cent.
///
/// Allocates at construction only. Thread-safe: no. Realtime-safe after construction: yes; some microseconds a tick.
class GustReachFit {
 public:
  static constexpr std::size_t kBands = turbulence::OctaveFollower::kBands;

  /// The measurements at a place.
  struct Place {
    double east_m = 0.0, south_m = 0.0;    ///< where its sensors stand
    double delay_s = 0.0;                  ///< delay of its readings: averaging and hold
    const ground::WindPen* pen = nullptr;  ///< null: the place of its sensors is unknown
  };

  /// `place_count`: with fewer than two nothing is learnt.
  explicit GustReachFit(std::size_t place_count);

  /// Advances by a tick. `stroke` and `places` (place_count of them) are of this tick.
  void advance(double dt_s, const ground::WindStroke& stroke, std::span<const Place> places) noexcept;

  const GustReach& reach() const noexcept { return reach_; }
  /// Continues from an earlier run's result. Returns false, and changes nothing, if it is implausible.
  bool restore(const GustReach& reach) noexcept;

  void list_state(StatePass& pass) {
    pass.grown(std::span(traces_));
    pass(paces_, reach_, covariance_);
    pass.total(since_observed_s_);
  }

 private:
  /// A band of one place at a moment, relative to the mean speed, and the position along the wind's way.
  struct Sample {
    double way_m = 0.0;
    double carried_east_m = 0.0, carried_south_m = 0.0;
    Vector gust{};
    bool is_known = false;

    void list_state(StatePass& pass) {
      pass.total(way_m);
      pass.total(carried_east_m);
      pass.total(carried_south_m);
      pass(gust, is_known);
    }
  };
  static constexpr std::size_t kSamples = 128;

  /// A band of one place.
  struct Trace {
    std::array<Sample, kSamples> ring{};
    double power = 0.0;    ///< mean square of its gusts over the mean speed
    double known_s = 0.0;  ///< duration of its measurement

    void list_state(StatePass& pass) { pass(ring, power, known_s); }
  };

  Trace& trace(std::size_t place, std::size_t band) noexcept { return traces_[place * kBands + band]; }
  void sample(std::size_t band, double passed_s, const ground::WindStroke& stroke,
              std::span<const Place> places) noexcept;
  void compare(std::size_t band, const ground::WindStroke& stroke, std::span<const Place> places) noexcept;
  void observe(std::size_t band, double product, double along_m, double across_m,
               const ground::GustCoherence& law) noexcept;
  bool read(const Trace& trace, std::size_t newest, double way_m, const ground::WindStroke& stroke,
            Vector& gust) const noexcept;

  std::size_t place_count_;
  std::vector<Trace> traces_;
  struct Pace {
    double since_s = 0.0;    ///< since the last sample
    std::size_t newest = 0;  ///< its place in the rings

    void list_state(StatePass& pass) {
      pass(since_s);
      pass.index(newest, kSamples);
    }
  };
  std::array<Pace, kBands> paces_{};
  GustReach reach_;
  double covariance_ = 0.0;
  double since_observed_s_ = 0.0;
  bool has_observed_ = false;  ///< in this tick
};

}  // namespace yuragi::wind::blend
