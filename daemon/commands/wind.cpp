// `yuragi wind`: runs the daemon's estimator over a recording, and prints a table.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/lock_recording.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/sensing/recorded_source.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/sensor_blend.hpp"
#include "daemon/tools/offline/offline_wind.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "engine/base/count_text.hpp"
#include "engine/platform/whole_file.hpp"
#include "engine/wind/blend/blended_estimator.hpp"

namespace yuragi::daemon::commands {

extern const Command kWindCommand;

namespace {

constexpr const char* kWindFooter =
    "Processes the recording as the daemon processes its sensor, and writes the resulting wind: time_s (since the\n"
    "start), u_m_s and v_m_s (toward east and north), speed_m_s, direction_deg (where the wind comes from), trust\n"
    "(0: default wind only, 1: sensor only), state (default, handover, live).\n"
    "\n"
    "Readings that the daemon would reject (spikes, a frozen value, one that contradicts other sensors) are left\n"
    "out, unless a --config sets [sensor.judge] enabled = false. The same recording, options and seed give the same\n"
    "table. It has the real wind; with --shaped the one that moves the scenes, without opening hours.\n"
    "\n"
    "--value states what the recorded speeds are: mean (since the previous reading), instant, or maximum (not used\n"
    "as wind). Default: as stated by the driver that recorded them, otherwise judged from the readings.\n"
    "--sensor-interval simulates a slower sensor by vector means over that many seconds. --gap omits the readings\n"
    "between two times; repeatable.\n"
    "\n"
    "u_m_s and v_m_s are the wind at the sensor. Without --sensor-place the sensor is at the windward edge of the\n"
    "scenes: on the circle around a square of --scene-size. Each --place adds columns for a place on the ground:\n"
    "u1_m_s, v1_m_s, then u2_m_s, v2_m_s; a comment at the top of the table lists the places. --also adds an\n"
    "anemometer at another place, from a recording that began at the same time.\n"
    "\n"
    "  yuragi wind mast.windlog --rate 60 --sensor-interval 14 --gap 600,700 -o blended.csv\n"
    "  yuragi wind mast.windlog --scene-size 7 --place -3,0 --place 3,0 -o meadow.csv";

/// A place on the ground, metres from the middle of the scenes.
struct GroundPlace {
  double east_m = 0.0;
  double south_m = 0.0;
};

struct WindOptions {
  std::filesystem::path file;
  std::string output;
  tools::offline::WindOptions offline;
  std::vector<std::string> gaps;
  double scene_size_m = 0.0;
  std::vector<std::string> places;
  std::optional<std::string> sensor_place;
  double lead_m = 0.0;
  std::vector<std::string> also;
  std::optional<std::string> value;  ///< one of wind::kReadingValueNames
  drivers::windlog::PlaybackOptions playback;
  std::optional<std::filesystem::path> config_file;
  std::optional<std::uint64_t> seed;
  bool shaped = false;
  bool force = false;
};

/// "A,B": two numbers.
std::optional<std::pair<double, double>> two_numbers(const std::string& text) {
  double first = 0.0;
  double second = 0.0;
  int used = 0;
  const int found = std::sscanf(text.c_str(), "%lf,%lf%n", &first, &second, &used);
  if (found != 2 || static_cast<std::size_t>(used) != text.size()) return std::nullopt;
  return std::pair(first, second);
}

/// "FROM,TO" in seconds.
tools::offline::Gap parse_gap(const std::string& text) {
  const auto gap = two_numbers(text);
  if (!gap || !(gap->first >= 0.0) || !(gap->second > gap->first)) {
    throw ExitError(kExitUsage, "--gap: is \"" + text + "\"; allowed: FROM,TO in seconds, the second larger");
  }
  return {gap->first, gap->second};
}

/// "X,Z" in metres.
GroundPlace parse_place(const std::string& option, const std::string& text) {
  constexpr double kFarthest_m = 1000.0;
  const auto place = two_numbers(text);
  if (!place || !(std::abs(place->first) <= kFarthest_m) || !(std::abs(place->second) <= kFarthest_m)) {
    throw ExitError(kExitUsage, option + ": is \"" + text +
                                    "\"; allowed: X,Z in metres east and south of the middle of the scenes, each from "
                                    "-1000 to 1000");
  }
  return {place->first, place->second};
}

const std::filesystem::path& existing(const std::filesystem::path& file) {
  if (!drivers::windlog::recording_exists(file))
    throw ExitError(kExitNoInput, file.string() + ": the recording does not exist");
  return file;
}

std::string_view name_of(wind::Source source) {
  switch (source) {
    case wind::Source::kDefault:
      return "default";
    case wind::Source::kHandover:
      return "handover";
    case wind::Source::kLive:
      return "live";
  }
  return "?";
}

/// Writes text in blocks. A failure to write is reported at the end.
class Table {
 public:
  Table(std::FILE* out, std::span<const GroundPlace> places) : out_(out) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      fmt::format_to(std::back_inserter(text_), "{} u{}_m_s, v{}_m_s: {:g} m east and {:g} m south of the middle",
                     i == 0 ? "#" : ";", i + 1, i + 1, places[i].east_m, places[i].south_m);
    }
    text_ += places.empty() ? "time_s" : "\ntime_s";
    text_ += ",u_m_s,v_m_s,speed_m_s,direction_deg,trust,state";
    for (std::size_t i = 1; i <= places.size(); ++i) {
      fmt::format_to(std::back_inserter(text_), ",u{}_m_s,v{}_m_s", i, i);
    }
    text_ += '\n';
  }

