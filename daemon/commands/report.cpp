// `yuragi report`: makes an HTML page of a recording.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/lock_recording.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/settings/config.hpp"
#include "daemon/settings/site_octaves.hpp"
#include "daemon/tools/report/measure_recording.hpp"
#include "daemon/tools/report/report_figures.hpp"
#include "daemon/tools/report/report_json.hpp"
#include "daemon/tools/report/report_page.hpp"
#include "daemon/tools/report/report_text.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/log_moment.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "engine/base/count_text.hpp"
#include "engine/platform/whole_file.hpp"
#include "engine/wind/blend/source_estimator.hpp"
#include "engine/wind/turbulence/wind_profile.hpp"

namespace yuragi::daemon::commands {

extern const Command kReportCommand;

namespace {

constexpr const char* kReportFooter =
    "Writes one self-contained HTML file: a summary, speed, gust and direction over time, wind rose, distribution,\n"
    "spectrum with its slope and the fitted von Karman spectrum (U, TI, L), gaps, and the states of each sensor. It "
    "has the\n"
    "lines for a default wind in a configuration, ready to be copied.\n"
    "For a sensor with an interval of 1 s or less it gives the correction that a slow sensor at its place needs for "
    "gusts\n"
    "(site_octaves of [wind]): on the page, and on standard output. --height is the height of the sensor above the\n"
    "ground, for sensors without a height in their calibration.\n"
    "Hours of the day are local time, in the zone of this machine (TZ).\n"
    "\n"
    "Examples:\n"
    "  yuragi report mast.windlog -o mast.html\n"
    "  yuragi report mast.windlog -o july.html --from 2018-07-01 --to 2018-08-01 --sensor roof --json july.json\n"
    "Then open mast.html in any browser, or print it.";

struct ReportOptions {
  std::string input;
  std::string output;
  std::string json;
  std::string from;
  std::string to;
  std::vector<std::string> sensors;
  std::optional<std::filesystem::path> config_file;
  double height_m = 0.0;
  bool force = false;
};

/// The log time of --from or --to; the end if it is after that.
Nanoseconds moment_of(drivers::windlog::Reader& reader, const std::string& option, const std::string& text) {
  const auto moment = drivers::windlog::parse_log_moment(text);
  if (!moment) throw ExitError(kExitUsage, option + ": " + moment.error().message);
  const auto log_time = drivers::windlog::log_time_of(reader, *moment);
  if (!log_time) throw ExitError(kExitDataError, log_time.error().message);
  return log_time->value_or(Nanoseconds::max());
}

void write_text(const platform::OutputFile& output, const std::string& name, const std::string& text) {
  std::ofstream file(output.working_path(), std::ios::binary);
  file << text;
  file.close();
  if (!file)
    throw ExitError(kExitCannotCreate, name + ": cannot be written; is the disk full, or the folder not writable?");
}

/// Shows progress on a terminal.
class ProgressLine {
 public:
  void show(const std::string& text) {
    if (!is_watched_ || std::chrono::steady_clock::now() - began_ < std::chrono::seconds(1)) return;
    fmt::print(stderr, "\r\x1b[K{}", text);
    has_shown_ = true;
  }
  ~ProgressLine() {
    if (has_shown_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  bool is_watched_ = isatty(STDERR_FILENO) != 0;
  bool has_shown_ = false;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

/// The prior of a sensor's gusts: from --height, or from the calibration of the sensor of this name.
wind::turbulence::Prior prior_of(const settings::Config& config, double height_m, const std::string& name) {
  wind::blend::SourceSettings source;
  if (height_m == 0.0 && !config.wind.default_length_m) {
    for (const settings::SensorConfig& sensor : config.sensors) {
      if (sensor.name == name) height_m = sensor.heights.sensor_m.value_or(0.0);
    }
  }
  // As recorded: not scaled to another height.
  if (height_m > 0.0)
    source.length_m = wind::turbulence::iec_length_scale_m(wind::turbulence::WindComponent::kAlong, height_m);
  return wind::blend::turbulence_prior({.climate = {.turbulence_intensity = config.wind.default_turbulence_intensity},
                                        .length_m = config.wind.gust_length_m()},
                                       source);
}

/// Prints the lines for the configuration on the terminal, too.
void print_site(const tools::report::SensorNumbers& sensor) {
  if (!sensor.site) return;
  fmt::print(
      "# {}: correction of gusts at this site, for gusts of {:.0f} m\n"
      "[wind]\n"
      "site_octaves = \"{}\"\n",
      tools::report::page_text(sensor.name), sensor.site->length_m,
      settings::site_octaves_text(sensor.site->octaves_db));
}

void run_report(const ReportOptions& options) {
  auto reader = drivers::windlog::Reader::open(options.input);
  if (!reader) {
    const bool is_there = drivers::windlog::recording_exists(options.input);
    throw ExitError(is_there ? kExitDataError : kExitNoInput, reader.error().message);
  }
  if (!options.json.empty() && options.json == options.output) {
    throw ExitError(kExitUsage, "--json: is the same file as the page; choose another file");
  }
  // Checked before hours of work.
  const auto page_lock = lock_output(options.output);
  platform::OutputFile page_file(options.output, options.force, drivers::windlog::kSideSuffixes);
  const auto json_lock = lock_output(options.json);
  std::optional<platform::OutputFile> json_file;
  if (!options.json.empty()) json_file.emplace(options.json, options.force, drivers::windlog::kSideSuffixes);

  const settings::Config config = configuration_of(options.config_file);
  tools::report::Settings settings;
  settings.sensors = options.sensors;
  settings.stale_intervals = config.wind.stale_intervals;
  settings.utc_offset = tools::report::local_offset;
  settings.prior = [&](const std::string& sensor) { return prior_of(config, options.height_m, sensor); };
  if (!options.from.empty()) settings.range.from = moment_of(*reader, "--from", options.from);
  if (!options.to.empty()) settings.range.to = moment_of(*reader, "--to", options.to);

  // The numbers, the figures, the page.
  ProgressLine progress;
  const auto numbers = tools::report::measure_recording(*reader, settings, [&progress](std::uint64_t readings) {
    progress.show(fmt::format("{} readings (each is read twice)", readings));
  });
  if (!numbers) throw ExitError(kExitDataError, options.input + ": " + numbers.error().message);
  for (const std::string& damage : reader->damage()) fmt::print(stderr, "warning: {}\n", damage);
  const std::string source = std::filesystem::path(options.input).filename();
  std::vector<tools::report::SensorFigures> figures;
  for (const tools::report::SensorNumbers& sensor : numbers->sensors) {
    progress.show(fmt::format("figures {} of {}", figures.size() + 1, numbers->sensors.size()));
    figures.push_back(tools::report::draw_figures(*numbers, sensor, page_file.working_path()).value());
  }
  write_text(page_file, options.output, tools::report::report_page(*numbers, figures, source));
  if (json_file) {
    write_text(*json_file, options.json, tools::report::report_json(*numbers, source));
    json_file->commit().value();
  }
  page_file.commit().value();
  fmt::print(stderr, "{}: {} of {}\n", options.output, count_text(numbers->readings, "reading"),
             count_text(numbers->sensors.size(), "sensor"));
  for (const tools::report::SensorNumbers& sensor : numbers->sensors) print_site(sensor);
}

void add_report(CLI::App& app) {
  const auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report", "Write an HTML report about a recording");
  command->footer(kReportFooter);
  command->add_option("file", options->input, "the recording")->required()->type_name("FILE.windlog");
  command->add_option("-o,--output", options->output, "the page to write")->required()->type_name("FILE.html");
  command
      ->add_option("--height", options->height_m, "height of the sensors above the ground, m; default: as in --config")
      ->check(CLI::Range(0.1, 1000.0))
      ->type_name("M");
  command->add_option("--sensor", options->sensors, "only this sensor; can be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--from", options->from, "where to begin: seconds, or a time such as 2018-07-20T14:05:00Z")
      ->type_name("T");
  command->add_option("--to", options->to, "where to end, in the same form")->type_name("T");
  command->add_option("--json", options->json, "also write the numbers as JSON")->type_name("FILE.json");
  command
      ->add_option("--config", options->config_file, "use [wind] and the heights of the sensors of this configuration")
      ->type_name("FILE.toml");
  command->add_flag("--force", options->force, "overwrite the output");
  command->callback([options] { run_report(*options); });
}

}  // namespace

const Command kReportCommand{add_report};

}  // namespace yuragi::daemon::commands
