#include "daemon/shaping/wind_shaper.hpp"

#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include "daemon/settings/duration_text.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::shaping {
namespace {

/// The interval at which opening hours are checked and changes are logged.
constexpr auto kLookAtHoursEvery = std::chrono::seconds(1);
constexpr auto kSaveSiteEvery = std::chrono::hours(1);

// Hysteresis: an effect is logged as begun well above where it is logged as ended, so that not every gust is logged.
constexpr double kRaisedBegins = 0.10;
constexpr double kRaisedEnds = 0.02;
constexpr double kCeilingBegins = 0.02;
constexpr auto kCeilingEndsAfter = std::chrono::minutes(1);
constexpr double kSiteGainNews = 1.2;

}  // namespace

WindShaper::WindShaper(const settings::Config& config, std::shared_ptr<const wind::turbulence::GustNoise> noise)
    : shaping_(config.shaping.settings, std::move(noise)), hours_(config.shaping.hours) {
  const bool is_of_this_site = std::ranges::none_of(
      config.sensors, [](const settings::SensorConfig& sensor) { return sensor.driver->plays_recordings; });
  if (is_of_this_site) site_path_ = config.shaping.site_file;
  if (const double gusts = shaping_.settings().gusts; gusts != 1.0) {
    spdlog::info("shaping: gusts {:.2f} times the real ones", gusts);
  }
  if (!hours_.is_always_open()) spdlog::info("shaping: opening hours by the clocks of {}", hours_.zone_name());
}

WindShaper::~WindShaper() {
  if (!site_file_) return;
  save_site();
  log_site_file();
}

void WindShaper::keep_site_file(std::shared_ptr<wind::turbulence::SiteSpectrum> gusts, KeptOfSensors sensors) {
  gusts_ = std::move(gusts);
  sensors_ = std::move(sensors);
  const bool has_gain = shaping_.settings().site.median_m_s > 0.0;
  if (site_path_.empty()) {
    if (!has_gain) return;
    spdlog::info("shaping: site gain begins at 1; it is not saved without site_file (or with a recording)");
    return;
  }
  const std::string_view gain_begins = has_gain ? "site gain begins at 1; " : "";
  site_file_.emplace(site_path_);
  if (std::error_code error; !std::filesystem::exists(site_path_, error)) {
    spdlog::info("shaping: {}{} will store the site's wind", gain_begins, site_path_.string());
    return;
  }
  const auto memory = site_file_->read();
  if (!memory || !shaping_.restore(memory->times_s)) {
    const auto aside = site_file_->set_aside();
    spdlog::warn("shaping: {}starting a new file: {}; {}", has_gain ? "site gain begins at 1; " : "",
                 memory ? site_path_.string() + ": has another format" : memory.error().message,
                 aside ? "it is kept as " + aside->string() : aside.error().message);
    if (!aside) site_file_.reset();  // its content is not overwritten
    return;
  }
  const double known_s = shaping_.memory().known_s();
  if (has_gain || known_s > 0.0) {
    spdlog::info("shaping: {} holds {} of the site's wind", site_path_.string(), settings::duration_text(known_s));
  }
  if (gusts_ && gusts_->restore(memory->octaves_known_s, memory->octaves_db)) {
    spdlog::info("shaping: {} holds {} of the site's gusts", site_path_.string(),
                 settings::duration_text(std::ranges::max(gusts_->known_s())));
  }
  restore_gains(*memory);
  restore_reach(*memory);
}

void WindShaper::restore_gains(const SiteMemory& memory) {
  if (!sensors_.gains.restore) return;
  std::string refusal = memory.gains_refusal;
  if (refusal.empty() && !sensors_.gains.restore(memory.gains)) refusal = "has impossible values";
  if (!refusal.empty()) {
    spdlog::warn("shaping: {}: relative_gains {}; how the sensors differ is learnt anew", site_path_.string(), refusal);
  } else if (!memory.gains.empty()) {
    spdlog::info("shaping: {} holds how {} differ", site_path_.string(), count_text(memory.gains.size(), "sensor"));
  }
}

void WindShaper::restore_reach(const SiteMemory& memory) {
  if (!sensors_.reach.restore) return;
  if (!memory.reach_refusal.empty()) {
    spdlog::warn("shaping: {}: gust_reach {}; how far gusts are alike is learnt anew", site_path_.string(),
                 memory.reach_refusal);
  } else if (memory.reach != wind::blend::GustReach{} && sensors_.reach.restore(memory.reach)) {
    spdlog::info("shaping: {} holds how far gusts are alike here", site_path_.string());
  }
}

void WindShaper::change(const settings::ShapingConfig& shaping) {
  shaping_.change(shaping.settings);
  hours_ = shaping.hours;
}