  void add(double time_s, const wind::State& state, std::span<const wind::Vector> at_places) {
    // Just west of north is rounded to 0, not to 360.
    const double direction_deg = std::fmod(std::round(wind::direction_from_deg(state.wind) * 1e4) / 1e4, 360.0);
    add_number(time_s, 6);
    for (const double value : {state.wind.u_m_s, state.wind.v_m_s, speed_of(state.wind)}) add_cell(value, 6);
    add_cell(direction_deg, 4);
    add_cell(state.live_weight, 4);
    text_.append(1, ',').append(name_of(state.source));
    for (const wind::Vector wind : at_places) {
      add_cell(wind.u_m_s, 6);
      add_cell(wind.v_m_s, 6);
    }
    text_ += '\n';
    if (text_.size() > kBlock) flush();
  }
  void flush() {
    is_complete_ = std::fwrite(text_.data(), 1, text_.size(), out_) == text_.size() && is_complete_;
    text_.clear();
  }
  void end(const std::string& name) {
    flush();
    if (!is_complete_ || std::fflush(out_) != 0) {
      throw ExitError(kExitCannotCreate, name + ": could not be written completely; is the disk full?");
    }
  }

 private:
  static constexpr std::size_t kBlock = 1 << 16;

  void add_cell(double value, int digits_after_point) {
    text_ += ',';
    add_number(value, digits_after_point);
  }
  /// Most of the cost of a table with many places.
  void add_number(double value, int digits_after_point) {
    std::array<char, 400> digits{};  // of any number
    const auto end =
        std::to_chars(digits.begin(), digits.end(), value, std::chars_format::fixed, digits_after_point).ptr;
    text_.append(digits.begin(), end);
  }

  std::FILE* out_;
  std::string text_;
  bool is_complete_ = true;
};

/// The wind over the ground at a given place.
class WindAtPlaces {
 public:
  WindAtPlaces(std::shared_ptr<const wind::turbulence::GustNoise> gusts, std::vector<GroundPlace> places)
      : gusts_(std::move(gusts)), places_(std::move(places)), winds_(places_.size()) {}

  std::span<const GroundPlace> places() const { return places_; }

  std::span<const wind::Vector> read(const wind::ground::DrivingWind& wind) {
    const wind::ground::Wind ground = written_to(tapes_, wind);
    std::ranges::transform(places_, winds_.begin(),
                           [&](const GroundPlace& place) { return ground.at(*gusts_, place.east_m, place.south_m); });
    return winds_;
  }

 private:
  std::shared_ptr<const wind::turbulence::GustNoise> gusts_;
  std::vector<GroundPlace> places_;
  std::vector<wind::Vector> winds_;
  wind::ground::WindTapes tapes_;
};

