#include "daemon/web/page_setup.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/web/problem.hpp"
#include "drivers/sensor/driver.hpp"
#include "engine/base/json_text.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::web {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// How the file is called in messages.
constexpr const char* kPage = "page.toml";
constexpr auto kOwnersAlone = fs::perms::owner_read | fs::perms::owner_write;

http::Response not_done(const std::string& why) {
  return problem(409, "Not done", why);
}

http::Response no_sensor(const std::string& name) {
  return problem(404, "Not found", fmt::format("the configuration has no sensor \"{}\"", name));
}

/// A sensor that is in a file; nullptr: there is none of this name.
const settings::SensorConfig* configured(const settings::Config& config, const std::string& name) {
  const auto found = std::ranges::find(config.sensors, name, &settings::SensorConfig::name);
  return found == config.sensors.end() || found->origin.empty() ? nullptr : &*found;
}

Result<void, Failure> write(const fs::path& file, const std::string& text) {
  try {
    return platform::write_whole(file, text, kOwnersAlone);
  } catch (const std::exception& error) {
    return Failure{error.what(), FailureKind::kCannotCreate};
  }
}

}  // namespace

std::string for_the_page(const std::string& described) {
  ordered_json all = ordered_json::array();
  const auto known = ordered_json::parse(described, nullptr, false);
  for (const ordered_json& each : known.is_array() ? known : ordered_json::array()) {
    const auto* const driver = drivers::sensor::find_driver(each.value("name", ""));
    if (driver == nullptr || driver->plays_recordings) continue;
    ordered_json shown = each;
    shown["parameters"] = ordered_json::array();
    for (const ordered_json& key : each["parameters"]) {
      const auto found = std::ranges::find(driver->parameters, key.value("name", ""), &Parameter::name);
      if (found != driver->parameters.end() && !settings::page_refusal(*driver, *found))
        shown["parameters"].push_back(key);
    }
    all.push_back(std::move(shown));
  }
  return json_text(ordered_json{{"drivers", std::move(all)}}, 2) + "\n";
}

PageSetup::PageSetup(fs::path configuration, fs::path page, TakingOver taking_over,
                     std::span<const settings::SensorConfig> open)
    : configuration_(std::move(configuration)),
      page_(std::move(page)),
      taking_over_(std::move(taking_over)),
      open_(open) {}

fs::path PageSetup::before() const {
  return page_.string() + ".before";
}

/// Without the page's part. Fails if the page may change nothing.
Result<settings::Config, Failure> PageSetup::configuration() const {
  if (configuration_.empty() || page_.empty())
    return Failure{"the daemon runs without a configuration file: start it with `yuragi run --config FILE`"};
  if (!taking_over_.restart || !taking_over_.reload) return Failure{"this daemon cannot be started again by the page"};
  try {
    settings::Config config = settings::load_config(configuration_);
    if (config.http.token_file.empty())
      return Failure{
          "only a paired browser may change the file of the page: set [http] token_file in the configuration"};
    if (auto refusal = settings::control_refusal(config.stream.control, true, "the file of the page cannot be changed"))
      return Failure{std::move(*refusal)};
    return config;
  } catch (const settings::ConfigError& error) {
    return Failure{std::string("the configuration has mistakes, with which the daemon cannot start again: ") +
                   error.what()};
  }
}

/// Empty if there is no such file.
Result<std::string, Failure> PageSetup::text_of(const fs::path& file) const {
  std::error_code error;
  if (!fs::exists(file, error) && !error) return {boost::system::in_place_value, std::string()};
  auto text = platform::read_whole(file, settings::kMaxPage_bytes);
  if (!text) return Failure{file.filename().string() + " " + text.error().message};
  return {boost::system::in_place_value, std::move(*text)};
}

/// Without and with the page's part. Fails if the page may set up nothing, or its part has a mistake.
Result<PageSetup::Installation, Failure> PageSetup::installation() const {
  auto config = configuration();
  if (!config) return config.error();
  auto text = text_of(page_);
  if (!text) return text.error();
  try {
    settings::Config both = settings::with_page(*config, *text, kPage);
    return Installation{.configuration = std::move(*config), .with_page = std::move(both), .page_text = *text};
  } catch (const settings::ConfigError& error) {
    return Failure{std::string("what the page has set up is left out: ") + error.what()};
  }
}

