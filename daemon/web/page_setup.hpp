#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/http/server.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/page_file.hpp"
#include "daemon/web/calibration_order.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::web {

/// What `yuragi sensors describe --json` prints, without the drivers and keys that the page may not set. Pure.
std::string for_the_page(const std::string& described);

/// How the daemon takes over what the page has changed, soon; on any thread. Empty: it cannot, and nothing is changed.
struct TakingOver {
  std::function<void()> restart = {};  ///< starts the daemon again: for sensors and their calibrations
  std::function<void()> reload = {};   ///< reads the configuration again: for values
};

/// Changes the file of the page (settings/page_file.hpp), which is whole at any moment: sets sensors up, calibrates
/// them, and keeps values of [look] and of scenes. The state before stays beside it as FILE.before. Waits for the disk.
class PageSetup {
 public:
  /// `open`: the sensors as the daemon has them open; must outlive this.
  PageSetup(std::filesystem::path configuration, std::filesystem::path page, TakingOver taking_over,
            std::span<const settings::SensorConfig> open = {});

  /// The names of the sensors that the page has set up, and of those of the configuration that it has calibrated, and
  /// whether the last change was of these.
  http::Response list() const;
  http::Response add(const settings::PageSensor& sensor) const;
  http::Response remove(const std::string& name) const;
  /// Keeps the values that a calibration of a sensor has found, unless the sensor has others now than it began from.
  http::Response calibrate(const std::string& sensor, const FoundCalibration& found) const;
  /// Removes the page's calibration of a sensor of the configuration.
  http::Response forget_calibration(const std::string& sensor) const;
  /// Why a sensor cannot be calibrated beside `reference` (empty: none); nullopt if both exist with the settings that
  /// the daemon has them open with, and a result may be kept.
  std::optional<http::Response> calibration_refusal(const std::string& sensor, const std::string& reference) const;

  /// The names of the values of [look] and of scenes that are kept, and whether the last change was of these.
  http::Response list_values() const;
  /// Keeps these values besides those that are kept already. A value that edited() refuses changes nothing.
  http::Response keep(const std::vector<settings::ParameterEdit>& values) const;
  /// Keeps none any more.
  http::Response forget_values() const;

  /// Exchanges the file and the state before it: a second time undoes this.
  http::Response undo() const;

  /// A configuration with this sensor alone. Fails if it has a mistake, or its device is one of the daemon's.
  Result<std::string, Failure> trial(const settings::PageSensor& sensor) const;

 private:
  std::filesystem::path before() const;
  Result<settings::Config, Failure> configuration() const;
  struct Installation {
    settings::Config configuration, with_page;
    std::string page_text;
  };
  Result<Installation, Failure> installation() const;
  Result<std::string, Failure> text_of(const std::filesystem::path& file) const;
  Result<void, Failure> check(const std::string& text, bool changes_sensors) const;
  bool can_undo(bool sensors) const;
  http::Response replace(const Result<std::string, Failure>& text, std::string_view done) const;
  http::Response done(std::string_view what, bool changes_sensors) const;

  std::filesystem::path configuration_, page_;
  TakingOver taking_over_;
  std::span<const settings::SensorConfig> open_;
};

}  // namespace yuragi::daemon::web
