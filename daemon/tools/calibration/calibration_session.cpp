#include "daemon/tools/calibration/calibration_session.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include <fmt/format.h>

#include "daemon/settings/config_file.hpp"
#include "daemon/settings/own_token.hpp"
#include "daemon/settings/page_file.hpp"
#include "daemon/stream/control_client.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::tools::calibration {
namespace {

FailureError usage(const std::string& message) {
  return FailureError({message, FailureKind::kUsage});
}

/// "FROM,TO" in seconds.
Stretch parse_part(const std::string& text) {
  double from_s = 0.0;
  double to_s = 0.0;
  int used = 0;
  const int found = std::sscanf(text.c_str(), "%lf,%lf%n", &from_s, &to_s, &used);
  if (found != 2 || static_cast<std::size_t>(used) != text.size() || !(from_s >= 0.0) || !(to_s > from_s) ||
      !(to_s < 1e9)) {
    throw usage("--part: is \"" + text + "\"; allowed: FROM,TO in seconds, the second larger");
  }
  return {.from_s = from_s, .to_s = to_s};
}

std::string key_of(const settings::ConfigChange& change) {
  return change.table.empty() ? change.key : change.table + "." + change.key;
}

/// The driver's parameters whose values differ from those in the recording, except a microphone's own calibration,
/// which is undone, and secrets, which are not recorded.
std::set<std::string> settings_that_differ(const settings::SensorConfig& sensor, const SensorReadings& collected) {
  const bool is_microphone = sensor.driver->calibration == drivers::sensor::CalibrationMeans::kSoundLevel;
  std::set<std::string> keys;
  for (const std::string& text : collected.settings) {
    const auto values = settings::parse_values(text, sensor.driver->parameters);
    if (!values) return {"some that this version does not understand: " + values.error().message};
    for (const auto& [key, value] : values->all()) {
      const bool is_undone = is_microphone && (key == "gain" || key == "exponent" || key == "curve");
      if (std::holds_alternative<Secret>(value)) continue;
      if (!is_undone && value != sensor.values.all().at(key)) keys.insert(key);
    }
  }
  return keys;
}

/// The live values of a sensor.
std::string live_text(const settings::SensorConfig& sensor, const SensorReadings& collected) {
  if (collected.readings.empty()) return fmt::format("{}: waiting", sensor.name);
  const wind::Reading& last = collected.readings.back().reading;
  const double speed_m_s = last.speed_m_s * sensor.calibration.unit_m_s;
  return fmt::format("{}: {:.2f} m/s{}, {}", sensor.name, speed_m_s,
                     last.direction_deg ? fmt::format(" from {:.0f} deg", *last.direction_deg) : "",
                     count_text(collected.readings.size(), "reading"));
}

}  // namespace