/// `changes_sensors`: otherwise they are as they were, and a mistake in them is no matter of this change.
Result<void, Failure> PageSetup::check(const std::string& text, bool changes_sensors) const {
  const auto config = configuration();
  if (!config) return config.error();
  if (text.size() > settings::kMaxPage_bytes)
    return Failure{"the file of the page is full: remove sensors that were added there"};
  if (!changes_sensors) return {};
  try {
    settings::with_page_checked(*config, text, kPage);
    return {};
  } catch (const std::exception& error) {
    return Failure{error.what()};
  }
}

http::Response PageSetup::list() const {
  const auto text = text_of(page_);
  const auto names = text ? settings::sensors_in(*text) : Result<std::vector<std::string>, Failure>(text.error());
  const auto calibrated = text ? settings::calibrations_in(*text) : names;
  return {.body = json_text(ordered_json{{"sensors", names ? ordered_json(*names) : ordered_json::array()},
                                         {"calibrated", calibrated ? ordered_json(*calibrated) : ordered_json::array()},
                                         {"can_undo", can_undo(true)},
                                         {"trouble", names ? ordered_json() : ordered_json(names.error().message)}},
                            2) +
                  "\n"};
}

http::Response PageSetup::add(const settings::PageSensor& sensor) const {
  const auto text = text_of(page_);
  if (!text) return not_done(text.error().message);
  return replace({boost::system::in_place_value, settings::with_sensor(*text, sensor)},
                 fmt::format("sensor {} was added", sensor.name));
}

http::Response PageSetup::remove(const std::string& name) const {
  const auto text = text_of(page_);
  if (!text) return not_done(text.error().message);
  auto without = settings::without_sensor(*text, name);
  if (!without && without.error().kind == FailureKind::kNoInput)
    return problem(404, "Not found", without.error().message + "; others are in the configuration");
  return replace(without, fmt::format("sensor {} was removed", name));
}

std::optional<http::Response> PageSetup::calibration_refusal(const std::string& sensor,
                                                             const std::string& reference) const {
  const auto installed = installation();
  if (!installed) return not_done(installed.error().message);
  for (const std::string* const name : {&sensor, &reference}) {
    if (name == &reference && name->empty()) continue;
    const settings::SensorConfig* const known = configured(installed->with_page, *name);
    if (known == nullptr) return no_sensor(*name);
    const auto open = std::ranges::find(open_, *name, &settings::SensorConfig::name);
    if (open != open_.end() && (open->driver != known->driver || open->values.all() != known->values.all()))
      return not_done(
          fmt::format("the configuration of {} was changed since the daemon was started: start it again", *name));
  }
  return std::nullopt;
}

http::Response PageSetup::calibrate(const std::string& sensor, const FoundCalibration& found) const {
  const auto installed = installation();
  if (!installed) return not_done(installed.error().message);
  const settings::SensorConfig* const known = configured(installed->with_page, sensor);
  if (known == nullptr) return no_sensor(sensor);
  const std::vector<Parameter> keys = settings::page_calibration_keys(*known->driver);
  std::vector<settings::ConfigChange> changes;
  for (std::size_t i = 0; i < found.after.size(); ++i) {
    const auto& [name, typed] = found.after[i];
    const auto key = std::ranges::find(keys, name, &Parameter::name);
    if (key == keys.end()) return not_done(name + ": is not found by a calibration");
    settings::ConfigChange change = settings::place_of_page_key(name);
    if (typed_value(*key, found.before[i].second) != settings::value_at(*known, change))
      return not_done(fmt::format("{} was changed while {} was calibrated: calibrate it again", name, sensor));
    change.value = typed_value(*key, typed);
    if (change.value.index() != key->default_value.index())
      return not_done(fmt::format("{}: is \"{}\", which is no number", name, typed));
    changes.push_back(std::move(change));
  }
  return replace(settings::with_calibration(installed->page_text, installed->configuration, sensor, changes),
                 fmt::format("sensor {} was calibrated", sensor));
}

http::Response PageSetup::forget_calibration(const std::string& sensor) const {
  const auto text = text_of(page_);
  if (!text) return not_done(text.error().message);
  auto without = settings::without_calibration(*text, sensor);
  if (!without && without.error().kind == FailureKind::kNoInput)
    return problem(404, "Not found", without.error().message);
  return replace(without, fmt::format("the calibration of {} was removed", sensor));
}

