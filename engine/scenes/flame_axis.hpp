#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/base/state_pass.hpp"
#include "engine/math/critically_damped.hpp"
#include "engine/noise/line_cut.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/operators/oscillator_job.hpp"
#include "engine/operators/propagation_history.hpp"

namespace yuragi::scenes {

/// Tilt and length of a fire in the open in a wind, measured on burning cribs and pools (engine/METHOD.md M36).
///
/// u* = u / (g m D / rho)^(1/3), m the fuel that burns (0.02 kg/(m2 s): wood), D the width of its foot. The tilt from
/// upright has cos = (1 + u*^2)^(-1/4): u*^(-1/2) in a wind (American Gas Association 1974, LNG Safety Research
/// Program, report IS 3-1; Thomas 1963, The size of flames from natural fires, has 0.7 u*^-0.49), and 1 in calm air.
/// Its length is max(u*, 1)^-0.21 of that in calm air (Thomas 1963).
struct FlameInWind {
  double lean = 0.0;  ///< tangent of half the tilt, as in lean.hpp: below 1
  double part = 1.0;  ///< relative to the length in calm air, above 0

  /// u* of at least 0. Only by square roots, which are the same on every machine. Thread-safe and realtime-safe: yes.
  static FlameInWind at(double relative_wind) noexcept;
};

/// Parameters of a flame's axis.
struct FlameAxisSpec {
  std::size_t rows = 96;        ///< 2 or more, evenly from the foot to the top
  double height_m = 1.2;        ///< of the axis, in calm air
  double felt_at_m = 0.6;       ///< how high over the ground it feels the wind
  double foot_m = 0.5;          ///< its width
  double rise_m_s = 2.5;        ///< of its gas: the delay of a row after the foot
  double wobble = 0.1;          ///< standard deviation of its own sway, a lean
  double strongest_m_s = 60.0;  ///< the wind is never stronger
  std::uint64_t seed = 0;
};

/// The axis of a flame, bent by the wind and by its own swaying: rows are added up from the foot, each as it is turned,
/// and a row moves as the foot did when its gas was there (the projection operator "propagation", Chiba, section 2-2
/// (3)).
///
/// The foot follows FlameInWind as an oscillator of 1 Hz, damping 0.7. The foot itself does not move, and the turn
/// grows from there by 1 - exp(-25 v), v the part of the way up. Rows slope as they lean. In calm air without wobble
/// every row is at 0, exactly. Allocates when it is made, never afterwards. Thread-safe: no. Realtime-safe: all but
/// construction.
class FlameAxis {
 public:
  explicit FlameAxis(const FlameAxisSpec& spec);

  /// Advances by dt_s (above 0) in this wind (m/s, toward east and south).
  void step(double east_m_s, double south_m_s, double dt_s) noexcept;

  /// The movement of each row, as in SurfacePose; `rows` elements each.
  struct Rows {
    std::span<float> east_m, south_m, drop_m;
    std::span<float> slope_east, slope_south;
  };
  void write(const Rows& rows) const noexcept;

  /// The maximum movement of a row in a tick, in any wind; also the maximum change of its slope.
  double largest_step_m(double dt_s) const noexcept;
  double largest_slope_step(double dt_s) const noexcept;
  double largest_slope() const noexcept;

  void list_state(StatePass& pass) { pass(wobbled_, lean_east_, lean_south_, missing_, history_); }

 private:
  /// The channels of the history: leans, and the missing part of the length.
  enum Channel : std::size_t { kLeanEast, kLeanSouth, kMissing, kWobbleEast, kWobbleSouth, kChannels };
  struct Oscillator {
    double value = 0.0, rate = 0.0;
    void step(const operators::OscillatorStep& step, double target) noexcept;
    void list_state(StatePass& pass) { pass(value, rate); }
  };

  FlameAxisSpec spec_;
  /// u* in a wind of 1 m/s at 10 m over open land: the flame gets the wind at its height, by the logarithmic profile.
  double relative_wind_s_m_ = 0.0;
  FlameInWind strongest_;
  noise::Tile2 wobble_;
  double wobble_steepest_per_s_, wobble_largest_;
  noise::LineCut wobbled_;
  Oscillator lean_east_, lean_south_, missing_;
  operators::PropagationHistory history_;
  std::vector<float> turned_;  ///< for each row: its share of the lean
};

}  // namespace yuragi::scenes
