#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "daemon/values/grid.hpp"
#include "daemon/values/meter.hpp"
#include "daemon/values/moment.hpp"
#include "engine/scenes/wind_grid.hpp"
#include "engine/wind/ground/ground_wind.hpp"
#include "engine/wind/ground/wind_tapes.hpp"
#include "engine/wind/turbulence/gust_noise.hpp"

namespace yuragi::daemon::values {

/// A point on the ground whose wind is sent, metres east and south of the middle of the scenes.
struct Place {
  std::string name = {};
  double east_m = 0.0, south_m = 0.0;
  friend bool operator==(const Place&, const Place&) = default;
};

/// Makes the Moment of each tick of the wind. The wind of a place is what a blade of grass there gets: with the gusts
/// that pass it. Belongs to the thread that steps the wind; a Moment may go to any.
class MomentMaker {
 public:
  /// `gusts`: of the winds that make() will be given.
  explicit MomentMaker(std::shared_ptr<const wind::turbulence::GustNoise> gusts);

  /// Other places from now on; what is known of those that stay is kept. `with_real`: their real wind is wanted, too.
  void set_places(std::span<const Place> places, bool with_real);

  /// Other grids from now on, no two alike; what is known of those that stay is kept.
  void set_grids(std::span<const Grid> grids);
  const Names& names() const noexcept { return *names_; }

  /// The winds of one tick.
  struct Tick {
    const wind::ground::DrivingWind& real;
    const wind::ground::DrivingWind& shaped;
    NormScale real_scale{}, shaped_scale{};
    Instant time{};
    double dt_s = 0.0;      ///< since the tick before
    double openness = 1.0;  ///< Moment::openness
  };
  /// `sensors` and `opacities` are moved into the moment, with the names that were set last.
  std::shared_ptr<const Moment> make(const Tick& tick, std::vector<SensorValue> sensors, std::vector<double> opacities);

  void set_sensors(std::vector<std::string> names);
  void set_scenes(std::vector<std::string> names);
  void set_health(Health health);

 private:
  /// The meters of one of the winds.
  struct Side {
    Meter middle;
    std::vector<Meter> places;
    wind::ground::WindTapes tapes;
  };
  /// The points of one grid, whose wind is read as a scene reads it: much cheaper than place by place.
  struct Pixels {
    Grid grid;
    std::unique_ptr<scenes::WindGrid> wind;
    std::vector<float> east_m_s, south_m_s;
    std::vector<Meter> meters;  ///< one for each; empty: its values follow from the wind of the tick
  };
  Pixels make_pixels(const Grid& grid) const;
  static std::vector<double> read_grid(Pixels& pixels, const wind::ground::Wind& ground, const Readout& middle,
                                       const Tick& tick);
  std::vector<Readout> read_places(Side& side, const wind::ground::Wind& ground, const wind::State& state, double dt_s,
                                   const NormScale& scale) const;
  void rename(const Names& names);

  std::shared_ptr<const wind::turbulence::GustNoise> gusts_;
  std::vector<Place> places_;
  std::vector<Pixels> grids_;
  bool with_real_ = false;
  Side shaped_, real_;
  std::shared_ptr<const Names> names_ = std::make_shared<const Names>();
  std::shared_ptr<const Health> health_ = std::make_shared<const Health>();
  std::uint64_t tick_ = 0;
  double time_s_ = 0.0;
};

}  // namespace yuragi::daemon::values
