#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/compass.hpp"
#include "engine/base/time.hpp"

// The content of a report about a recording, as numbers: plain values, without drawing or text. Times `..._s` are log
// time (windlog_reader.hpp) since the recording's first reading. Speeds are as recorded, before calibration. All
// statistics but counts are of the readings that ReadingJudge believes.

namespace yuragi::daemon::tools::report {

/// The state of a sensor, the most serious last.
enum class RecordedState : std::uint8_t {
  kLive,
  kStale,        ///< silent for several of its own intervals (SourceRecord)
  kSpike,        ///< from here on ReadingFault: a reading is held back
  kImplausible,  ///< out of range, or a spike, again and again
  kFrozen,       ///< exactly the same value again and again
  kSeized,       ///< no wind for hours on a windy day
};
inline constexpr std::array<std::string_view, 6> kRecordedStateNames = {"live",        "stale",  "spike",
                                                                        "implausible", "frozen", "seized"};
inline constexpr std::size_t kRecordedStates = kRecordedStateNames.size();

/// A stretch in which a sensor was not live. A silence lasts from one reading to the next.
struct StateEvent {
  RecordedState state = RecordedState::kStale;
  double from_s = 0.0;
  double to_s = 0.0;

  double length_s() const { return to_s - from_s; }
};

/// The number of events, and their total duration.
struct StateTotal {
  std::uint64_t count = 0;
  double time_s = 0.0;
  double longest_s = 0.0;
};

/// One column of the time series; every recording has kTimeBins of them.
struct TimeBin {
  std::uint64_t count = 0;  ///< believed readings
  double time_sum_s = 0.0;
  double speed_sum_m_s = 0.0;
  double min_m_s = 0.0;
  double max_m_s = 0.0;
  std::uint64_t directed = 0;  ///< readings with a direction
  double u_sum_m_s = 0.0;
  double v_sum_m_s = 0.0;
  std::optional<double> gust_m_s;  ///< the largest reported by the sensor, or else 3 s mean
  RecordedState gravest = RecordedState::kLive;
  bool follows_silence = false;  ///< the sensor was stale before it: the line is interrupted

  double time_s() const { return time_sum_s / static_cast<double>(count); }
  double mean_m_s() const { return speed_sum_m_s / static_cast<double>(count); }
};
inline constexpr std::size_t kTimeBins = 1000;

/// A reading's direction, for the scatter of directions.
struct DirectionPoint {
  double time_s = 0.0;
  double direction_deg = 0.0;
};

inline constexpr std::size_t kRoseSectors = kCompassPoints.size();
inline constexpr std::size_t kRoseClasses = 6;
/// Below this it is calm (engine/wind/model.md W37).
inline constexpr double kRoseCalm_m_s = 0.5;

/// Where the wind came from: shares of the readings with a direction.
struct WindRose {
  std::uint64_t count = 0;  ///< readings with a direction
  double calm_share = 0.0;
  double class_m_s = 2.0;  ///< width of a speed class: a round one, with which the strongest wind is in the last class
  /// [sector][class]; sector 0 is centred on north, the others follow clockwise. The sum with the calm is 1.
  std::array<std::array<double, kRoseClasses>, kRoseSectors> share{};

  /// Where a class begins: the first at the calm's end, and the others at multiples of the width.
  double class_from_m_s(std::size_t speed_class) const {
    return speed_class == 0 ? kRoseCalm_m_s : class_m_s * static_cast<double>(speed_class);
  }
};

/// The distribution of speeds.
struct SpeedDistribution {
  double class_m_s = 0.5;     ///< width of a class; the first begins at 0
  std::vector<double> share;  ///< up to the last class that is not empty
  /// Weibull's shape k and scale c by the method of moments, k = (sd / mean)^-1.086 (Justus, Hargraves, Mikhail and
  /// Graber 1978, Methods for estimating wind speed frequency distributions). Nullopt if the wind did not vary.
  std::optional<double> weibull_shape;
  std::optional<double> weibull_scale_m_s;
  double p10_m_s = 0.0, p50_m_s = 0.0, p90_m_s = 0.0, p99_m_s = 0.0;  ///< to within 0.05 m/s
};

/// The wind of one hour of the day, in local time.
struct HourOfDay {
  std::uint64_t count = 0;
  double mean_m_s = 0.0;
  double p10_m_s = 0.0, p90_m_s = 0.0;
};

/// One octave of a spectrum.
struct OctaveBand {
  double from_hz = 0.0, to_hz = 0.0;
  double variance_m2_s2 = 0.0;         ///< of the spectrum's lines within
  std::optional<double> fitted_m2_s2;  ///< the fitted von Karman's over the same lines
  bool is_in_fit = false;
};

/// von Karman's spectrum as fitted to the octaves, by least squares of their logarithms.
struct VonKarmanFit {
  double speed_m_s = 0.0;     ///< U: root mean square of the segments' mean speeds
  double intensity = 0.0;     ///< TI = sigma / U
  double time_scale_s = 0.0;  ///< T = L / U
  /// L. Nullopt if the octaves do not contain the bend of the spectrum, so that L is not determined.
  std::optional<double> length_m;
  double rms_db = 0.0;  ///< residual of the octaves
  double from_hz = 0.0, to_hz = 0.0;