void WindShaper::shape(wind::ground::DrivingWind& wind, UtcTime utc, bool is_any_live,
                       const wind::shaping::ByHand& by_hand) {
  const MonoTime now = wind.state.time;
  const bool is_time_to_look = !has_looked_ || now - looked_ >= kLookAtHoursEvery;
  if (is_time_to_look) look_at_hours(now, utc);
  shaping_.shape(wind, is_open_, is_any_live, by_hand);
  log_ceiling(shaping_.report(), now);
  if (!is_time_to_look) return;
  log_changes();
  if (site_file_ && now - saved_ >= kSaveSiteEvery && !site_file_->is_writing()) {
    saved_ = now;
    save_site();
  }
}

void WindShaper::look_at_hours(MonoTime now, UtcTime utc) {
  if (!has_looked_) saved_ = now;
  has_looked_ = true;
  looked_ = now;
  utc_ = utc;
  is_open_ = hours_.is_open(utc);
}

void WindShaper::log_changes() {
  const wind::shaping::WindShapingReport report = shaping_.report();
  const wind::shaping::WindShapingSettings& settings = shaping_.settings();
  if (is_open_ != logged_open_) {
    logged_open_ = is_open_;
    spdlog::info("shaping: {} {}; the wind fades {} over {:.0f} s", is_open_ ? "open" : "closed",
                 hours_.until_text(utc_), is_open_ ? "in" : "out", settings.fade_s);
  }
  if (is_raised(report, logged_raised_ ? kRaisedEnds : kRaisedBegins) != logged_raised_) {
    logged_raised_ = !logged_raised_;
    if (logged_raised_) {
      spdlog::info("shaping: the wind is weak ({:.1f} m/s) and is raised toward the floor of {:.1f} m/s",
                   report.site_gain * report.mean_m_s, settings.floor_m_s);
    } else {
      spdlog::info("shaping: the wind is above the floor again ({:.1f} m/s)", report.site_gain * report.mean_m_s);
    }
  }
  if (std::abs(std::log(report.site_gain / logged_site_gain_)) > std::log(kSiteGainNews)) {
    spdlog::info("shaping: site gain {:.2f} (was {:.2f}); the site's median {:.1f}, strong {:.1f} m/s",
                 report.site_gain, logged_site_gain_, report.median_m_s, report.strong_m_s);
    logged_site_gain_ = report.site_gain;
  }
}

/// A storm is logged once, with any number of gusts.
void WindShaper::log_ceiling(const wind::shaping::WindShapingReport& report, MonoTime now) {
  if (report.ceiling_gain < 1.0 - kCeilingBegins) {
    held_back_ = now;
    strongest_m_s_ = std::max(strongest_m_s_, report.speed_m_s);
    if (!std::exchange(logged_ceiling_, true)) {
      spdlog::info("shaping: storm: {:.1f} m/s is limited to {:.1f}", report.speed_m_s,
                   report.ceiling_gain * report.speed_m_s);
    }
  } else if (logged_ceiling_ && now - held_back_ > kCeilingEndsAfter) {
    logged_ceiling_ = false;
    spdlog::info("shaping: the storm is over; the strongest was {:.1f} m/s", std::exchange(strongest_m_s_, 0.0));
  }
}

void WindShaper::save_site() {
  log_site_file();
  const auto times_s = shaping_.memory().times_s();
  SiteMemory memory{.times_s = {times_s.begin(), times_s.end()}, .octaves_known_s = {}, .octaves_db = {}};
  if (gusts_) {
    memory.octaves_known_s.assign(gusts_->known_s().begin(), gusts_->known_s().end());
    memory.octaves_db.assign(gusts_->learnt_db().begin(), gusts_->learnt_db().end());
  }
  if (sensors_.gains.learnt) memory.gains = sensors_.gains.learnt();
  if (sensors_.reach.learnt) memory.reach = sensors_.reach.learnt();
  site_file_->save(std::move(memory));
}

/// Logs a failure of the last write.
void WindShaper::log_site_file() {
  if (const Failure failure = site_file_->wait(); !failure.message.empty()) {
    spdlog::warn("shaping: the site's wind could not be saved: {}", failure.message);
  }
}

OpeningNews WindShaper::opening() const {
  if (hours_.is_always_open()) return {};
  return {.has_hours = true, .is_open = is_open_, .until = hours_.until_text(utc_)};
}

wire::Shaping WindShaper::status() const {
  const wind::shaping::WindShapingReport report = shaping_.report();
  return {.site_gain = report.site_gain,
          .floor_gain = report.floor_gain,
          .breeze_m_s = report.breeze_m_s,
          .opening = std::clamp(report.opening, 0.0, 1.0),
          .ceiling_gain = report.ceiling_gain,
          .mean_m_s = report.mean_m_s,
          .shaped_mean_m_s = report.shaped_mean_m_s,
          .site_median_m_s = report.median_m_s,
          .site_strong_m_s = report.strong_m_s,
          .site_known_s = report.known_s,
          .text = shaping_text(report, shaping_.settings(), opening()),
          .gusts = report.gusts,
          .openness = std::clamp(report.openness, 0.0, 1.0)};
}

}  // namespace yuragi::daemon::shaping