Session::Session(const Request& request, const Way& way)
    : request_(request),
      way_(way),
      duration_s_(request.duration_s.value_or(way.duration_s)),
      dialog_(request.takes_yes) {
  for (const std::string& part : request_.parts) parse_part(part);
  if (is_live() && !request_.parts.empty()) throw usage("--part needs --recording");
  if (!is_live() && request_.duration_s) throw usage("--for is for live sensors; use --part for a recording");
  if (!dialog_.has_person() && !request_.takes_yes && !request_.is_dry_run && !request_.as_json) {
    throw usage("there is no terminal for questions: add --yes to write, or --dry-run to see the result only");
  }

  text_ = settings::read_config_text(request_.config_file);
  configuration_ = settings::parse_config(text_, request_.config_file.string());
  config_ = settings::with_page_file(configuration_, request_.config_file);
  if (config_.sensors.front().origin.empty()) {
    throw settings::ConfigError(request_.config_file.string() + ": has no [[sensor]] to calibrate");
  }
  if (request_.sensor.empty() && config_.sensors.size() > 1) {
    throw usage("there are several sensors: add --sensor NAME");
  }
  sensor_ = request_.sensor.empty() ? 0 : find(request_.sensor);
  if (!request_.reference.empty()) {
    reference_ = find(request_.reference);
    if (*reference_ == sensor_) throw usage("a sensor cannot be its own reference");
  }
  if (sensor().driver->calibration != way_.means) {
    throw usage(way_.means == drivers::sensor::CalibrationMeans::kSoundLevel
                    ? fmt::format("\"{}\" is not a microphone; use `yuragi calibrate span`", sensor().name)
                    : std::string(way_.calibration == "zero"
                                      ? "a microphone has no zero: its noise in a calm is found while it runs, or set "
                                        "as its noise_floor"
                                      : "a microphone is calibrated with `yuragi calibrate microphone`"));
  }
  if (request_.as_json) {
    std::vector<const settings::SensorConfig*> all = {&sensor()};
    if (reference_) all.push_back(reference());
    dialog_ = Dialog(false, &report_.emplace(std::move(all), duration_s_));
  } else if (std::ranges::find(configuration_.sensors, sensor().name, &settings::SensorConfig::name) ==
             configuration_.sensors.end()) {
    throw usage(fmt::format("the sensor \"{}\" was set up on the page, and is calibrated there", sensor().name));
  }
  if (!config_.page_trouble.empty())
    dialog_.print("Warning: what the page has set up is not read: " + config_.page_trouble);
}

void Session::open_source() {
  std::vector<const settings::SensorConfig*> sensors = {&sensor()};
  if (reference_) sensors.push_back(reference());
  const std::string address = request_.connect.value_or(config_.stream.listen);
  source_ = (is_live() ? make_live_source(std::move(sensors), address, clock_, request_.daemon_has_these_settings)
                       : make_recorded_source(std::move(sensors), request_.recording))
                .value();
  dialog_.print(fmt::format("Calibrating the sensor \"{}\" ({}) of {}, from {}.", sensor().name, sensor().driver->name,
                            request_.config_file.string(), source_->description()));
}

std::size_t Session::find(const std::string& name) const {
  const auto& sensors = config_.sensors;
  const auto found = std::ranges::find(sensors, name, &settings::SensorConfig::name);
  if (found != sensors.end()) return static_cast<std::size_t>(found - sensors.begin());
  std::string known;
  for (const settings::SensorConfig& sensor : sensors) known += (known.empty() ? "" : ", ") + sensor.name;
  throw usage(fmt::format("{} has no sensor \"{}\"; there are: {}", request_.config_file.string(), name, known));
}

CollectedReadings Session::collect(double number) {
  if (!source_) open_source();
  Stretch stretch{.duration_s = duration_s_};
  if (is_live()) {
    dialog_.wait_until_prepared("\n" + preparation_of(way_, number));
  } else if (stretches_ < request_.parts.size()) {
    stretch = parse_part(request_.parts[stretches_]);
  }
  ++stretches_;
  bool is_shown = false;
  CollectedReadings collected =
      source_
          ->collect(stretch,
                    [this, &is_shown](double elapsed_s, const CollectedReadings& so_far) {
                      if (report_) return report_->progress(elapsed_s, so_far);
                      if (is_live())
                        return dialog_.show(elapsed_s, progress_line(elapsed_s, so_far), elapsed_s >= duration_s_);
                      dialog_.show(elapsed_s, fmt::format("{:.0f} s of the recording", elapsed_s), false);
                      is_shown = true;
                    })
          .value();
  if (is_shown) dialog_.show(0.0, "the recording was read", true);
  beware(collected);
  return collected;
}