  double sigma_m_s() const { return intensity * speed_m_s; }
};

/// Power that falls as f^-beta, by least squares in log-log over the spectrum's lines.
struct PowerLawFit {
  double beta = 0.0;
  double log_level = 0.0;  ///< ln S at 1 Hz
  double from_hz = 0.0, to_hz = 0.0;
};

/// The spectrum of the wind along its mean direction, or of the speed if a reading has no direction. Welch's method:
/// Hann windows overlapping by half, each turned into its own mean wind and detrended (Welch 1967, The use of fast
/// Fourier transform for the estimation of power spectra). One-sided; its integral is the variance.
struct SpectrumNumbers {
  bool is_of_speed = false;
  std::size_t segment_readings = 0;
  std::uint64_t segments = 0;
  double step_s = 0.0;                   ///< between samples
  std::vector<double> density_m2_s2_hz;  ///< at k / (segment_readings step_s), from k = 0

  std::vector<OctaveBand> octaves;
  std::optional<PowerLawFit> power_law;
  std::optional<VonKarmanFit> von_karman;

  double frequency_hz(std::size_t line) const {
    return static_cast<double>(line) / (static_cast<double>(segment_readings) * step_s);
  }
};

/// Gusts and turbulence of blocks of 10 minutes, as usual in meteorology.
struct BlockNumbers {
  std::uint64_t blocks = 0;                    ///< whole ones in a wind of at least 1 m/s
  std::optional<double> turbulence_intensity;  ///< mean of sd / mean
  std::optional<double> gust_factor;           ///< mean of highest 3 s mean / mean; if the interval is at most 1.5 s
};

/// The SiteSpectrum that the daemon would fit to a fast sensor.
struct SiteNumbers {
  double length_m = 0.0;           ///< integral length that was assumed for the slow sensor
  double known_s = 0.0;            ///< for how long it was fitted
  std::vector<double> octaves_db;  ///< from SiteSpectrum::kFrom_hz on, as far as the sensor is fast enough
};

struct SensorNumbers {
  std::string name;
  std::string driver;
  std::uint64_t readings = 0;
  std::uint64_t believed = 0;
  std::uint64_t spikes = 0;                ///< readings that were spikes
  std::array<std::uint64_t, 3> quality{};  ///< readings by ReadingQuality
  std::uint64_t directed = 0;              ///< believed readings with a direction
  double first_s = 0.0, last_s = 0.0;
  UtcTime first{}, last{};
  double interval_s = 0.0;       ///< the median; 0 for fewer than two readings
  double unchanged_for_s = 0.0;  ///< it sent only changes: a silence of up to this is not a gap; 0: it did not
  double mean_m_s = 0.0, deviation_m_s = 0.0, min_m_s = 0.0, max_m_s = 0.0;
  double max_at_s = 0.0;
  std::optional<double> reported_gust_m_s;  ///< the strongest gust reported by the sensor itself
  std::optional<double> gust_3s_m_s;        ///< the highest mean over 3 s, if the interval is at most 1.5 s
  std::optional<double> direction_deg;      ///< of the mean vector
  std::optional<double> steadiness;         ///< length of the mean vector over the mean speed, 0 to 1
  std::optional<double> integral_time_s;    ///< of the speed: its autocorrelation, integrated to its first zero

  std::array<StateTotal, kRecordedStates> states{};
  std::vector<StateEvent> events;  ///< the longest kMaxEvents of each state, by time
  static constexpr std::size_t kMaxEvents = 100;

  std::vector<TimeBin> bins;  ///< kTimeBins over the whole recording
  std::vector<DirectionPoint> directions;
  WindRose rose;
  SpeedDistribution distribution;
  std::optional<std::array<HourOfDay, 24>> diurnal;  ///< if there is more than a day
  BlockNumbers blocks;
  std::optional<SpectrumNumbers> spectrum;
  std::string why_no_spectrum;    ///< for a person
  double assumed_length_m = 0.0;  ///< integral length of the gusts if the spectrum does not determine it
  std::optional<SiteNumbers> site;
};

/// The recording, or the selected part of it.
struct RecordingNumbers {
  std::uint64_t readings = 0;
  std::uint64_t skipped = 0;         ///< rows that are not valid readings
  std::size_t sessions = 0;          ///< of the whole file
  double begin_s = 0.0;              ///< of the first reading, log time
  double end_s = 0.0;                ///< of the last one
  UtcTime first{}, last{};           ///< by its clock; `first` is at begin_s
  std::uint64_t clock_sets = 0;      ///< how often the recorder's clock was set by more than 2 s
  double largest_clock_set_s = 0.0;  ///< positive: forward
  double stale_intervals = 0.0;      ///< the rule for silence
  std::vector<SensorNumbers> sensors;

  /// The UTC of a log time, assuming that the clock was not set in between.
  UtcTime utc_at(double time_s) const { return first + from_seconds(time_s - begin_s); }
  double duration_s() const { return end_s - begin_s; }
};

}  // namespace yuragi::daemon::tools::report