/// "FILE.windlog@X,Z": a recording, and where its anemometer stood.
struct PlacedRecording {
  std::filesystem::path file;
  GroundPlace place;
};

PlacedRecording parse_also(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) {
    throw ExitError(kExitUsage, "--also: is \"" + text + "\"; allowed: FILE.windlog@X,Z");
  }
  return {text.substr(0, at), parse_place("--also", text.substr(at + 1))};
}

void stand_at(wind::blend::SourceSettings& source, const GroundPlace& place, double lead_m) {
  source.has_place = true;
  source.east_m = place.east_m;
  source.south_m = place.south_m;
  source.lead_m = lead_m;
}

/// Sets what the speeds of a recording are: by the configuration or --value, otherwise by the driver that recorded
/// them. Those of a simulated slower sensor are means.
void set_recorded_value(wind::blend::SourceSettings& source, const WindOptions& options, const settings::Config& config,
                        const std::filesystem::path& file) {
  const drivers::sensor::StatedValue value = settings::sensor_value_of(
      config.sensors[0].by_name.at(settings::kBlendTable),
      options.offline.sensor_interval_s ? drivers::sensor::StatedValue{.value = wind::ReadingValue::kMean}
                                        : sensing::recorded_source(file, options.playback.sensor).value);
  source.value = value.value;
  source.averaging_s = value.averaging_s;
  if (!makes_wind(source.value)) {
    fmt::print(stderr, "{}: its speeds are maxima, which are not used as wind; the default wind of [wind] is used\n",
               file.string());
  }
}

void write_wind(const WindOptions& options, const settings::Config& config, std::FILE* out) {
  wind::blend::Settings settings = sensing::blend_settings_of(config);
  settings.sources.resize(1);
  settings.reach_m = options.scene_size_m / std::numbers::sqrt2;
  settings.rate_hz = options.offline.rate_hz;
  if (options.sensor_place) {
    stand_at(settings.sources[0], parse_place("--sensor-place", *options.sensor_place), options.lead_m);
  }
  set_recorded_value(settings.sources[0], options, config, options.file);
  std::vector<drivers::windlog::Playback> playbacks;
  playbacks.push_back(drivers::windlog::Playback::open(options.file, options.playback).value());
  if (!options.also.empty()) settings.sources[0].priority = 1;  // they are used together
  for (const std::string& text : options.also) {
    const PlacedRecording other = parse_also(text);
    stand_at(settings.sources.emplace_back(settings.sources[0]), other.place, options.lead_m);
    set_recorded_value(settings.sources.back(), options, config, other.file);
    playbacks.push_back(drivers::windlog::Playback::open(other.file, options.playback).value());
  }
  std::vector<GroundPlace> places;
  for (const std::string& text : options.places) places.push_back(parse_place("--place", text));

  const std::shared_ptr<const wind::turbulence::GustNoise> gusts = sensing::make_gust_noise(config);
  wind::blend::BlendedEstimator estimator(settings.sources.size(), settings, gusts);
  wind::shaping::WindShaping shaping(config.shaping.settings, gusts);
  WindAtPlaces at_places(gusts, std::move(places));
  Table table(out, at_places.places());
  const bool is_watched = isatty(STDERR_FILENO) != 0;
  const auto shown_each = static_cast<std::uint64_t>(600.0 * options.offline.rate_hz);
  std::uint64_t states = 0;
  const auto run =
      tools::offline::run_offline(playbacks, estimator, options.offline, [&](double time_s, const wind::State& state) {
        wind::ground::DrivingWind wind{state, estimator.ground(), estimator.stroke()};
        if (options.shaped) shaping.shape(wind, true);
        table.add(time_s, wind.state, at_places.read(wind));
        if (is_watched && ++states % shown_each == 0) fmt::print(stderr, "\r{:.0f} s of the recording", time_s);
      });
  const tools::offline::WindResult& result = run.value();
  table.end(options.output);
  if (is_watched) fmt::print(stderr, "\r\x1b[K");
  fmt::print(stderr, "{}: {} states of {:.1f} s, from {}{}\n",
             options.output == "-" ? "standard output" : options.output, result.states, result.duration_s,
             count_text(result.readings, "reading"),
             result.withheld > 0 ? fmt::format("; {} rejected", result.withheld) : "");
}