/// Returns true if the last change was of sensors, or with `sensors` false of values.
bool PageSetup::can_undo(bool sensors) const {
  std::error_code error;
  if (page_.empty() || !fs::exists(before(), error)) return false;
  const auto now = text_of(page_);
  const auto then = text_of(before());
  return now && then && *now != *then && settings::have_same_sensors(*now, *then) != sensors;
}

http::Response PageSetup::list_values() const {
  const auto text = text_of(page_);
  const auto kept = text ? settings::kept_in(*text) : Result<std::vector<std::string>, Failure>(text.error());
  return {.body = json_text(ordered_json{{"kept", kept ? ordered_json(*kept) : ordered_json::array()},
                                         {"can_undo", can_undo(false)},
                                         {"trouble", kept ? ordered_json() : ordered_json(kept.error().message)}},
                            2) +
                  "\n"};
}

http::Response PageSetup::keep(const std::vector<settings::ParameterEdit>& values) const {
  const auto config = configuration();
  if (!config) return not_done(config.error().message);
  const auto text = text_of(page_);
  if (!text) return not_done(text.error().message);
  const auto edited = settings::edited(settings::with_page_values(*config, *text, kPage), *config, values);
  if (!edited) return not_done(edited.error().name + ": " + edited.error().message);
  return replace(settings::with_values(*text, values, *edited),
                 values.size() == 1 ? "1 value is kept" : fmt::format("{} values are kept", values.size()));
}

http::Response PageSetup::forget_values() const {
  const auto text = text_of(page_);
  if (!text) return not_done(text.error().message);
  const auto kept = settings::kept_in(*text);
  constexpr const char* kDone = "the values are those of the configuration";
  if (kept && kept->empty()) {
    const auto config = configuration();
    return config ? done(kDone, false) : not_done(config.error().message);
  }
  return replace(settings::without_values(*text), kDone);
}

http::Response PageSetup::replace(const Result<std::string, Failure>& text, std::string_view done_what) const {
  if (!text) return not_done(text.error().message);
  const auto old = text_of(page_);
  if (!old) return not_done(old.error().message);
  const bool changes_sensors = !settings::have_same_sensors(*old, *text);
  if (const auto sound = check(*text, changes_sensors); !sound) return not_done(sound.error().message);
  // The state before is on the disk before the new one replaces it.
  if (const auto kept = write(before(), *old); !kept) return not_done(kept.error().message);
  if (const auto written = write(page_, *text); !written) return not_done(written.error().message);
  return done(done_what, changes_sensors);
}

http::Response PageSetup::undo() const {
  std::error_code error;
  if (page_.empty() || !fs::exists(before(), error)) return not_done("there is nothing to undo");
  const auto text = text_of(before());
  if (!text) return not_done(text.error().message);
  const auto undone = text_of(page_);
  const bool changes_sensors = !undone || !settings::have_same_sensors(*undone, *text);
  if (const auto sound = check(*text, changes_sensors); !sound) return not_done(sound.error().message);
  if (renameat2(AT_FDCWD, before().c_str(), AT_FDCWD, page_.c_str(), RENAME_EXCHANGE) != 0)
    return not_done(page_.string() + ": " + std::generic_category().message(errno));
  return done("the last change was undone", changes_sensors);
}

http::Response PageSetup::done(std::string_view what, bool changes_sensors) const {
  (changes_sensors ? taking_over_.restart : taking_over_.reload)();
  const std::string_view after = changes_sensors ? "; the daemon is started again, which takes some seconds" : "";
  return {.body = json_text(ordered_json{{"message", fmt::format("{}{}", what, after)}}, 2) + "\n"};
}

Result<std::string, Failure> PageSetup::trial(const settings::PageSensor& sensor) const {
  const auto config = configuration();
  if (!config) return config.error();
  const auto text = text_of(page_);
  if (!text) return text.error();
  settings::PageSensor named = sensor;
  named.name = "a sensor that is tried";
  std::string alone = settings::with_sensor({}, named);
  if (const auto sound = check(*text + alone, true); !sound) return sound.error();
  return {boost::system::in_place_value, std::move(alone)};
}

}  // namespace yuragi::daemon::web
