#include "daemon/service/moment_source.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace yuragi::daemon::service {

MomentSource::MomentSource(const settings::Config& config, std::shared_ptr<const wind::turbulence::GustNoise> gusts)
    : maker_(std::move(gusts)) {
  maker_.set_sensors(settings::names_of(config).sensors);
  change(config.shaping);
  change(config.feeds);
}

void MomentSource::change(const settings::ShapingConfig& shaping) {
  unknown_site_ = {.median_m_s = 0.5 * shaping.norm_speed_m_s, .strong_m_s = shaping.norm_speed_m_s};
  shaped_site_.reset();
  const wind::shaping::SiteRange& site = shaping.settings.site;
  if (site.median_m_s <= 0.0) return;
  shaped_site_ = {.median_m_s = site.median_m_s,
                  .strong_m_s = site.strong_m_s > 0.0 ? site.strong_m_s : 2.0 * site.median_m_s};
}

void MomentSource::change(const settings::feeds::Config& feeds) {
  maker_.set_places(feeds.places, feeds.wants_real_places());
  maker_.set_grids(feeds.grids());
}

void MomentSource::note_frame(const animation::PublishedFrame& frame, const animation::SceneExchange& scenes) {
  opacities_.clear();
  if (scenes.is_changing()) return;
  if (named_ != scenes.present()) {
    named_ = scenes.present();
    std::vector<std::string> names;
    for (const settings::SceneConfig& scene : named_->configs) names.push_back(scene.name);
    maker_.set_scenes(std::move(names));
  }
  opacities_.assign(frame.opacities.begin(), frame.opacities.begin() + static_cast<std::ptrdiff_t>(frame.scene_count));
}

std::shared_ptr<const values::Moment> MomentSource::make(const wind::ground::DrivingWind& real,
                                                         const wind::ground::DrivingWind& shaped,
                                                         const wind::shaping::WindShapingReport& shaping,
                                                         const Instant& now, std::vector<values::SensorValue> sensors) {
  const double dt_s = made_ ? seconds(now.mono - *made_) : 0.0;
  made_ = now.mono;
  const bool is_site_known = shaping.median_m_s > 0.0 && shaping.strong_m_s > shaping.median_m_s;
  const values::NormScale real_scale =
      is_site_known ? values::NormScale{.median_m_s = shaping.median_m_s, .strong_m_s = shaping.strong_m_s}
                    : unknown_site_;
  return maker_.make({.real = real,
                      .shaped = shaped,
                      .real_scale = real_scale,
                      .shaped_scale = shaped_site_.value_or(real_scale),
                      .time = now,
                      .dt_s = dt_s,
                      .openness = std::clamp(shaping.openness, 0.0, 1.0)},
                     std::move(sensors), opacities_);
}

}  // namespace yuragi::daemon::service
