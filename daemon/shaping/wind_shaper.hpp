#pragma once

#include <memory>
#include <optional>

#include "daemon/settings/config.hpp"
#include "daemon/settings/opening_hours.hpp"
#include "daemon/shaping/shaping_text.hpp"
#include "daemon/shaping/site_file.hpp"
#include "engine/wind/shaping/wind_shaping.hpp"
#include "engine/wind/turbulence/site_spectrum.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi {

/// WindShaping as an installation has it: with opening hours, a memory of the site that outlives a restart, and a line
/// in the log where something begins and where it ends. Belongs to the I/O thread.
class WindShaper {
 public:
  /// `noise`: of the gusts, as the estimator has it.
  WindShaper(const Config& config, std::shared_ptr<const GustNoise> noise);
  ~WindShaper();
  WindShaper(const WindShaper&) = delete;
  WindShaper& operator=(const WindShaper&) = delete;

  /// Takes up what [shaping] site_file remembers, and keeps it there from now on, once an hour and at the end. Before
  /// the first shape(). Nothing happens where there is no such file to be, or where a sensor plays a recording: what
  /// it says is not of this site, or not of now.
  /// `gusts`: what is known of them, kept with it; none: not kept.
  void keep_site_file(std::shared_ptr<SiteSpectrum> gusts = {});

  /// Makes of the real wind the one that moves the scenes. `utc`: for the opening hours alone; it may jump.
  /// `is_any_live`: a sensor speaks. Where none does, but a recording is played, nothing is learnt of the site.
  void shape(DrivingWind& wind, UtcTime utc, bool is_any_live);

  /// What is at work, as of the last shape().
  wire::Shaping status() const;

 private:
  void look_at_hours(MonoTime now, UtcTime utc);
  void log_changes();
  void log_ceiling(const WindShapingReport& report, MonoTime now);
  void save_site();
  void log_site_file();
  OpeningNews opening() const;

  WindShaping shaping_;
  OpeningHours hours_;
  std::optional<SiteFile> site_file_;
  std::shared_ptr<SiteSpectrum> gusts_;
  std::filesystem::path site_path_;  ///< where the file is to be; empty: nowhere

  bool is_open_ = true;
  UtcTime utc_{};
  MonoTime looked_{}, saved_{};
  bool has_looked_ = false;

  // What the log was told last.
  bool logged_open_ = true, logged_raised_ = false, logged_ceiling_ = false;
  double logged_site_gain_ = 1.0;
  double strongest_m_s_ = 0.0;  ///< that the ceiling held back since it began
  MonoTime held_back_{};        ///< when it last did
};

}  // namespace yuragi