void run_wind(WindOptions options) {
  existing(options.file);
  for (const std::string& gap : options.gaps) options.offline.gaps.push_back(parse_gap(gap));
  settings::Config config = configuration_of(options.config_file);
  config.sensors.resize(1);
  if (options.seed) config.seed = *options.seed;
  if (options.value) config.sensors[0].by_name.at(settings::kBlendTable).set("value", *options.value);
  options.offline.rules = sensing::jury_rules_of(config.sensors[0]);
  options.offline.stale_intervals = config.wind.stale_intervals;
  options.offline.has_relative_gains = config.wind.has_relative_gains;

  if (options.output == "-") return write_wind(options, config, stdout);
  const auto lock = lock_output(options.output);
  platform::OutputFile output(options.output, options.force, drivers::windlog::kSideSuffixes);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(output.working_path().c_str(), "we"),
                                                             &std::fclose);
  if (!file) {
    throw ExitError(kExitCannotCreate, options.output + ": cannot be created; is its folder writable?");
  }
  write_wind(options, config, file.get());
  output.commit().value();
}

void add_wind(CLI::App& app) {
  CLI::App* command = app.add_subcommand("wind", "Compute the daemon's wind from a recording, as a CSV file");
  command->footer(kWindFooter);
  auto options = std::make_shared<WindOptions>();
  command->add_option("file", options->file, "the recording")->required()->type_name("FILE.windlog");
  command->add_option("-o,--output", options->output, "FILE.csv, or - for standard output")->required();
  command->add_option("--rate", options->offline.rate_hz, "states per second")
      ->check(CLI::Range(0.01, 1000.0))
      ->type_name("HZ")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "seed of the noise; default: that of the configuration");
  CLI::Option* const value =
      command->add_option("--value", options->value, "what the recorded speeds are: mean, instant or maximum")
          ->check(
              CLI::IsMember(std::vector<std::string>(wind::kReadingValueNames.begin(), wind::kReadingValueNames.end())))
          ->type_name("VALUE");
  command
      ->add_option("--sensor-interval", options->offline.sensor_interval_s, "simulate a sensor with this interval, s")
      ->check(CLI::Range(0.01, 3600.0))
      ->excludes(value)
      ->type_name("T");
  command->add_option("--gap", options->gaps, "leave out the readings between two times, s")
      ->allow_extra_args(false)
      ->type_name("FROM,TO");
  command->add_option("--place", options->places, "add the wind at this place: metres east and south of the middle")
      ->allow_extra_args(false)
      ->type_name("X,Z");
  command->add_option("--scene-size", options->scene_size_m, "edge of the square that the scenes fill, m")
      ->check(CLI::Range(0.0, 1000.0))
      ->type_name("S")
      ->capture_default_str();
  auto* const sensor_place =
      command->add_option("--sensor-place", options->sensor_place, "place of the sensor; default: the windward edge")
          ->allow_extra_args(false)
          ->type_name("X,Z");
  command->add_option("--also", options->also, "another anemometer and its place; needs --sensor-place")
      ->allow_extra_args(false)
      ->needs(sensor_place)
      ->type_name("FILE.windlog@X,Z");
  command->add_option("--lead", options->lead_m, "shift the sensors upwind of their places by this distance, m")
      ->needs(sensor_place)
      ->check(CLI::Range(0.0, 1000.0))
      ->type_name("M")
      ->capture_default_str();
  command->add_option("--sensor", options->playback.sensor, "which sensor; default: the one with the first reading")
      ->type_name("NAME");
  command->add_option("--start", options->playback.start, "where to begin: seconds, or a UTC time (ISO 8601)")
      ->type_name("T");
  command->add_option("--config", options->config_file, "use [wind] and [shaping] of this configuration")
      ->type_name("FILE.toml");
  command->add_flag("--shaped", options->shaped,
                    "write the wind of the scenes, after [shaping]: floor, site gain, ceiling");
  command->add_flag("--force", options->force, "overwrite the output");
  command->callback([options] { run_wind(*options); });
}

}  // namespace

const Command kWindCommand{add_wind};

}  // namespace yuragi::daemon::commands
