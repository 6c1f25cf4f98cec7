#include "daemon/web/sensor_setup.hpp"

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

SensorSetup::SensorSetup(fs::path configuration, fs::path page, std::function<void()> restart)
    : configuration_(std::move(configuration)), page_(std::move(page)), restart_(std::move(restart)) {}

fs::path SensorSetup::before() const {
  return page_.string() + ".before";
}

/// Without the page's part. Fails if the page may set up nothing.
Result<settings::Config, Failure> SensorSetup::configuration() const {
  if (configuration_.empty() || page_.empty())
    return Failure{"the daemon runs without a configuration file: start it with `yuragi run --config FILE`"};
  if (!restart_) return Failure{"this daemon cannot be started again by the page"};
  try {
    settings::Config config = settings::load_config(configuration_);
    if (config.http.token_file.empty())
      return Failure{"only a paired browser may set up sensors: set [http] token_file in the configuration"};
    if (auto refusal = settings::control_refusal(config.stream.control, true, "sensors cannot be set up"))
      return Failure{std::move(*refusal)};
    return config;
  } catch (const settings::ConfigError& error) {
    return Failure{std::string("the configuration has mistakes, with which the daemon cannot start again: ") +
                   error.what()};
  }
}

/// Empty if there is no such file.
Result<std::string, Failure> SensorSetup::text_of(const fs::path& file) const {
  std::error_code error;
  if (!fs::exists(file, error) && !error) return {boost::system::in_place_value, std::string()};
  auto text = platform::read_whole(file, settings::kMaxPage_bytes);
  if (!text) return Failure{file.filename().string() + " " + text.error().message};
  return {boost::system::in_place_value, std::move(*text)};
}

Result<void, Failure> SensorSetup::check(const std::string& text) const {
  const auto config = configuration();
  if (!config) return config.error();
  if (text.size() > settings::kMaxPage_bytes) return Failure{"too many sensors: the file of the page is full"};
  try {
    settings::with_page_checked(*config, text, kPage);
    return {};
  } catch (const std::exception& error) {
    return Failure{error.what()};
  }
}

http::Response SensorSetup::list() const {
  const auto text = text_of(page_);
  const auto names = text ? settings::sensors_in(*text) : Result<std::vector<std::string>, Failure>(text.error());
  std::error_code error;
  return {.body = json_text(ordered_json{{"sensors", names ? ordered_json(*names) : ordered_json::array()},
                                         {"can_undo", !page_.empty() && fs::exists(before(), error)},
                                         {"trouble", names ? ordered_json() : ordered_json(names.error().message)}},
                            2) +
                  "\n"};
}

http::Response SensorSetup::add(const settings::PageSensor& sensor) const {
  const auto text = text_of(page_);
  if (!text) return not_done(text.error().message);
  return replace({boost::system::in_place_value, settings::with_sensor(*text, sensor)},
                 fmt::format("sensor {} was added", sensor.name));
}

http::Response SensorSetup::remove(const std::string& name) const {
  const auto text = text_of(page_);
  if (!text) return not_done(text.error().message);
  auto without = settings::without_sensor(*text, name);
  if (!without && without.error().kind == FailureKind::kNoInput)
    return problem(404, "Not found", without.error().message + "; others are in the configuration");
  return replace(without, fmt::format("sensor {} was removed", name));
}

http::Response SensorSetup::replace(const Result<std::string, Failure>& text, std::string_view done_what) const {
  if (!text) return not_done(text.error().message);
  if (const auto sound = check(*text); !sound) return not_done(sound.error().message);
  const auto old = text_of(page_);
  if (!old) return not_done(old.error().message);
  // The state before is on the disk before the new one replaces it.
  if (const auto kept = write(before(), *old); !kept) return not_done(kept.error().message);
  if (const auto written = write(page_, *text); !written) return not_done(written.error().message);
  return done(done_what);
}

http::Response SensorSetup::undo() const {
  std::error_code error;
  if (page_.empty() || !fs::exists(before(), error)) return not_done("there is nothing to undo");
  const auto text = text_of(before());
  if (!text) return not_done(text.error().message);
  if (const auto sound = check(*text); !sound) return not_done(sound.error().message);
  if (renameat2(AT_FDCWD, before().c_str(), AT_FDCWD, page_.c_str(), RENAME_EXCHANGE) != 0)
    return not_done(page_.string() + ": " + std::generic_category().message(errno));
  return done("the last change was undone");
}

http::Response SensorSetup::done(std::string_view what) const {
  restart_();
  return {.body =
              json_text(ordered_json{{"message",
                                      fmt::format("{}; the daemon is started again, which takes some seconds", what)}},
                        2) +
              "\n"};
}

Result<std::string, Failure> SensorSetup::trial(const settings::PageSensor& sensor) const {
  const auto config = configuration();
  if (!config) return config.error();
  const auto text = text_of(page_);
  if (!text) return text.error();
  settings::PageSensor named = sensor;
  named.name = "a sensor that is tried";
  std::string alone = settings::with_sensor({}, named);
  if (const auto sound = check(*text + alone); !sound) return sound.error();
  return {boost::system::in_place_value, std::move(alone)};
}

}  // namespace yuragi::daemon::web
