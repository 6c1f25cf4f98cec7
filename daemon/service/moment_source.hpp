#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "daemon/animation/animation_loop.hpp"
#include "daemon/animation/scene_exchange.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/values/moment_maker.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"

namespace yuragi::daemon::service {

/// What other programs get of each tick: joins the winds, the sensors' values and the scenes in the newest frame to a
/// values::Moment. Belongs to the I/O thread.
class MomentSource {
 public:
  /// `gusts`: of the winds that make() will be given.
  MomentSource(const settings::Config& config, std::shared_ptr<const wind::turbulence::GustNoise> gusts);

  /// Another [shaping] from now on, by which `norm` is scaled.
  void change(const settings::ShapingConfig& shaping);
  /// Other places and grids from now on; what is known of those that stay is kept.
  void change(const settings::feeds::Config& feeds);
  void set_health(values::Health health) { maker_.set_health(std::move(health)); }

  /// How visible the scenes are in the newest frame; unknown while scenes are exchanged, when their names are not those
  /// of the frame.
  void note_frame(const animation::PublishedFrame& frame, const animation::SceneExchange& scenes);

  /// The moment of a tick. `shaping`: of the shaped wind.
  std::shared_ptr<const values::Moment> make(const wind::ground::DrivingWind& real,
                                             const wind::ground::DrivingWind& shaped,
                                             const wind::shaping::WindShapingReport& shaping, const Instant& now,
                                             std::vector<values::SensorValue> sensors);

 private:
  values::MomentMaker maker_;
  values::NormScale unknown_site_;                ///< while the site's winds are not known
  std::optional<values::NormScale> shaped_site_;  ///< of the shaped wind, if the site's winds are scaled to these
  std::optional<MonoTime> made_;
  std::shared_ptr<const animation::SceneRoster> named_;  ///< whose scenes the maker has the names of
  std::vector<double> opacities_;
};

}  // namespace yuragi::daemon::service
