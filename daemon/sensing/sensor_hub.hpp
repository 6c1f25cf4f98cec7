#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/sensing/change_gate.hpp"
#include "daemon/sensing/fallback_recording.hpp"
#include "daemon/sensing/player_director.hpp"
#include "daemon/sensing/sensor_diagnosis.hpp"
#include "daemon/sensing/sensor_jury.hpp"
#include "daemon/sensing/sensor_runner.hpp"
#include "daemon/sensing/sensor_status.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/values/moment.hpp"
#include "engine/wind/blend/blend_settings.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/judging/quantity_watch.hpp"
#include "engine/wind/turbulence/site_spectrum.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::sensing {

/// All sensors of an installation, and the estimator that makes one wind of their readings. Belongs to the I/O thread;
/// each sensor runs on a thread of its own.
///
/// Each sensor's readings are calibrated, judged by themselves and compared with the other sensors' (SensorJury).
/// Readings that are not believed do not reach the estimator, which treats the sensor as silent and hands over to other
/// sources as usual. The listener gets every plausible reading, before calibration and judging.
class SensorHub {
 public:
  /// Gets each plausible reading, before calibration; for the recorder.
  using Listener = std::function<void(std::size_t sensor, const wind::Reading&)>;
  /// Receives what a station reports besides the wind; for the recorder.
  using QuantitiesListener = std::function<void(std::size_t sensor, const wind::StationQuantities&)>;

  /// Opens and starts every sensor. `noise`: of the gusts; `reach_m`: as make_estimator() takes it; `thread`: the
  /// sensors'. Throws ConfigError if a sensor cannot be constructed from its values.
  SensorHub(const settings::Config& config, const drivers::sensor::Clock& clock,
            std::shared_ptr<const wind::turbulence::GustNoise> noise, Listener listener = {}, double reach_m = 0.0,
            SensorThread thread = SensorThread::kOwn);

  /// Polls each sensor on a thread of its own from now on.
  void begin_threads();

  /// Takes the values that can change while it runs from a configuration with the same sensors in the same order
  /// (ReloadPlan::next): calibration and judging, and the rate of recordings that play. Counts, states and what is
  /// known of each sensor stay; a new calibration is neither a spike nor a contradiction to the other sensors.
  void change(const settings::Config& config);

  /// Passes what stations report besides the wind to `listener` from now on; without one it is dropped.
  void listen_to_quantities(QuantitiesListener listener) { quantities_listener_ = std::move(listener); }

  /// The scenes reach as far as this from now on, as make_estimator() takes it. The wind does not jump.
  void set_reach(double reach_m) noexcept { estimator_.set_reach(reach_m); }

  /// Takes the readings that have arrived, and returns the wind now. Logs each change of a sensor's state once.
  const wind::State& advance();

  /// Returns true if any sensor is live and believed. The fall-back recording does not count. As of the last advance().
  bool is_any_live() const;

  /// The wind as of the last advance().
  const wind::State& wind() const noexcept { return wind_; }
  const wind::ground::Wind& ground() const noexcept { return estimator_.ground(); }
  const wind::ground::WindStroke& stroke() const noexcept { return estimator_.stroke(); }

  /// Of the wind that is made of the readings, for a snapshot (engine/base/snapshot.hpp). What is known of each sensor
  /// is left out: it is soon known again.
  void list_state(StatePass& pass) { pass(estimator_, wind_); }

  /// What is known of the site's gusts; updated while a fast sensor of the site is live. Belongs to this thread.
  const std::shared_ptr<wind::turbulence::SiteSpectrum>& site() const noexcept { return site_; }

  /// The learnt differences between the sensors, by their names; only known ones.
  wind::judging::LearntByName relative_gains() const;
  /// Continues from an earlier run's result; names that are not of this installation are ignored. Returns false, and
  /// changes nothing, if it is implausible (GroupGains::restore()).
  bool restore_relative_gains(const wind::judging::LearntByName& learnt);