void Session::beware(const CollectedReadings& collected) const {
  for (std::size_t index = 0; index < collected.size(); ++index) {
    const settings::SensorConfig* const one = index == 0 ? &sensor() : reference();
    if (one == nullptr) continue;
    if (const auto keys = settings_that_differ(*one, collected[index]); !keys.empty()) {
      dialog_.print(fmt::format("Warning: when this was recorded, the driver of \"{}\" had different settings: {}.",
                                one->name, fmt::join(keys, ", ")));
    }
  }
  const auto is_simulated = [](const TimedReading& one) {
    return one.reading.quality == wind::ReadingQuality::kSimulated;
  };
  for (const SensorReadings& one : collected) {
    if (std::ranges::any_of(one.readings, is_simulated)) {
      dialog_.print("Warning: these readings are simulated.");
      break;
    }
  }
}

std::string Session::progress_line(double elapsed_s, const CollectedReadings& collected) const {
  std::string line = fmt::format("{:3.0f} of {:.0f} s  {}", elapsed_s, duration_s_, live_text(sensor(), collected[0]));
  if (reference_) line += "  " + live_text(*reference(), collected[1]);
  return line;
}

ParameterValue Session::value_now(const settings::ConfigChange& change) const {
  return settings::value_at(sensor(), change);
}

ParameterValue Session::value_in_file(const settings::ConfigChange& change) const {
  return settings::value_at(*std::ranges::find(configuration_.sensors, sensor().name, &settings::SensorConfig::name),
                            change);
}

void Session::report_point(const wind::judging::CalibrationPoint& point) {
  if (report_) report_->point(point);
}

Effect Session::speed_effect(std::span<const settings::ConfigChange> wanted,
                             std::span<const double> indicated_m_s) const {
  ParameterValues changed = sensor().by_name.at(settings::kCalibrationTable);
  for (const settings::ConfigChange& change : wanted) {
    if (!change.table.empty()) changed.set(change.key, change.value);
  }
  // At the height of the sensor: the height factor is applied afterwards, and does not change.
  wind::judging::Calibration now = calibration();
  wind::judging::Calibration then = settings::calibration_of(changed);
  now.height_factor = then.height_factor = 1.0;
  Effect effect{.indicated_unit = "m/s", .unit = "m/s"};
  for (const double indicated : indicated_m_s) {
    wind::Reading reading;
    reading.speed_m_s = indicated / now.unit_m_s;
    effect.rows.push_back(
        {.indicated = indicated, .now = now.applied_to(reading).speed_m_s, .then = then.applied_to(reading).speed_m_s});
  }
  return effect;
}

/// Values that the page has set and this calibration leaves as they are.
void Session::take_over_page(std::vector<settings::ConfigChange>& wanted) const {
  for (const Parameter& key : settings::page_calibration_keys(*sensor().driver)) {
    settings::ConfigChange change = settings::place_of_page_key(key.name);
    change.value = value_now(change);
    const bool is_wanted = std::ranges::any_of(
        wanted, [&](const settings::ConfigChange& one) { return one.table == change.table && one.key == change.key; });
    if (!is_wanted && change.value != value_in_file(change)) wanted.push_back(std::move(change));
  }
}

void Session::finish(std::vector<settings::ConfigChange> wanted, const Effect& effect) {
  const auto is_in_use = [this](const settings::ConfigChange& change) { return change.value == value_now(change); };
  if (std::ranges::all_of(wanted, is_in_use)) {
    dialog_.print("\nThe configuration has these values already: nothing to write.");
    return;
  }
  if (report_) {
    std::erase_if(wanted, is_in_use);
    std::vector<settings::ConfigChange> before = wanted;
    for (settings::ConfigChange& change : before) change.value = value_now(change);
    return report_->found(before, wanted, effect);
  }
  take_over_page(wanted);
  std::erase_if(wanted, [this](const settings::ConfigChange& change) { return change.value == value_in_file(change); });
  if (wanted.empty()) {
    throw usage(
        fmt::format("the configuration has these values, but the page's calibration of \"{}\" counts; remove "
                    "it on the page",
                    sensor().name));
  }
  std::string text = "\n";
  for (const settings::ConfigChange& change : wanted) {
    text += fmt::format("  {:<24} {} -> {}\n", key_of(change), settings::toml_value(value_in_file(change)),
                        settings::toml_value(change.value));
  }
  for (const std::string& line : lines_of(effect)) text += "  " + line + "\n";
  dialog_.print(text);

  const auto edited = settings::edit_sensor(text_, sensor().name, wanted);
  if (!edited) throw settings::ConfigError(request_.config_file.string() + ": " + edited.error().message);
  if (request_.is_dry_run) {
    dialog_.print("A dry run: nothing was written.");
  } else if (!dialog_.confirm(fmt::format("Write this to {}?", request_.config_file.string()))) {
    dialog_.print("Nothing was written.");
  } else {
    const auto kept = settings::replace_config(request_.config_file, text_, *edited).value();
    dialog_.print(
        fmt::format("{} was written; the previous version is in {}.", request_.config_file.string(), kept.string()));
    apply_in_daemon();
  }
}

