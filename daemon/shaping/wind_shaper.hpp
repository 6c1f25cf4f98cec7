#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "daemon/settings/config.hpp"
#include "daemon/settings/opening_hours.hpp"
#include "daemon/shaping/shaping_text.hpp"
#include "daemon/shaping/site_file.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"
#include "engine/wind/turbulence/site_spectrum.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::shaping {

/// Something that the site file keeps beside the site's wind. Empty functions: it is not kept.
template <typename T>
struct Kept {
  std::function<T()> learnt;
  /// Returns false if it is implausible.
  std::function<bool(const T&)> restore;
};

/// What a site's sensors have learnt from each other.
struct KeptOfSensors {
  Kept<wind::judging::LearntByName> gains{};
  Kept<wind::blend::GustReach> reach{};
};

/// WindShaping with opening hours, a site file that keeps what was learnt over a restart, and a log line when an
/// effect begins or ends. Belongs to the I/O thread.
class WindShaper {
 public:
  /// `noise`: of the gusts, as the estimator has it.
  WindShaper(const settings::Config& config, std::shared_ptr<const wind::turbulence::GustNoise> noise);
  ~WindShaper();
  WindShaper(const WindShaper&) = delete;
  WindShaper& operator=(const WindShaper&) = delete;

  /// Reads [shaping] site_file, and writes it from now on, once an hour and at the end. Call it before the first
  /// shape(). Does nothing if no file is configured, or if a sensor plays a recording, which may be of another
  /// site. `gusts`: the spectrum that is kept in the file too; null: not kept. What `sensors` calls must live as long
  /// as this.
  void keep_site_file(std::shared_ptr<wind::turbulence::SiteSpectrum> gusts = {}, KeptOfSensors sensors = {});

  /// Shapes by other settings and opening hours from now on: what was learnt of the site stays, and nothing jumps
  /// (WindShaping::change). The site file stays as it was.
  void change(const settings::ShapingConfig& shaping);

  /// For a snapshot (engine/base/snapshot.hpp).
  void list_state(StatePass& pass) { pass(shaping_); }

  /// Changes the real wind into the one that moves the scenes. `utc`: for the opening hours alone; it may jump.
  /// `is_any_live`: a sensor is live. Otherwise (the fall-back recording plays) nothing is learnt of the site.
  /// `by_hand`: what people have set at this moment.
  void shape(wind::ground::DrivingWind& wind, UtcTime utc, bool is_any_live, const wind::shaping::ByHand& by_hand = {});

  /// The effects at present, as of the last shape().
  wire::Shaping status() const;
  /// The same without its text, for each tick.
  wind::shaping::WindShapingReport report() const noexcept { return shaping_.report(); }

 private:
  void look_at_hours(MonoTime now, UtcTime utc);
  void log_changes();
  void log_ceiling(const wind::shaping::WindShapingReport& report, MonoTime now);
  void restore_gains(const SiteMemory& memory);
  void restore_reach(const SiteMemory& memory);
  void save_site();
  void log_site_file();
  OpeningNews opening() const;

  wind::shaping::WindShaping shaping_;
  settings::OpeningHours hours_;
  std::optional<SiteFile> site_file_;
  std::shared_ptr<wind::turbulence::SiteSpectrum> gusts_;
  KeptOfSensors sensors_;
  std::filesystem::path site_path_;  ///< of the site file; empty: none

  bool is_open_ = true;
  UtcTime utc_{};
  MonoTime looked_{}, saved_{};
  bool has_looked_ = false;

  // As last logged.
  bool logged_open_ = true, logged_raised_ = false, logged_ceiling_ = false;
  double logged_site_gain_ = 1.0;
  double strongest_m_s_ = 0.0;  ///< largest speed that the ceiling has reduced since it began to
  MonoTime held_back_{};        ///< when the ceiling last reduced a speed
};

}  // namespace yuragi::daemon::shaping