  /// The reach of gusts at this site, as learnt from sensors at several places (BlendedEstimator::reach).
  const wind::blend::GustReach& gust_reach() const noexcept { return estimator_.reach(); }
  /// Continues from an earlier run's result. Returns false, and changes nothing, if it is implausible.
  bool restore_gust_reach(const wind::blend::GustReach& learnt) noexcept { return estimator_.restore_reach(learnt); }

  /// The status of each sensor, and of the fall-back while it plays.
  std::vector<wire::SensorStatus> status() const;

  /// What each sensor sent last, calibrated, in the order of the configuration. Cheaper than status().
  std::vector<values::SensorValue> values() const;

  /// Decides for each sensor, by its name, whether the messages to and from its device are kept for drain_traces().
  void trace(const std::function<bool(std::string_view sensor)>& is_wanted);

  /// Passes the messages kept since the last call to `use`: sensor by sensor, oldest first.
  void drain_traces(const std::function<void(const wire::RawTrace&)>& use);

  /// Logs a line of counts for each sensor, since the start.
  void log_summary() const;

  /// The controls of the sensors that play a recording; they live as long as the hub.
  std::vector<NamedPlayer> players();

  /// Returns true if every sensor is a recording that has ended.
  bool is_finished() const;

 private:
  static constexpr std::uint32_t kNothingReported = ~0U;

  struct Channel {
    settings::SensorConfig config;
    std::unique_ptr<SensorRunner> runner;
    std::uint64_t readings = 0;
    std::uint64_t not_believed = 0;  ///< plausible readings that were left out of the wind
    std::uint64_t impossible = 0;    ///< readings that were refused as implausible
    LinkReport link;                 ///< as of its last report
    std::uint64_t link_reports = 0;
    ChangeGate link_gate{kNothingReported};
    ChangeGate state_gate{static_cast<std::uint32_t>(wind::judging::SensorState::kConnecting)};
    std::optional<wind::Reading> last_raw;                                                      ///< before calibration
    std::array<wind::judging::QuantityWatch, wind::judging::kQuantityNames.size()> quantities;  ///< by Quantity
  };

  void change(std::size_t index, const settings::SensorConfig& config);
  void take(std::size_t index, const wind::Reading& reading);
  static SensorCounts counts_of(const Channel& channel);
  void judge_refusals(std::size_t index);
  SensorEvidence evidence_of(std::size_t index, MonoTime now) const;
  std::vector<wire::QuantityStatus> quantities_of(std::size_t index, MonoTime now) const;
  void log_link(Channel& channel, MonoTime now) const;
  void log_state(std::size_t index, MonoTime now);

  const drivers::sensor::Clock& clock_;
  Listener listener_;
  QuantitiesListener quantities_listener_;
  std::shared_ptr<wind::turbulence::SiteSpectrum> site_;
  wind::blend::BlendedEstimator estimator_;
  SensorJury jury_;
  std::vector<Channel> channels_;
  FallbackRecording fallback_;  ///< the estimator's source behind those of the channels
  wind::State wind_;
};

/// The pattern of gusts of an installation: the estimator and the scenes share it. Set-up work of about 0.1 s.
std::shared_ptr<const wind::turbulence::GustNoise> make_gust_noise(const settings::Config& config);

/// The settings of the blend, with one source for each sensor, and one for the fall-back.
wind::blend::Settings blend_settings_of(const settings::Config& config);

/// The estimator of a configuration, with one source for each sensor, and one for the fall-back. `reach_m`: from the
/// middle of the scenes to the farthest place of any of them. `site`: the site's gusts, which the estimator updates;
/// null: as the configuration expects them.
wind::blend::BlendedEstimator make_estimator(const settings::Config& config,
                                             std::shared_ptr<const wind::turbulence::GustNoise> noise, double reach_m,
                                             std::shared_ptr<wind::turbulence::SiteSpectrum> site = {});

}  // namespace yuragi::daemon::sensing