/// Has the daemon that was started with this file, if it runs, read it again; prints the result.
void Session::apply_in_daemon() {
  const std::string address = request_.connect.value_or(config_.stream.listen);
  const auto report = stream::ask_to_reload(address, settings::absolute_path(request_.config_file),
                                            settings::own_token(address, request_.config_file).token);
  if (!report) {
    dialog_.print(fmt::format("Restart a running daemon to apply it: {}.", report.error().message));
  } else if (report->outcome == wire::ReloadOutcome::kDone) {
    dialog_.print(fmt::format("The daemon at {} has read it again:\n{}", address, stream::reload_text(*report)));
  } else {
    dialog_.print(fmt::format("The daemon at {} goes on without it:\n{}Restart the daemon that uses this file.",
                              address, stream::reload_text(*report)));
  }
}

std::vector<double> indicated_speeds_m_s(const SensorReadings& collected,
                                         const wind::judging::Calibration& calibration) {
  std::vector<double> speeds_m_s;
  for (const TimedReading& one : collected.readings) speeds_m_s.push_back(one.reading.speed_m_s * calibration.unit_m_s);
  return speeds_m_s;
}

ReferencePairs pair_with_reference(const Session& session, const CollectedReadings& collected, double least_block_s) {
  // Only if both heights are known; else the sensors are assumed to be side by side.
  const wind::judging::Calibration& calibration = session.calibration();
  wind::judging::Calibration reference = session.reference()->calibration;
  const bool has_heights =
      session.sensor().heights.sensor_m.has_value() && session.reference()->heights.sensor_m.has_value();
  if (!has_heights) reference.height_factor = 1.0;
  const double to_sensor = has_heights ? 1.0 / calibration.height_factor : 1.0;

  ReferencePairs result{.block_s = least_block_s};
  for (const SensorReadings& one : collected) {
    if (one.readings.size() < 2) continue;
    const double span_s = one.readings.back().time_s - one.readings.front().time_s;
    result.block_s = std::max(result.block_s, 3.0 * span_s / static_cast<double>(one.readings.size() - 1));
  }
  std::vector<wind::judging::TimedSpeed> indicated;
  for (const TimedReading& one : collected[0].readings) {
    indicated.push_back({one.time_s, one.reading.speed_m_s * calibration.unit_m_s});
  }
  for (const TimedReading& one : collected[1].readings) {
    result.truth.push_back({one.time_s, reference.applied_to(one.reading).speed_m_s * to_sensor});
  }
  result.pairs = wind::judging::pair_means(indicated, result.truth, result.block_s);
  return result;
}

void refuse(const Failure& failure) {
  throw FailureError({failure.message + ". Nothing was written", FailureKind::kBadData});
}

double rounded(double value, double step) noexcept {
  const double result = std::round(value / step) * step;
  // The nearest decimal, so that it is written as 1.043 and not as 1.0430000000000001.
  const double scale = std::round(1.0 / step);
  return std::round(result * scale) / scale + 0.0;
}

}  // namespace yuragi::daemon::tools::calibration
