#pragma once

#include <memory>
#include <vector>

#include "engine/wind/reading_value.hpp"
#include "engine/wind/turbulence/site_spectrum.hpp"
#include "engine/wind/turbulence/synthetic_wind.hpp"

namespace yuragi::wind::blend {

/// The configuration of one source of a blend.
struct SourceSettings {
  /// Relative: only the fluctuations of its readings are used, neither their scale nor their mean (a microphone). It
  /// supplies the gusts that are too fast for the absolute sources. Where it is the only source its readings are used
  /// unchanged.
  bool is_relative = false;
  int priority = 0;        ///< lower first; equal ones share; 0: its place among the sources, from 1
  double weight = 1.0;     ///< among those of the same priority; above 0
  bool has_place = false;  ///< its position is configured; otherwise it is at the windward edge
  double east_m = 0.0;     ///< its position, from the middle of the scenes
  double south_m = 0.0;    ///< (a relative source is at the place of the sources whose gusts it fills)
  double lead_m = 0.0;     ///< its pen is this far upwind: more of the wind is known, but later
  double length_m = 0.0;   ///< integral length scale before anything is measured; 0: the blend's length
  bool fits_site = false;  ///< its readings are live and of this site: they update the site's spectrum
  ReadingValue value = ReadingValue::kMean;  ///< readings of kMaximum are not accepted
  double averaging_s = 0.0;                  ///< averaging time of readings that are means; 0: the measured interval
  double direction_step_deg = 0.0;           ///< resolution of its vane; 0: detected
  double unchanged_for_s = 0.0;  ///< it sends only changes, and can be silent for this; 0: it sends at intervals
};

struct Settings {
  /// The wind without a sensor: mean, direction, turbulence intensity, seed.
  turbulence::SyntheticWindSettings climate;
  double length_m = 57.0;        ///< how far its gusts reach: the integral length scale
  double gustiness = 0.0;        ///< 0 to 0.6: deviation of the logarithm of gusts' strength; 0: all of one strength
  double handover_s = 3.0;       ///< approximate duration of the change from one source to another
  double stale_intervals = 5.0;  ///< silent for this many of its own intervals: stale
  double return_after_s = 10.0;  ///< a failed source is trusted again after this; longer if it often fails
  double fit_memory_s = 600.0;   ///< how long the fit of the turbulence remembers
  double mean_memory_s = 600.0;  ///< how fast the mean of a silent sensor fades into the climate's
  double reach_m = 0.0;          ///< from the middle of the scenes to the farthest place of any of them
  double rate_hz = 60.0;         ///< how often the wind is shown: gusts too quick for that are left out
  /// The site's measured spectrum: corrects the noise of slow sources, and is updated by sources with `fits_site`.
  /// Used on the estimator's thread only. Null: no correction.
  std::shared_ptr<turbulence::SiteSpectrum> site{};
  std::vector<SourceSettings> sources{};  ///< in their order; missing ones have the defaults
};

}  // namespace yuragi::wind::blend
